// A finished image carried to another view: what each pixel shows, and which pixels are left to be drawn.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "vpe/base/rgb.h"

namespace vpe::warp {

// Says where the colour and the range of a pixel come from.
enum class Origin : std::uint8_t {
  kOpen,     // nowhere: the pixel has to be drawn
  kSky,      // sky in both views
  kCarried,  // ground; a pixel of the first image lands in this one
  kBetween,  // ground between two neighbours of the first image that have moved apart
};

// Holds an image row by row from the top; all vectors have width * height entries.
struct CarriedImage {
  int width = 0;
  int height = 0;
  std::vector<base::Rgb> colour;  // black where the pixel is open; empty if the first image has no colour
  // Holds what core::Frame holds. Where the pixel is open: a range before which its ray meets nothing, 0 if none is known.
  std::vector<float> range_m;
  std::vector<Origin> origin;
  std::array<std::int64_t, 4> pixels{};  // of each origin
  // Holds the largest bound, over the carried pixels, of what carrying adds to the error of a pixel's position: the
  // difference of the displacements of the neighbours that it lies between, in pixels, and kCarriedPosition_px.
  double added_px = 0;

  std::int64_t count(Origin of) const { return pixels[static_cast<std::size_t>(of)]; }
};

// Error of a carried pixel on ground that is flat between neighbours, pixels: rounding to float.
inline constexpr double kCarriedPosition_px = 1.0 / 64;

}  // namespace vpe::warp
