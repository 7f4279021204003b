// Holds what the pixels of a band of rows show, while an image is carried to any other view. Private to vpe/warp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vpe::warp {

// Names half of a cell between four pixels of the first image: twice the index of the cell's upper left pixel, and 1 for
// the lower half. Negative: one of the following.
using Half = std::int32_t;
inline constexpr Half kNothing = -1;
inline constexpr Half kHidden = -2;  // ground that reaches behind the new camera; it hides and shows nothing
// A flat block (block_plan.h), in which Hits::u and v say where: a pixel of the first image lands in this one, none does,
// and sky.
inline constexpr Half kFlatCarried = -3;
inline constexpr Half kFlatBetween = -4;
inline constexpr Half kFlatSky = -5;

// Holds the nearest surface at each pixel. Rows have kPad entries more, so that vectors of pixels may reach beyond them.
struct Hits {
  static constexpr int kPad = 16;

  Hits(int width, int first, int end) : first_row(first), end_row(end), pitch(width + kPad) {
    const std::size_t count = static_cast<std::size_t>(pitch) * static_cast<std::size_t>(end - first);
    inverse_depth.resize(count, -1);
    u.resize(count);
    v.resize(count);
    half.resize(count, kNothing);
  }

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y - first_row) * static_cast<std::size_t>(pitch) +
           static_cast<std::size_t>(x);
  }

  int first_row = 0;
  int end_row = 0;
  int pitch = 0;
  std::vector<float> inverse_depth;  // 1 / m along the new camera's axis; 0 for sky, -1 for nothing
  std::vector<float> u;              // place in the first image, pixels from the middle of its first one
  std::vector<float> v;
  std::vector<Half> half;
};

}  // namespace vpe::warp
