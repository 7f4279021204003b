// The measured ground at a block's directions, and what it says about the detail below its resolution.
#pragma once

#include <cmath>
#include <cstdint>

#include "mars/embedded/block.h"
#include "mars/embedded/measured.h"
#include "mars/embedded/noise.h"

namespace mars::embedded {

// Holds the measured ground and its kind. Factors are 0..1 unless noted.
struct Ground {
  GridPlaces places;                                // in posts of the data
  alignas(64) Lane<double> height_m;                // the data, interpolated
  alignas(64) Lane<double> column_m;                // distance of two columns of posts along the parallel
  alignas(64) Lane<double> post_m;                  // distance to the nearest post
  alignas(64) Lane<float> roughness_m;              // standard deviation of the octave about 8 km
  alignas(64) Lane<float> cratered;                 // density of craters, relative to the southern highlands
  alignas(64) Lane<float> wall;                     // steep slopes of canyons, scarps and large craters
  alignas(64) Lane<float> trough;                   // floors of canyons and deep basins
  alignas(64) Lane<float> lowland;                  // northern plains and basins
  alignas(64) Lane<float> volcanic;                 // smooth high ground: lava
  alignas(64) Lane<float> ice;                      // polar caps
  alignas(64) Lane<float> dark;                     // dark sand in the imagery
  bool has_walls = false;                           // false: `wall` is 0 everywhere, and fall_* are not set
  alignas(64) Lane<double> fall_x, fall_y, fall_z;  // unit vector up the slope, along the sphere
  alignas(64) Lane<double> fall_east, fall_north;   // the same in the local frame
};

// Sets the places, the distances to posts and the measured height of `out`.
void lay_measured(const Block& block, const MeasuredMars& mars, Ground& out);

// Sets all of `out`.
void lay_ground(const Block& block, const MeasuredMars& mars, Ground& out);

// Returns the distance from a fractional column and row to the nearest post, in metres.
[[gnu::always_inline]] inline double post_distance_m(double column, double row, double column_m) {
  const double x = column - static_cast<double>(static_cast<std::int32_t>(column + 1.5) - 1);
  const double y = row - static_cast<double>(static_cast<std::int32_t>(row + 1.5) - 1);
  return std::sqrt(x * x * column_m * column_m + y * y * kMeasuredPost_m * kMeasuredPost_m);
}

}  // namespace mars::embedded
