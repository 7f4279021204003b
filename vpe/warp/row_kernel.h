// Carries one row to the second eye, many pixels at a time. Private to vpe/warp; carry_rows.cpp prepares rows.
#pragma once

#include <cstdint>
#include <vector>

#include "vpe/base/rgb.h"
#include "vpe/warp/carried_image.h"

namespace vpe::warp {

// Describes how the pixels of a row move, in scanning order: from the side that the eye moves to, so that what hides a
// pixel comes before it. Positions are in pixels of the row in that order.
struct Scan {
  bool is_mirrored = false;  // the eye moves to the left: the row is read from its end
  int count = 0;
  float shift_px = 0;   // of points at infinity
  float base_px_m = 0;  // shift of a point at depth 1 m, >= 0
  // Radius of the circle of the eyes of a round panorama (carry_round.h), where inverse depths are atan(radius / depth) /
  // radius; 0: of perspective images.
  float radius_m = 0;
  float open_from = 0;  // positions from here on are open
  float most_parted_px = 0;
  bool filters = true;
};

// Holds a row in scanning order; members have kPad entries more than the row, so that vectors of pixels may reach beyond
// its end. For one thread.
struct RowBuffers {
  static constexpr std::size_t kPad = 32;

  explicit RowBuffers(const Scan& scan);

  std::vector<float> length;          // in: of the first image's rays, relative to their depth
  std::vector<float> new_length;      // in: of the new image's
  std::vector<float> range;           // in: of the first image, metres
  std::vector<float> new_range;       // out: of the new one, as CarriedImage::range_m
  std::vector<base::Rgb> colour;      // in: of the first image
  std::vector<base::Rgb> new_colour;  // out
  std::vector<Origin> origin;         // out

  std::vector<float> inverse_depth;  // of the first image's pixels, 1 / m; 0 for sky
  std::vector<float> place;          // of them in the new image
  std::vector<int> first;  // pixel of the new image whose centre is the first that is not before that place
  std::vector<std::uint32_t> word;  // of the first image: red in the lowest byte, then green and blue
  std::vector<int> left;            // by pixel of the new image: the neighbour on its left; -1: none
};

// Carries a row. Returns the largest bound of what carrying adds to the position of a pixel, in pixels. The result is the
// same to the bit for all instruction sets.
float carry_row(const Scan& scan, RowBuffers& row, bool has_colour);

}  // namespace vpe::warp
