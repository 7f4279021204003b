// Lengths of the rays of an image's pixels. Private to vpe/warp.
#pragma once

#include <span>
#include <vector>

#include "vpe/core/view.h"

namespace vpe::warp {

// Computes the lengths of rays relative to their depth, that is range divided by depth, within 3e-7 of the value. For
// perspective views. Any number of threads may use it at once.
class RayLengths {
 public:
  explicit RayLengths(const core::View& view);

  // Writes the lengths for a row of the drawn part.
  void row(int y, std::span<float> out) const;
  float at(int x, int y) const;

 private:
  float upright(int y) const;

  double cy_ = 0;
  double per_px_ = 1;
  std::vector<float> across_;  // squares of the part of a ray across the row
};

}  // namespace vpe::warp
