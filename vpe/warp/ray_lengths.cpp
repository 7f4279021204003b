#include "vpe/warp/ray_lengths.h"

#include <cmath>

namespace vpe::warp {

RayLengths::RayLengths(const core::View& view) {
  const core::SubRectangle part = core::drawn_part(view);
  const double focal = core::focal_px(view);
  cy_ = (0.5 * view.height + view.principal_offset_px.y - part.y) / focal;
  per_px_ = 1 / focal;
  const double cx = 0.5 * view.width + view.principal_offset_px.x - part.x;
  across_.resize(static_cast<std::size_t>(part.width));
  for (int x = 0; x < part.width; ++x) {
    const double across = (x + 0.5 - cx) / focal;
    across_[static_cast<std::size_t>(x)] = static_cast<float>(across * across);
  }
}

float RayLengths::upright(int y) const {
  const double up = cy_ - (y + 0.5) * per_px_;
  return static_cast<float>(1 + up * up);
}

void RayLengths::row(int y, std::span<float> out) const {
  const float up = upright(y);
  for (std::size_t x = 0; x < out.size(); ++x) out[x] = std::sqrt(up + across_[x]);
}

float RayLengths::at(int x, int y) const { return std::sqrt(upright(y) + across_[static_cast<std::size_t>(x)]); }

}  // namespace vpe::warp
