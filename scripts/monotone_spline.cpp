#include "scripts/monotone_spline.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace scripts {

namespace {

// Returns the weighted harmonic mean of the two neighbouring slopes; zero at an extremum.
double inner_slope(double before_s, double after_s, double before, double after) {
  if (!(before * after > 0.0)) return 0.0;
  const double weight_before = 2.0 * after_s + before_s;
  const double weight_after = after_s + 2.0 * before_s;
  return (weight_before + weight_after) / (weight_before / before + weight_after / after);
}

// Returns the three-point estimate at an end, limited to keep the curve monotone. `near` is the slope of the
// segment at the end.
double end_slope(double near_s, double far_s, double near, double far) {
  const double slope = ((2.0 * near_s + far_s) * near - near_s * far) / (near_s + far_s);
  if (!(slope * near > 0.0)) return 0.0;
  return near * far < 0.0 && std::abs(slope) > 3.0 * std::abs(near) ? 3.0 * near : slope;
}

}  // namespace

MonotoneSpline::MonotoneSpline(std::vector<double> times_s, std::vector<double> values)
    : times_s_(std::move(times_s)), values_(std::move(values)), slopes_(values_.size(), 0.0) {
  const std::size_t segments = values_.size() - 1;
  const auto span = [&](std::size_t i) { return times_s_[i + 1] - times_s_[i]; };
  const auto slope = [&](std::size_t i) { return (values_[i + 1] - values_[i]) / span(i); };
  if (segments == 0) return;
  if (segments == 1) {
    slopes_.assign(2, slope(0));
    return;
  }
  slopes_.front() = end_slope(span(0), span(1), slope(0), slope(1));
  slopes_.back() = end_slope(span(segments - 1), span(segments - 2), slope(segments - 1), slope(segments - 2));
  for (std::size_t i = 1; i < segments; ++i) {
    slopes_[i] = inner_slope(span(i - 1), span(i), slope(i - 1), slope(i));
  }
}

double MonotoneSpline::at(double time_s) const {
  if (!(time_s > times_s_.front())) return values_.front();
  if (time_s >= times_s_.back()) return values_.back();
  const auto after = std::upper_bound(times_s_.begin(), times_s_.end(), time_s);
  const auto i = static_cast<std::size_t>(after - times_s_.begin()) - 1;
  const double span_s = times_s_[i + 1] - times_s_[i];
  const double u = (time_s - times_s_[i]) / span_s;
  const double rise = values_[i + 1] - values_[i];
  const double first = slopes_[i] * span_s;
  const double last = slopes_[i + 1] * span_s;
  // Hermite form from the first value, so that it is exact at u = 0.
  const double offset = u * (first + u * ((3.0 * rise - 2.0 * first - last) + u * (first + last - 2.0 * rise)));
  const auto [low, high] = std::minmax(values_[i], values_[i + 1]);
  return std::clamp(values_[i] + offset, low, high);
}

}  // namespace scripts
