// One axis of a plot: which values it spans, where they stand, where its ticks are.
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
  // Values that are not finite, and on a logarithmic axis values <= 0, do not count. Of none at all: 1 to 10.
  Axis(const std::vector<double>& values, bool logarithmic);

  // 0 at the axis's lower end, 1 at the upper. Logarithmic: 0 for values <= 0.
  double place(double value) const;
  bool below(double value) const { return logarithmic_ && !(value > 0); }

  // Logarithmic: decades, at most some eight of them; else multiples of 1, 2 or 5 times a power of ten.
  std::vector<Tick> ticks() const;

 private:
  bool logarithmic_;
  double low_ = 1;  // decades when logarithmic
  double high_ = 10;
  double step_ = 1;
};

}  // namespace vpe::report
