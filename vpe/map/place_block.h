// The places of a block of a map's pixels, interpolated from few that PROJ gives.
//
// Typical usage:
//   const int side = place_block_side(crs, grid, radius_m);
//   if (const auto block = PlaceBlock::fit(crs, grid, {0, 0, side, side})) block->directions(row, line);
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "mars/raster/output/map_crs.h"
#include "vpe/map/map_grid.h"

namespace vpe::map {

inline constexpr int kMostPlaceBlockSide = 64;

// Bounds the angle between a direction of PlaceBlock and that of the place that MapCrs gives. It is five times the largest
// difference that fit() accepts at the places that it checks.
inline constexpr double kPlaceBlockError_rad = 1e-13;

// Returns the side of blocks in pixels, a power of two, that suits a map of a sphere; 0 where pixels are so wide that blocks
// do not pay.
int place_block_side(const mars::MapCrs& crs, const MapGrid& grid, double radius_m);

// Describes a rectangle of pixels.
struct PixelRect {
  int column = 0;
  int row = 0;
  int columns = 0;
  int rows = 0;
};

// Holds directions of a row of a block's pixels.
struct DirectionLine {
  std::array<double, kMostPlaceBlockSide> x, y, z;
  glm::dvec3 at(int column) const {
    const auto n = static_cast<std::size_t>(column);
    return {x[n], y[n], z[n]};
  }
};

// Holds directions of a block's pixels as polynomials of column and row. Being directions, they know of no pole and no
// antimeridian. Any thread may call const members.
class PlaceBlock {
 public:
  // Fits polynomials of degree 7 to 8 x 8 places, and compares them with 37 more: 32 along the rim of the block, 5 within.
  // Returns nullopt if one of all these places is off the planet or differs by more than 2e-14 rad, and for blocks with
  // so few pixels that PROJ may as well be asked for each. Sides are at most kMostPlaceBlockSide.
  static std::optional<PlaceBlock> fit(const mars::MapCrs& crs, const MapGrid& grid, const PixelRect& rect);

  // Computes the directions of a row of the block, counted from its first one: unit vectors within kPlaceBlockError_rad.
  void directions(int row, DirectionLine& line) const;

 private:
  static constexpr int kTerms = 8;
  using Terms = std::array<double, kTerms>;

  PlaceBlock(const PixelRect& rect, const std::vector<glm::dvec3>& nodes);
  static double node(int n, int pixels);
  static Terms chebyshev(double t);

  PixelRect rect_;
  // Coefficients of x, y, z: [axis][term of the row][term of the column].
  std::array<std::array<Terms, kTerms>, 3> coefficients_{};
  std::array<std::array<double, kMostPlaceBlockSide>, kTerms> terms_of_columns_{};
};

}  // namespace vpe::map
