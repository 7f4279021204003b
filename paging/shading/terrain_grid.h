// Positions between the lines of grids, bilinear interpolation, and colours as bytes. Used by TerrainShader
// alone.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "lod/tree/facet_mask.h"
#include "mars/geodesy/cube.h"
#include "mars/sources/source.h"
#include "paging/planet/planet_meta.h"

namespace paging {

inline constexpr std::size_t kImageSide = kImageIntervals + 1;

inline glm::vec3 rgb(const vpe::base::Rgb& c) { return {c.r, c.g, c.b}; }

inline std::uint8_t to_byte(float x) { return static_cast<std::uint8_t>(std::clamp(x + 0.5F, 0.0F, 255.0F)); }

// Holds a position between two lines of a grid.
struct GridPosition {
  std::size_t index;  // of the line before
  float rest;         // 0..1, fraction of the interval to the next line
};

// Returns the position `at` steps after `offset`, where `fine_total` steps span a grid of `coarse` intervals.
inline GridPosition grid_position(int offset, int at, int fine_total, int coarse) {
  const double x = static_cast<double>(offset + at) * coarse / fine_total;
  const auto index = std::min(static_cast<std::size_t>(x), static_cast<std::size_t>(coarse - 1));
  return {index, static_cast<float>(x - static_cast<double>(index))};
}

// Returns the position of a chart coordinate in a tile's grid, whose lines are even in the face's parameter.
inline GridPosition between_lines(double x, int level, std::int32_t index, int intervals) {
  const double line =
      std::clamp(mars::face_parameter(x) * std::ldexp(1.0, level) - index, 0.0, 1.0) * intervals;
  const auto before = std::min(static_cast<std::size_t>(line), static_cast<std::size_t>(intervals - 1));
  return {before, static_cast<float>(line - static_cast<double>(before))};
}

// Returns whether the ground at a place has no data: whether a post that spans it has none. `nodata` has a flag
// for each post, in rows of `side`, or none.
inline bool is_nodata(const std::vector<bool>& nodata, const GridPosition& x, const GridPosition& y,
                      std::size_t side) {
  return !nodata.empty() && lod::is_flagged(nodata, y.index * side + x.index, side, static_cast<double>(x.rest),
                                            static_cast<double>(y.rest));
}

// Interpolates values at the crossings of a grid of `side` lines; get(index) returns the value at a crossing.
template <typename T, typename Get>
T bilinear(const GridPosition& x, const GridPosition& y, std::size_t side, Get&& get) {
  const std::size_t at = y.index * side + x.index;
  const T south = get(at) * (1.0F - x.rest) + get(at + 1) * x.rest;
  const T north = get(at + side) * (1.0F - x.rest) + get(at + side + 1) * x.rest;
  return south * (1.0F - y.rest) + north * y.rest;
}

}  // namespace paging
