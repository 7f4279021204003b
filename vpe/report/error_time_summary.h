// What the measurements of error_time.h say together: of each sweep, of the defaults, of all views.
#pragma once

#include <string>
#include <vector>

#include "vpe/report/error_time.h"

namespace vpe::report {

// Below these nobody sees errors: they need not fall any more (kShift, px; kColour, steps of 8-bit sRGB).
double error_floor(ErrorKind kind);
// Below these they are rounding's.
double rounding_floor(ErrorKind kind);

struct SweepSummary {
  std::string view;
  std::string sweep;
  ErrorKind kind = ErrorKind::kShift;
  std::string coarsest;  // knobs
  std::string finest;
  int points = 0;
  double largest_error = 0;
  double smallest_error = 0;
  double decades = 0;  // between both; errors below rounding_floor() count as that
  // The largest factor by which an error rises from a point to the next finer one, both counted as at least
  // error_floor(); <= 1: errors fall along the sweep.
  double worst_rise = 0;
  bool within_stated = true;
};

// Of ways in their order, from coarse to fine; sweeps of one way are left out.
std::vector<SweepSummary> summarize_sweeps(const SubjectResult& result);

// Where a default stands among its rivals of the same view. Errors below rounding_floor() count as that.
struct DefaultPlace {
  std::string view;
  std::string sweep;
  std::string knob;
  bool is_chosen = false;  // as Way::is_chosen; else Way::is_default
  double error = 0;
  double time_ms = 0;
  double front_ms = 0;        // the shortest time of any rival that errs no more
  std::string front;          // that rival
  double over_front = 0;      // time_ms / front_ms
  double over_own_front = 0;  // the same among the ways of its own renderer
};
std::vector<DefaultPlace> place_defaults(const SubjectResult& result);

// Indices of the ways that no rival beats: for each name of rivals a front of median time and error.
std::vector<std::size_t> fronts(const SubjectResult& result);

// A way over all views that have it: medians.
struct ConfigurationOverViews {
  Configuration configuration;  // without its requests; chosen if it is so in any view
  int views = 0;
  double ratio = 0;  // time to the baseline's
  double error = 0;
  double stated_px = 0;  // NaN where nothing is stated
};
std::vector<ConfigurationOverViews> over_views(const std::vector<SubjectResult>& results);

}  // namespace vpe::report
