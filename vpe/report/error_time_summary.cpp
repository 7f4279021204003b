#include "vpe/report/error_time_summary.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "vpe/report/pareto_front.h"

namespace vpe::report {

namespace {

// Returns the costs in one group, of all renderers or of one; configurations outside are infinitely slow.
// Errors of rounding count as equal.
std::vector<CostAndError> costs(const SubjectResult& result, const std::string& comparison_group,
                                const std::string& renderer) {
  std::vector<CostAndError> points;
  for (std::size_t k = 0; k < result.measured.size(); ++k) {
    const Configuration& configuration = result.subject.configurations[k];
    const bool counts = configuration.comparison_group == comparison_group &&
                        (renderer.empty() || configuration.renderer == renderer);
    points.push_back(
        {counts ? 1e3 * result.measured[k].timing.median_s() : std::numeric_limits<double>::infinity(),
         std::max(result.measured[k].error(configuration.kind), rounding_floor(configuration.kind))});
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
    const Configuration& configuration = result.subject.configurations[k];
    const Measured& measured = result.measured[k];
    const double error = measured.error(configuration.kind);
    const double counted = std::max(error, error_floor(configuration.kind));
    const auto found = std::find_if(sweeps.begin(), sweeps.end(),
                                    [&](const auto& s) { return s.sweep == configuration.sweep; });
    const auto at = static_cast<std::size_t>(found - sweeps.begin());
    if (found == sweeps.end()) {
      SweepSummary first;
      first.view = result.subject.view;
      first.sweep = configuration.sweep;
      first.kind = configuration.kind;
      first.coarsest = configuration.knob;
      first.largest_error = first.smallest_error = error;
      sweeps.push_back(first);
      before.push_back(counted);
    }
    SweepSummary& sweep = sweeps[at];
    if (sweep.points > 0) sweep.worst_rise = std::max(sweep.worst_rise, counted / before[at]);
    before[at] = counted;
    sweep.finest = configuration.knob;
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
    const Configuration& configuration = result.subject.configurations[k];
    if (!(configuration.is_default || configuration.is_chosen) || configuration.comparison_group.empty())
      continue;
    const std::vector<CostAndError> all = costs(result, configuration.comparison_group, "");
    const std::vector<CostAndError> own = costs(result, configuration.comparison_group, configuration.renderer);
    DefaultPlace place;
    place.view = result.subject.view;
    place.sweep = configuration.sweep;
    place.knob = configuration.knob;
    place.is_chosen = configuration.is_chosen;
    place.error = result.measured[k].error(configuration.kind);
    place.time_ms = all[k].cost;
    place.front_ms = cost_at_error(all, all[k].error);
    for (std::size_t n = 0; n < all.size(); ++n) {
      const Configuration& comparison = result.subject.configurations[n];
      if (all[n].cost == place.front_ms && all[n].error <= all[k].error)
        place.front = comparison.sweep + ", " + comparison.knob;
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
  for (const Configuration& configuration : result.subject.configurations) {
    if (std::find(done.begin(), done.end(), configuration.comparison_group) != done.end()) continue;
    done.push_back(configuration.comparison_group);
    const std::vector<std::size_t> front = pareto_front(costs(result, configuration.comparison_group, ""));
    all.insert(all.end(), front.begin(), front.end());
  }
  std::sort(all.begin(), all.end());
  return all;
}

std::vector<ConfigurationOverViews> over_views(const std::vector<SubjectResult>& results) {
  struct Collected {
    std::vector<double> ratio, error, stated;
  };
  std::vector<ConfigurationOverViews> configurations;
  std::vector<Collected> collected;
  for (const SubjectResult& result : results) {
    for (std::size_t k = 0; k < result.measured.size(); ++k) {
      const Configuration& configuration = result.subject.configurations[k];
      const Measured& measured = result.measured[k];
      const auto found =
          std::find_if(configurations.begin(), configurations.end(), [&](const ConfigurationOverViews& w) {
            return w.configuration.sweep == configuration.sweep && w.configuration.knob == configuration.knob;
          });
      const auto at = static_cast<std::size_t>(found - configurations.begin());
      if (found == configurations.end()) {
        configurations.emplace_back();
        configurations.back().configuration = configuration;
        configurations.back().configuration.requests.clear();
        collected.emplace_back();
      }
      configurations[at].configuration.is_chosen |= configuration.is_chosen;
      collected[at].ratio.push_back(measured.ratio);
      collected[at].error.push_back(measured.error(configuration.kind));
      if (measured.stated_px) collected[at].stated.push_back(*measured.stated_px);
    }
  }
  for (std::size_t k = 0; k < configurations.size(); ++k) {
    configurations[k].views = static_cast<int>(collected[k].ratio.size());
    configurations[k].ratio = median(collected[k].ratio);
    configurations[k].error = median(collected[k].error);
    configurations[k].stated_px = median(collected[k].stated);
  }
  return configurations;
}

}  // namespace vpe::report
