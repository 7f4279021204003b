// Blocks of pixels that show a dome, many pixels at a time. Private to objects/draw; dome_painter.cpp describes the blocks.
//
// Within a block, places in the panorama are counted from that of the block's middle. The ray, the place where it meets the dome
// and its direction from the dome's middle are computed for each pixel; only azimuth and elevation are power series, in the
// tangent t of the angle from the block's middle. Up to kMostTangent the series end with an error of at most t^9 / 9, so that a
// place is off by less than 1.7e-6 of its distance from the block's middle: 2e-5 pixels of the image. Rounding of floats moves
// the direction by at most kFloatError_rad.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "objects/posters/panorama_formula.h"
#include "vpe/base/rgb.h"

namespace objects {

inline constexpr int kDomeBlock_px = 16;
inline constexpr double kMostTangent = 0.25;
// Bounds the error of a direction from the dome's middle where floats compute it, relative to the radius: 25 roundings.
inline constexpr double kFloatError_rad = 25.0 / (1 << 24);

// Describes a block. Axes: z up, y level in the direction of the block's middle, or of its facet's, x to the right of it. The
// dome's radius is 1. The ray at column i and row j is row_scale[j] column[i] + row_rise[j] up, of any length.
template <class T>
struct DomeBlock {
  using Sides = std::array<T, kDomeBlock_px>;
  using Vector = std::array<T, 3>;

  std::array<Sides, 3> column;
  Sides row_scale;
  Sides row_rise;
  Vector up;
  Vector camera;            // from the dome's middle
  T open = 1;               // 1 - |camera|^2, of cylinders with the level part of it; more than 0
  bool is_central = false;  // the camera is taken to be in the middle
  bool is_cylinder = false;
  PanoramaFormula::Kind kind = PanoramaFormula::Kind::kEquirectangular;
  T across_px = 1;  // columns a radian; not of facets
  T focal_px = 1;
  T half_facet_px = 0;  // of facets: half of their width
  T middle_x_px = 0;    // of facets: the block's middle from that of the facet
  T middle_y_px = 0;    // of facets and cylinders: the block's middle down from the horizon
  T sine = 0;           // of the elevation of the block's middle
  T cosine = 1;
  T radius_m = 1;
  // Say what the panorama shows, counted as BlockPlaces are.
  float least_x_px = 0;
  float most_x_px = 0;
  float least_y_px = 0;
  float most_y_px = 0;
  bool replaces_ground = false;
};

// Holds what the pixels of a block show, row by row.
struct BlockPlaces {
  using Pixels = std::array<float, kDomeBlock_px * kDomeBlock_px>;
  alignas(64) Pixels x_px;  // in the panorama, from the block's middle
  alignas(64) Pixels y_px;
  alignas(64) Pixels range_m;                      // infinity where ground is nearer or the dome does not show
  std::array<std::uint16_t, kDomeBlock_px> shows;  // a bit for each column, that of the first one lowest
};

// Describes a level of the panorama's pyramid and where the block lies in it.
struct BlockLevel {
  const std::uint32_t* texels = nullptr;  // red in the lowest byte, then green, blue and one that is ignored
  int width = 0;
  int height = 0;
  float scale_x = 1;  // its texels to one pixel of the panorama
  float scale_y = 1;
  int first_x = 0;  // texel whose centre is left of the places' origin, or on it, and how far
  int first_y = 0;
  float rest_x = 0;
  float rest_y = 0;
};

// Says how places become colours: levels from the finest, each with the next one mixed to it.
struct BlockColours {
  std::span<const BlockLevel> levels;
  // Gives the level at the block's corners, counted from the first one of `levels`: upper left, upper right, then below.
  std::array<float, 4> level{};
  bool repeats_across = false;
  float steps = 1;  // of a word's channels to one of 255; 1 or 4
};

// Hold colours: 10 bits for each channel, red in the lowest. Of pixels that do not show the dome they are any.
using BlockWords = std::array<std::uint32_t, kDomeBlock_px * kDomeBlock_px>;

// Find the places of a block. until_m holds the ranges of the ground, a row after `until_stride` others, of which
// kDomeBlock_px are read in each row; null: all pixels show the dome, and `shows` is not set. Return false where the series do not hold, or the block leaves its facet; then the places
// are none. The same bits for all instruction sets.
bool find_places(const DomeBlock<float>& block, const float* until_m, std::size_t until_stride,
                 BlockPlaces& places);
bool find_places(const DomeBlock<double>& block, const float* until_m, std::size_t until_stride,
                 BlockPlaces& places);

// Takes the colours of a block's places. As TexturePyramid::sample_within() within 0.001 steps before they are rounded, but that
// levels are bilinear between the block's corners.
void take_colours(const BlockColours& colours, const BlockPlaces& places, BlockWords& words);
// Asks for the memory that take_colours() will read. Changes nothing.
void fetch_ahead(const BlockColours& colours, const BlockPlaces& places);

// Writes kDomeBlock_px words whose channels are bytes.
void store_bytes(const std::uint32_t* words, vpe::base::Rgb* out);

}  // namespace objects
