// The pixels of a map: their places, and the grid of a box.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

#include "mars/raster/output/map_crs.h"

namespace vpe::map {

// Describes square pixels in map coordinates, row 0 at the top. Regular type.
struct MapGrid {
  double left = 0;     // of the left edge of column 0, in units of the map
  double top = 0;      // of the upper edge of row 0
  double spacing = 1;  // between pixels, in units of the map
  int columns = 0;
  int rows = 0;
  bool operator==(const MapGrid&) const = default;

  // Returns the middle of a pixel.
  glm::dvec2 middle(int column, int row) const {
    return {left + (column + 0.5) * spacing, top - (row + 0.5) * spacing};
  }
  // Returns GDAL's geotransform.
  std::array<double, 6> geotransform() const { return {left, spacing, 0, top, 0, -spacing}; }
};

// Describes an area by degrees east and planetocentric degrees north. `east_deg` is at least `west_deg`, and at most 360
// more.
struct PlaceBox {
  double west_deg = -180;
  double south_deg = -90;
  double east_deg = 180;
  double north_deg = 90;
};

inline constexpr std::int64_t kMostMapSide = 1'000'000;

// Returns the smallest grid around the map of a box whose edges are multiples of the spacing, so that grids of equal
// spacing in one CRS fit each other. The map of the box is found by 257 x 257 of its places; along cylinders it may go
// beyond half a turn, but is at most a turn wide. Throws std::invalid_argument for a box without a place on the map, and
// for sides of more than kMostMapSide pixels.
MapGrid grid_of_box(const mars::MapCrs& crs, const PlaceBox& box, double spacing_m);

// Returns the places of whole rows of pixels, in degrees east and planetocentric degrees north, row by row; NaN off the
// planet.
std::vector<glm::dvec2> places_of_rows(const mars::MapCrs& crs, const MapGrid& grid, int first_row, int rows);

}  // namespace vpe::map
