// Lengths of the rays of an image's pixels.
#pragma once

#include <span>
#include <vector>

#include "vpe/base/parallel.h"
#include "vpe/core/view.h"

namespace vpe::core {

// Computes the lengths of rays relative to their depth, that is range divided by depth, within 3e-7 of the value. For
// perspective views. Any number of threads may use it at once.
class RayLengths {
 public:
  explicit RayLengths(const View& view);

  // Writes the lengths for a row of the drawn part.
  void row(int y, std::span<float> out) const;
  float at(int x, int y) const;

 private:
  float upright(int y) const;

  double cy_ = 0;
  double per_px_ = 1;
  std::vector<float> across_;  // squares of the part of a ray across the row
};

// Writes 1 / metres along the camera's axis for the ranges of a view's drawn part, within 4e-7 of the value, at most 1000,
// and 0 for sky: what smooth_edges() needs (image/edge_filter.h). For perspective views.
void inverse_depths(const View& view, std::span<const float> range_m, base::ThreadPool& pool,
                    std::span<float> out);

}  // namespace vpe::core
