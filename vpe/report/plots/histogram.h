// Histograms as SVG text, in the manner of plot.h.
#pragma once

#include <string>
#include <vector>

namespace vpe::report {

// Holds a bar that stands on the horizontal axis.
struct Bar {
  double low = 0;  // the values that it counts
  double high = 0;
  double share = 0;   // its height
  std::string label;  // shown when the bar is pointed at; empty: the numbers
};

// Holds a vertical line at a value, such as a percentile.
struct HistogramMark {
  double at = 0;
  std::string label;  // short: it stands at the line's upper end
};

struct Histogram {
  std::string title;
  std::string x_label;  // with its unit
  std::string y_label;
  std::string about;                 // what is seen, for those who cannot see it
  std::vector<Bar> bars;             // ascending
  std::vector<HistogramMark> marks;  // ascending
  int width_px = 460;
  int height_px = 300;
};

// Returns an SVG element. Both axes are linear; the vertical one begins at 0. Leaves out bars and marks with values that are
// not finite, and ticks beyond the bars. Equal histograms give equal text.
std::string to_svg(const Histogram& histogram);

}  // namespace vpe::report
