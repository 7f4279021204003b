#include "vpe/app/planet/patch_changes.h"

#include <algorithm>
#include <cmath>

#include "mars/sources/stack_walk.h"

namespace vpe::app {

namespace {

// Returns the treatment without those of edges that were matched to added sources: they have a cap of their own.
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

std::string treatment_of(const RequestedSources& sources, const std::string& name) {
  for (const mars::SourceInfo& info : sources.combined.source->infos())
    if (info.name == name) return info.treatment;
  return "";
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

  std::vector<mars::Cap> warped;
  std::vector<std::string> warps;
  for (std::size_t n = known; n < now.dems.size(); ++n) {
    const std::string name = now.dems[n]->infos().front().name;
    for (const mars::CombineFinding& finding : now.combined.findings) {
      if (finding.name != name || !finding.edge_matching) continue;
      warped.push_back(finding.edge_matching->cap);
      warps.push_back(to_string(*finding.edge_matching, name));
    }
  }
  for (std::size_t n = 0; n < known; ++n) {
    const std::string name = now.dems[n]->infos().front().name;
    std::string treatment = treatment_of(now, name);
    for (const std::string& warp : warps) treatment = without(treatment, warp);
    if (treatment != treatment_of(before, name)) changed[n] = true;
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
  return within(now.images, changed);
}

}  // namespace vpe::app
