// The ground along a path as SVG text, in the manner of plot.h.
#pragma once

#include <string>
#include <vector>

namespace vpe::report {

// Holds the ground over a part of the path. Parts follow each other without gaps.
struct GroundColumn {
  double from = 0;  // distance along the path, in the unit of the axis
  double to = 0;
  double begin = 0;  // elevation at both ends, between which the ground is drawn straight
  double end = 0;
  double low = 0;  // of all ground in the part
  double high = 0;
  int steepness = 0;  // how many of the limits it exceeds
  bool nodata = false;
};

struct GroundPlot {
  std::string title;
  std::string x_label;  // with its unit
  std::string y_label;
  std::string about;  // what is seen, for those who cannot see it
  std::string note;   // a line below the plot, such as datum and vertical exaggeration; may be empty
  std::vector<GroundColumn> columns;
  std::vector<std::string> limits;  // what ground that exceeds 1, 2 ... of them is called in the legend
  std::vector<double> marks;        // distances of places that were given
  int width_px = 900;
  int height_px = 360;
};

// Width of the plot's inside relative to GroundPlot::width_px, and its height, pixels: for the vertical exaggeration.
struct PlotInside {
  double width_px = 0;
  double height_px = 0;
};
PlotInside inside_of(const GroundPlot& plot);

// Returns the range of elevations that the vertical axis spans.
struct PlotRange {
  double low = 0;
  double high = 0;
};
PlotRange range_of(const GroundPlot& plot);

// Returns an SVG element. The ground is a line over a filled area, coloured by steepness; its extremes are a band behind
// it. Columns of nodata, or with values that are not finite, are left out. Equal plots give equal text.
std::string to_svg(const GroundPlot& plot);

}  // namespace vpe::report
