#include "vpe/app/planet/patch_changes.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "mars/sources/stack_walk.h"

namespace vpe::app {

namespace {

// Returns the treatment without one of its texts.
std::string without(std::string treatment, const std::string& removed) {
  const std::size_t at = treatment.find(removed);
  if (at == std::string::npos) return treatment;
  constexpr std::string_view kBetween = "; ";  // mars::add_treatment()
  std::size_t begin = at;
  std::size_t end = at + removed.size();
  if (begin >= kBetween.size()) {
    begin -= kBetween.size();
  } else if (treatment.compare(end, kBetween.size(), kBetween) == 0) {
    end += kBetween.size();
  }
  return treatment.erase(begin, end - begin);
}

// Returns the treatment of a source without edges that were matched to others.
std::string own_treatment(const RequestedSources& sources, const std::string& name) {
  std::string treatment;
  for (const mars::SourceInfo& info : sources.combined.source->infos())
    if (info.name == name) treatment = info.treatment;
  for (const mars::CombineFinding& finding : sources.combined.findings)
    if (finding.edge_matching) treatment = without(treatment, to_string(*finding.edge_matching, finding.name));
  return treatment;
}

const mars::CombineFinding* finding_of(const RequestedSources& sources, const std::string& name) {
  const auto found = std::ranges::find(sources.combined.findings, name, &mars::CombineFinding::name);
  return found != sources.combined.findings.end() ? &*found : nullptr;
}

std::optional<mars::EdgeMatching> edges_of(const RequestedSources& sources, const std::string& name) {
  const mars::CombineFinding* finding = finding_of(sources, name);
  return finding != nullptr ? finding->edge_matching : std::nullopt;
}

bool is_equal(const mars::EdgeMatching& a, const mars::EdgeMatching& b) {
  return a.boundary == b.boundary && a.off_m == b.off_m && a.cell_m == b.cell_m && a.reach_m == b.reach_m &&
         a.radius_m == b.radius_m;
}

// Returns whether the same plane is removed from a source. Its text does not have all digits.
bool is_equally_levelled(const RequestedSources& before, const RequestedSources& now, const std::string& name) {
  const auto plane = [&](const RequestedSources& sources) {
    const mars::CombineFinding* finding = finding_of(sources, name);
    return finding != nullptr ? finding->alignment : std::nullopt;
  };
  const auto a = plane(before);
  const auto b = plane(now);
  return a.has_value() == b.has_value() &&
         (!a || (a->offset_m == b->offset_m && a->tilt_east == b->tilt_east && a->tilt_north == b->tilt_north &&
                 a->centre.lon_deg == b->centre.lon_deg && a->centre.lat_deg == b->centre.lat_deg));
}

// Returns the number of the source that lies below all others.
std::size_t coarsest(const std::vector<std::shared_ptr<const mars::ElevationSource>>& sources) {
  std::size_t found = 0;
  for (std::size_t n = 1; n < sources.size(); ++n)
    if (mars::resolution_m(*sources[n]) >= mars::resolution_m(*sources[found])) found = n;
  return found;
}

// Marks the sources next finer than an added one: the width of their fade follows what lies below them.
template <class Source>
void mark_faded(const std::vector<std::shared_ptr<const Source>>& all, std::size_t before_count,
                std::vector<bool>& changed) {
  std::vector<std::size_t> order(all.size());
  for (std::size_t n = 0; n < order.size(); ++n) order[n] = n;
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
    return mars::resolution_m(*all[a]) < mars::resolution_m(*all[b]);
  });
  for (std::size_t n = 1; n < order.size(); ++n)
    if (order[n] >= before_count) changed[order[n - 1]] = true;
}

template <class Source>
paging::ChangedIn within(const std::vector<std::shared_ptr<const Source>>& all,
                         const std::vector<bool>& changed) {
  std::vector<std::shared_ptr<const Source>> sources;
  for (std::size_t n = 0; n < all.size(); ++n)
    if (changed[n]) sources.push_back(all[n]);
  return [sources = std::move(sources)](const mars::Cap& cap) {
    return std::ranges::any_of(sources, [&](const auto& s) { return std::isfinite(s->spacing_in(cap)); });
  };
}

}  // namespace

paging::ChangedIn elevation_changes(const RequestedSources& before, const RequestedSources& now,
                                    bool rejects_outliers) {
  const std::size_t known = before.dems.size();
  std::vector<bool> changed(now.dems.size());
  for (std::size_t n = known; n < changed.size(); ++n) changed[n] = true;
  mark_faded(now.dems, known, changed);

  // What lies below an inset is warped to meet it, and then one source: insets in it fade in another way.
  std::vector<mars::Cap> warped;
  bool is_folded = false;
  for (std::size_t n = 0; n < now.dems.size(); ++n) {
    const std::string name = now.dems[n]->infos().front().name;
    const auto is = edges_of(now, name);
    const auto was = n < known ? edges_of(before, name) : std::nullopt;
    if (is.has_value() == was.has_value() && (!is || is_equal(*is, *was))) continue;
    for (const auto& edges : {is, was})
      if (edges) warped.push_back(edges->cap);
    is_folded = true;
  }
  const std::size_t lowest = coarsest(before.dems);
  for (std::size_t n = 0; n < known; ++n) {
    const std::string name = now.dems[n]->infos().front().name;
    if (own_treatment(now, name) != own_treatment(before, name) || !is_equally_levelled(before, now, name) ||
        (is_folded && n != lowest))
      changed[n] = true;
    // Posts are outliers by what lies below them.
    if (!rejects_outliers) continue;
    for (std::size_t added = known; added < now.dems.size(); ++added)
      if (mars::resolution_m(*now.dems[n]) < mars::resolution_m(*now.dems[added])) changed[n] = true;
  }
  // Reliefs that were added, and those whose ground at their place is another now.
  std::vector<relief::Relief> added(now.reliefs.begin() + static_cast<std::ptrdiff_t>(before.reliefs.size()),
                                    now.reliefs.end());
  std::vector<relief::PlacedRelief> moved;
  for (std::size_t n = 0; n < before.reliefs.size(); ++n) {
    const auto& is = now.reliefs[n].placed();
    const auto& was = before.reliefs[n].placed();
    for (std::size_t p = 0; p < is.size(); ++p)
      if (is[p].zero_m() != was[p].zero_m()) moved.push_back(is[p]);
  }
  const auto is_reshaped = [added = std::move(added), moved = std::move(moved)](const mars::Cap& cap) {
    return std::ranges::any_of(added, [&](const relief::Relief& r) { return r.touches(cap); }) ||
           std::ranges::any_of(moved, [&](const relief::PlacedRelief& r) { return r.touches(cap); });
  };
  return [is_reshaped, inside = within(now.dems, changed), warped = std::move(warped)](const mars::Cap& cap) {
    return inside(cap) || is_reshaped(cap) || std::ranges::any_of(warped, [&](const mars::Cap& w) {
             return mars::angle_between_rad(w.centre, cap.centre) <= w.radius_rad + cap.radius_rad;
           });
  };
}

paging::ChangedIn image_changes(const RequestedSources& before, const RequestedSources& now) {
  std::vector<bool> changed(now.images.size());
  for (std::size_t n = before.images.size(); n < changed.size(); ++n) changed[n] = true;
  mark_faded(now.images, before.images.size(), changed);
  // Colours that are matched to other imagery than before.
  for (std::size_t n = 0; n < before.images.size(); ++n) {
    if (before.images[n]->infos().front().treatment != now.images[n]->infos().front().treatment)
      changed[n] = true;
  }
  return within(now.images, changed);
}

}  // namespace vpe::app
