// Tabulates a colour scale in even buckets, so that the kernel colours many values at once.
//
// Stage of the pipeline (vpe/voxel/ray_renderer.h): ImagePainter makes the table when the appearance changes;
// take_scale() (paint_shading-inl.h) looks values up.
#pragma once

#include <array>
#include <vector>

#include "vpe/core/appearance/palette.h"

namespace vpe::voxel {

// Largest difference between a table and its scale, of 255.
inline constexpr double kScaleTableError = 0.2;

// Holds colours that are linear within each bucket. A bucket where this would be more than kScaleTableError off
// the scale (steps, sharp bends) is marked, and the scale itself must be evaluated. Value v is in bucket
// floor((clamp(v, first, last) - first) per_unit) + 1. Bucket 0 holds all values below `first`, the last bucket
// all values from `last` on.
struct ScaleTable {
  static constexpr int kInner = 1024;
  struct Bucket {
    std::array<float, 4> base;  // 0 to 255; [3] is 1 if the scale itself must be evaluated, else 0
    std::array<float, 4> rise;  // change over the bucket
  };
  std::vector<Bucket> buckets;  // kInner + 2
  float first = 0;
  float per_unit = 0;
  float undefined_value = 0;  // stands for a value that is not defined, such as the aspect of flat ground
};

// Returns the table of a scale.
ScaleTable scale_table(const core::ColourScale& scale);

}  // namespace vpe::voxel
