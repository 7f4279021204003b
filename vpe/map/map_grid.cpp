#include "vpe/map/map_grid.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <stdexcept>
#include <string>

#include "vpe/base/number.h"

namespace vpe::map {
namespace {

constexpr int kBoxSteps = 256;

struct Extent {
  glm::dvec2 low{std::numeric_limits<double>::infinity()};
  glm::dvec2 high{-std::numeric_limits<double>::infinity()};
};

// Returns the extent of the box on the map.
Extent extent_of(const mars::MapCrs& crs, const PlaceBox& box) {
  Extent extent;
  const double period = crs.period();
  for (int j = 0; j <= kBoxSteps; ++j) {
    const double lat_deg = box.south_deg + (box.north_deg - box.south_deg) * j / kBoxSteps;
    std::vector<glm::dvec2> row;
    for (int i = 0; i <= kBoxSteps; ++i)
      row.emplace_back(box.west_deg + (box.east_deg - box.west_deg) * i / kBoxSteps, lat_deg);
    crs.to_map(row);
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (!std::isfinite(row[i].x) || !std::isfinite(row[i].y)) continue;
      // Eastward steps go to the right, also across the line where the map is cut.
      if (period > 0 && i > 0 && std::isfinite(row[i - 1].x))
        row[i].x += period * std::round((row[i - 1].x - row[i].x) / period);
      extent.low = glm::min(extent.low, row[i]);
      extent.high = glm::max(extent.high, row[i]);
    }
  }
  if (period > 0) extent.high.x = std::min(extent.high.x, extent.low.x + period);
  return extent;
}

int side(double length, const char* name) {
  if (!(length <= static_cast<double>(kMostMapSide))) {
    throw std::invalid_argument("the map would have " + base::format_significant(length, 3) + " " + name +
                                ", at most " + std::to_string(kMostMapSide) +
                                " are possible; choose a smaller box or a larger spacing");
  }
  return std::max(1, static_cast<int>(length));
}

}  // namespace

MapGrid grid_of_box(const mars::MapCrs& crs, const PlaceBox& box, double spacing_m) {
  const Extent extent = extent_of(crs, box);
  if (!(extent.low.x <= extent.high.x))
    throw std::invalid_argument("no place of the box is on this map; choose another box or another CRS");
  MapGrid grid;
  grid.spacing = spacing_m / crs.unit_m();
  // An edge that is a multiple but for rounding does not get another pixel.
  constexpr double kRounding = 1e-6;
  const double first_column = std::floor(extent.low.x / grid.spacing + kRounding);
  const double first_row = std::ceil(extent.high.y / grid.spacing - kRounding);
  grid.left = first_column * grid.spacing;
  grid.top = first_row * grid.spacing;
  grid.columns = side(std::ceil(extent.high.x / grid.spacing - kRounding) - first_column, "columns");
  grid.rows = side(first_row - std::floor(extent.low.y / grid.spacing + kRounding), "rows");
  return grid;
}

std::vector<glm::dvec2> places_of_rows(const mars::MapCrs& crs, const MapGrid& grid, int first_row, int rows) {
  std::vector<glm::dvec2> places;
  places.reserve(static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(rows));
  for (int row = first_row; row < first_row + rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) places.push_back(grid.middle(column, row));
  }
  crs.to_place(places);
  return places;
}

}  // namespace vpe::map
