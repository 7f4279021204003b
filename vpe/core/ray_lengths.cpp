#include "vpe/core/ray_lengths.h"

#include <algorithm>
#include <cmath>

namespace vpe::core {

RayLengths::RayLengths(const View& view) {
  const SubRectangle part = drawn_part(view);
  const double focal = focal_px(view);
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

float RayLengths::at(int x, int y) const {
  return std::sqrt(upright(y) + across_[static_cast<std::size_t>(x)]);
}

void inverse_depths(const View& view, std::span<const float> range_m, base::ThreadPool& pool,
                    std::span<float> out) {
  constexpr float kMost = 1000;  // nearer ground is no edge
  constexpr int kRows = 16;
  const RayLengths lengths(view);
  const SubRectangle part = drawn_part(view);
  const auto width = static_cast<std::size_t>(part.width);
  pool.run(static_cast<std::size_t>((part.height + kRows - 1) / kRows), [&](std::size_t task) {
    const int first = static_cast<int>(task) * kRows;
    for (int y = first; y < std::min(first + kRows, part.height); ++y) {
      const std::span<float> row = out.subspan(static_cast<std::size_t>(y) * width, width);
      const std::span<const float> range = range_m.subspan(static_cast<std::size_t>(y) * width, width);
      lengths.row(y, row);
      for (std::size_t x = 0; x < width; ++x) row[x] = std::min(row[x] / range[x], kMost);
    }
  });
}

}  // namespace vpe::core
