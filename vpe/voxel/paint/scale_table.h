// A colour scale in even buckets, for kernels that colour many values at once.
#pragma once

#include <array>
#include <vector>

#include "vpe/core/appearance/palette.h"

namespace vpe::voxel {

// Straight within each bucket. Where that would be more than kScaleTableError off the scale (steps, sharp
// bends) the bucket says so, and the scale itself has to be asked. Value v is in bucket floor((clamp(v, first,
// last) - first) per_unit) + 1; bucket 0 is all below first, the last one all from `last` on.
inline constexpr double kScaleTableError = 0.2;  // of 255

struct ScaleTable {
  static constexpr int kInner = 1024;
  struct Bucket {
    std::array<float, 4> base;  // 0 to 255; [3] is 1 where the scale itself has to be asked, else 0
    std::array<float, 4> rise;  // over the bucket
  };
  std::vector<Bucket> buckets;  // kInner + 2
  float first = 0;
  float per_unit = 0;
  float of_nothing = 0;  // the value that stands for no number
};

ScaleTable scale_table(const core::ColourScale& scale);

}  // namespace vpe::voxel
