// Flat blocks in vectors of pixels. Private to vpe/warp. The results are the same to the bit for all instruction sets.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "vpe/base/rgb.h"
#include "vpe/warp/block_plan.h"
#include "vpe/warp/carried_image.h"
#include "vpe/warp/hits.h"

namespace vpe::warp {

// Vectors may read so many entries beyond the end of a row of an image.
inline constexpr std::size_t kVectorPad = 16;

// A plane of inverse depths over a block: at its upper left pixel, and steps by column and by row.
struct DepthPlane {
  float at_first = 0;
  float by_column = 0;
  float by_row = 0;
};

struct DepthRest {
  float least = 0;  // of the inverse depths
  float largest = 0;
  float rest = 0;  // largest distance of an inverse depth from the plane; infinite where there is none
};

// Compares the inverse depths of `columns` x `rows` pixels with a plane. `stride` is the distance of rows.
DepthRest rest_of(const float* depth, std::size_t stride, int columns, int rows, const DepthPlane& plane);

// Draws a block into a band of rows; the nearest surface stays.
void draw_block(const FlatBlock& block, Hits& hits);

// A finished image whose pixels are mixed, four by four: colours as words with red in the lowest byte. 4 x 4 or more.
struct MixedImage {
  const std::uint32_t* words = nullptr;  // null: no colours
  int width = 0;
  int height = 0;
  bool filters = true;
};

// Replaces lengths of rays, relative to their depth, by inverse depths: length over range; no number where the range is not
// above 0. Both have the same size.
void invert(std::span<const float> range_m, std::span<float> length);

// Makes words of a row of colours.
void widen(std::span<const base::Rgb> colour, std::uint32_t* words);

// A row of the new image; members have kVectorPad entries more.
struct ShownRow {
  const float* length = nullptr;  // of its rays, relative to their depth
  float* range_m = nullptr;       // out: as CarriedImage
  Origin* origin = nullptr;       // out
  base::Rgb* colour = nullptr;    // out
};

// Writes `count` pixels from `first` on, an index into the hits: what flat blocks show; the others are open, black and
// have no range. Returns true if half cells are among those.
bool show_flat(const Hits& hits, std::size_t first, int count, const MixedImage& image, const ShownRow& row);

}  // namespace vpe::warp
