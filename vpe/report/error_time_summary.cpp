#include "vpe/report/error_time_summary.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "vpe/report/pareto_front.h"

namespace vpe::report {

namespace {

// Rivals of one name, all others infinitely slow. What is rounding's counts alike.
std::vector<CostAndError> costs(const SubjectResult& result, const std::string& rivals,
                                const std::string& renderer) {
  std::vector<CostAndError> points;
  for (std::size_t k = 0; k < result.measured.size(); ++k) {
    const Way& way = result.subject.ways[k];
    const bool counts = way.rivals == rivals && (renderer.empty() || way.renderer == renderer);
    points.push_back(
        {counts ? 1e3 * result.measured[k].timing.median_s() : std::numeric_limits<double>::infinity(),
         std::max(result.measured[k].error(way.kind), rounding_floor(way.kind))});
  }
  return points;
}

}  // namespace

double error_floor(ErrorKind kind) { return kind == ErrorKind::kShift ? 0.01 : 0.05; }
double rounding_floor(ErrorKind kind) { return kind == ErrorKind::kShift ? 0.001 : 0.05; }

std::vector<SweepSummary> summarize_sweeps(const SubjectResult& result) {
  std::vector<SweepSummary> sweeps;
  std::vector<double> before;  // the last error of each
  for (std::size_t k = 0; k < result.measured.size(); ++k) {
    const Way& way = result.subject.ways[k];
    const Measured& measured = result.measured[k];
    const double error = measured.error(way.kind);
    const double counted = std::max(error, error_floor(way.kind));
    const auto found =
        std::find_if(sweeps.begin(), sweeps.end(), [&](const auto& s) { return s.sweep == way.sweep; });
    const auto at = static_cast<std::size_t>(found - sweeps.begin());
    if (found == sweeps.end()) {
      SweepSummary first;
      first.view = result.subject.view;
      first.sweep = way.sweep;
      first.kind = way.kind;
      first.coarsest = way.knob;
      first.largest_error = first.smallest_error = error;
      sweeps.push_back(first);
      before.push_back(counted);
    }
    SweepSummary& sweep = sweeps[at];
    if (sweep.points > 0) sweep.worst_rise = std::max(sweep.worst_rise, counted / before[at]);
    before[at] = counted;
    sweep.finest = way.knob;
    ++sweep.points;
    sweep.largest_error = std::max(sweep.largest_error, error);
    sweep.smallest_error = std::min(sweep.smallest_error, error);
    sweep.within_stated = sweep.within_stated && measured.within_stated();
  }
  std::erase_if(sweeps, [](const SweepSummary& s) { return s.points < 2; });
  for (SweepSummary& s : sweeps) {
    const double floor = rounding_floor(s.kind);
    s.decades = std::log10(std::max(s.largest_error, floor) / std::max(s.smallest_error, floor));
  }
  return sweeps;
}

std::vector<DefaultPlace> place_defaults(const SubjectResult& result) {
  std::vector<DefaultPlace> places;
  for (std::size_t k = 0; k < result.measured.size(); ++k) {
    const Way& way = result.subject.ways[k];
    if (!(way.is_default || way.is_chosen) || way.rivals.empty()) continue;
    const std::vector<CostAndError> all = costs(result, way.rivals, "");
    const std::vector<CostAndError> own = costs(result, way.rivals, way.renderer);
    DefaultPlace place;
    place.view = result.subject.view;
    place.sweep = way.sweep;
    place.knob = way.knob;
    place.is_chosen = way.is_chosen;
    place.error = result.measured[k].error(way.kind);
    place.time_ms = all[k].cost;
    place.front_ms = cost_at_error(all, all[k].error);
    for (std::size_t n = 0; n < all.size(); ++n) {
      const Way& rival = result.subject.ways[n];
      if (all[n].cost == place.front_ms && all[n].error <= all[k].error)
        place.front = rival.sweep + ", " + rival.knob;
    }
    place.over_front = place.time_ms / place.front_ms;
    place.over_own_front = place.time_ms / cost_at_error(own, own[k].error);
    places.push_back(place);
  }
  return places;
}

std::vector<std::size_t> fronts(const SubjectResult& result) {
  std::vector<std::size_t> all;
  std::vector<std::string> done{""};
  for (const Way& way : result.subject.ways) {
    if (std::find(done.begin(), done.end(), way.rivals) != done.end()) continue;
    done.push_back(way.rivals);
    const std::vector<std::size_t> front = pareto_front(costs(result, way.rivals, ""));
    all.insert(all.end(), front.begin(), front.end());
  }
  std::sort(all.begin(), all.end());
  return all;
}

std::vector<WayOverViews> over_views(const std::vector<SubjectResult>& results) {
  struct Collected {
    std::vector<double> ratio, error, stated;
  };
  std::vector<WayOverViews> ways;
  std::vector<Collected> collected;
  for (const SubjectResult& result : results) {
    for (std::size_t k = 0; k < result.measured.size(); ++k) {
      const Way& way = result.subject.ways[k];
      const Measured& measured = result.measured[k];
      const auto found = std::find_if(ways.begin(), ways.end(), [&](const WayOverViews& w) {
        return w.way.sweep == way.sweep && w.way.knob == way.knob;
      });
      const auto at = static_cast<std::size_t>(found - ways.begin());
      if (found == ways.end()) {
        ways.emplace_back();
        ways.back().way = way;
        ways.back().way.requests.clear();
        collected.emplace_back();
      }
      ways[at].way.is_chosen |= way.is_chosen;
      collected[at].ratio.push_back(measured.ratio);
      collected[at].error.push_back(measured.error(way.kind));
      if (measured.stated_px) collected[at].stated.push_back(*measured.stated_px);
    }
  }
  for (std::size_t k = 0; k < ways.size(); ++k) {
    ways[k].views = static_cast<int>(collected[k].ratio.size());
    ways[k].ratio = median(collected[k].ratio);
    ways[k].error = median(collected[k].error);
    ways[k].stated_px = median(collected[k].stated);
  }
  return ways;
}

}  // namespace vpe::report
