#include "vpe/core/margin.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/trigonometric.hpp>

namespace vpe::core {

View with_margin(const View& view, glm::ivec2 margin_px) {
  if (margin_px == glm::ivec2(0)) return view;
  View wide = view;
  wide.width += 2 * margin_px.x;
  wide.height += 2 * margin_px.y;
  const double tangent = std::tan(glm::radians(0.5 * view.fov_deg)) * wide.height / view.height;
  wide.fov_deg = 2 * glm::degrees(std::atan(tangent));
  return wide;
}

glm::ivec2 margin_for(const View& view, std::span<const View> others, double nearest_m, glm::ivec2 most_px) {
  constexpr double kInfinite_m = 1e12;
  const glm::dvec2 size(view.width, view.height);
  const glm::dvec2 most(most_px);
  glm::dvec2 beyond(0);
  for (const View& other : others) {
    for (const glm::dvec2& at : {glm::dvec2(0, 0), glm::dvec2(0.5, 0), glm::dvec2(1, 0), glm::dvec2(0, 0.5),
                                 glm::dvec2(1, 0.5), glm::dvec2(0, 1), glm::dvec2(0.5, 1), glm::dvec2(1, 1)}) {
      const glm::dvec3 ray = pixel_ray(other, at.x * other.width, at.y * other.height);
      for (const double range_m : {nearest_m, kInfinite_m}) {
        const Projected seen = project(view, other.camera.position_m + range_m * ray);
        if (seen.behind) return most_px;
        beyond = glm::max(beyond, glm::max(-seen.xy, seen.xy - size));
      }
    }
  }
  constexpr double kRounding_px = 1e-6;
  return glm::ceil(glm::max(glm::min(beyond, most) - kRounding_px, 0.0));
}

Frame without_margin(const Frame& frame, glm::ivec2 margin_px) {
  Frame out{frame.width - 2 * margin_px.x, frame.height - 2 * margin_px.y, {}, {}};
  const auto crop = [&](const auto& from, auto& to) {
    if (from.empty()) return;
    to.reserve(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height));
    for (int y = 0; y < out.height; ++y) {
      const auto row = from.begin() + static_cast<std::ptrdiff_t>(y + margin_px.y) * frame.width + margin_px.x;
      to.insert(to.end(), row, row + out.width);
    }
  };
  crop(frame.colour, out.colour);
  crop(frame.range_m, out.range_m);
  return out;
}

}  // namespace vpe::core
