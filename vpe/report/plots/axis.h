// One axis of a plot: its range, the positions of values on it, and its ticks.
#pragma once

#include <string>
#include <vector>

namespace vpe::report {

struct Tick {
  double value = 0;
  std::string text;
};

class Axis {
 public:
  // Spans the values and ends at ticks. Ignores values that are not finite, and on a logarithmic axis values
  // <= 0. Spans 1 to 10 if no value is left.
  Axis(const std::vector<double>& values, bool logarithmic);

  // Returns the position of a value: 0 at the axis's lower end, 1 at the upper. On a logarithmic axis values
  // <= 0 are at 0.
  double place(double value) const;
  // Returns true for a value that a logarithmic axis cannot show.
  bool below(double value) const { return logarithmic_ && !(value > 0); }

  // Returns decades on a logarithmic axis, at most about eight of them; else multiples of a nice step
  // (vpe/base/nice_ticks.h).
  std::vector<Tick> ticks() const;

 private:
  bool logarithmic_;
  double low_ = 1;  // decades when logarithmic
  double high_ = 10;
  double step_ = 1;
};

}  // namespace vpe::report
