// Plots as SVG, without a library or a file beside them: they stand in a page that is one file.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace vpe::report {

struct Point {
  double x = 0;
  double y = 0;
  std::string label;            // shown beside the point where it is pointed at, as in "tolerance 0.5"
  std::optional<double> bound;  // what was stated for y: a tick above the point, joined to it
  bool marked = false;          // drawn large and filled: on the front
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

// On a logarithmic axis values <= 0 stand on the lower border, and say so where they are pointed at; values
// that are not finite are left out. Axes end at decades (logarithmic) or at round numbers. Series differ in
// colour and in the shape of their points, which the legend shows. The same plot, the same text.
std::string to_svg(const Plot& plot);

// The same for a file of its own: black on white, wherever it is shown.
std::string to_svg_file(const Plot& plot);

}  // namespace vpe::report
