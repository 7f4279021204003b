// Plots as SVG text, without a library and without a second file, so that a page with plots is one file.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace vpe::report {

struct Point {
  double x = 0;
  double y = 0;
  std::string label;            // shown when the point is pointed at, such as "tolerance 0.5"
  std::optional<double> bound;  // stated bound of y: a mark above the point, joined to it
  bool marked = false;          // drawn large and filled
};

struct Series {
  std::string name;
  std::vector<Point> points;  // joined in this order
  bool joined = true;
};

struct Plot {
  std::string title;
  std::string x_label;  // with its unit
  std::string y_label;
  bool log_x = true;
  bool log_y = true;
  std::vector<Series> series;
  int width_px = 640;
  int height_px = 440;
};

// Returns an SVG element. On a logarithmic axis, values <= 0 stand on the lower border and say so when they are
// pointed at. Leaves out values that are not finite. Axes end at decades (logarithmic) or at round numbers.
// Series differ in colour and in the shape of their points, which the legend shows. Equal plots give equal
// text.
std::string to_svg(const Plot& plot);

// Returns the text of a file: black on white, on any background.
std::string to_svg_file(const Plot& plot);

}  // namespace vpe::report
