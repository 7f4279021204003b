// Summarizes the measurements of error_time.h by sweep, for the defaults, and over all views.
#pragma once

#include <string>
#include <vector>

#include "vpe/report/error_time.h"

namespace vpe::report {

// Returns the error below which a difference is invisible, so that errors need not fall any more (kShift: px,
// kColour: steps of 8-bit sRGB).
double error_floor(ErrorKind kind);
// Returns the error below which only rounding is measured.
double rounding_floor(ErrorKind kind);

struct SweepSummary {
  std::string view;
  std::string sweep;
  ErrorKind kind = ErrorKind::kShift;
  std::string coarsest;  // values of the swept setting
  std::string finest;
  int points = 0;
  double largest_error = 0;
  double smallest_error = 0;
  double decades = 0;  // between the two; errors below rounding_floor() count as that
  // The largest factor by which the error rises from a point to the next finer one, both counted as at least
  // error_floor(). At most 1 if errors fall along the sweep.
  double worst_rise = 0;
  bool within_stated = true;
};

// Returns the sweeps of two or more configurations. Takes configurations in their order, from coarse to fine.
std::vector<SweepSummary> summarize_sweeps(const SubjectResult& result);

// A default beside the other configurations of its group and view. Errors below rounding_floor() count as that.
struct DefaultPlace {
  std::string view;
  std::string sweep;
  std::string knob;
  bool is_chosen = false;  // Configuration::is_chosen, else Configuration::is_default
  double error = 0;
  double time_ms = 0;
  double front_ms = 0;        // the shortest time in the group at an error no larger
  std::string front;          // the configuration with that time
  double over_front = 0;      // time_ms / front_ms
  double over_own_front = 0;  // the same among configurations of its own renderer
};
std::vector<DefaultPlace> place_defaults(const SubjectResult& result);

// Returns the indices of the configurations on the Pareto front of median time and error of their group.
std::vector<std::size_t> fronts(const SubjectResult& result);

// Medians of a configuration over all views that have it.
struct ConfigurationOverViews {
  Configuration configuration;  // without its requests; chosen if it is so in any view
  int views = 0;
  double ratio = 0;  // of times to the baseline
  double error = 0;
  double stated_px = 0;  // NaN where nothing is stated
};
std::vector<ConfigurationOverViews> over_views(const std::vector<SubjectResult>& results);

}  // namespace vpe::report
