// The skyline in a photograph: for each column the row where the sky ends.
//
// Places are in pixels: x right, y down, (0, 0) the image's upper left corner, pixel centres at +0.5. All
// functions are pure and may be called from any thread.
//
// Method: the image is reduced to at most kMaxSkyColumns x kMaxSkyRows cells. At each cell the means above and
// below are compared in units of the noise, which is that of the image's smoothest parts. A path over the columns
// is found by dynamic programming: it gains by contrast at the boundary, and loses by contrast above it, since
// there is nothing but smooth sky above a skyline. So a faint far ridge goes before a strong near one. The row
// is then refined in the full image.
//
// Typical usage:
//   const SkyLine line = find_sky_line(vpe::core::read_image("photo.jpg"));
//   for (const SkyPoint& point : line.points) use(point.x_px, point.y_px);
#pragma once

#include <vector>

#include "vpe/core/image/image.h"

namespace panorama {

inline constexpr int kMaxSkyColumns = 2048;
inline constexpr int kMaxSkyRows = 768;

// Describes a place of the skyline. The row is where the brightness changes most, to a fraction of a pixel.
struct SkyPoint {
  double x_px = 0;
  double y_px = 0;
  double weight = 1;  // 0 to 1; larger for more contrast
};

// Holds limits of the search; find_sky_line() enforces them.
struct SkyLineOptions {
  // Brightness (0 to 255) up to which a pixel has no data. Smaller: darker pixels count as data.
  int nodata_level = 6;
  // Contrast that is taken for an edge, in units of its noise, 2 to 50. Smaller: fainter ridges, more errors.
  double least_contrast = 5;
};

// Holds the skyline from left to right, and why columns have none.
struct SkyLine {
  std::vector<SkyPoint> points;
  int columns = 0;              // examined
  int columns_without_sky = 0;  // no data, or ground up to the upper edge
  int columns_without_edge = 0;
  double noise = 0;  // standard deviation of the brightness of a cell
};

// Finds the skyline. Throws std::invalid_argument for an image of less than 16 x 16 pixels, for pixels that do
// not fit its size, and for options outside of their limits.
SkyLine find_sky_line(const vpe::core::RgbImage& image, const SkyLineOptions& options = {});

}  // namespace panorama
