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

namespace {

// Returns the values of an image of `width` without those of its margin; nothing if there are none.
template <class T>
std::vector<T> inner(const std::vector<T>& values, int width, int height, glm::ivec2 margin_px) {
  std::vector<T> out;
  if (values.empty()) return out;
  const int columns = width - 2 * margin_px.x;
  const int rows = height - 2 * margin_px.y;
  out.reserve(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  for (int y = 0; y < rows; ++y) {
    const auto row = values.begin() + static_cast<std::ptrdiff_t>(y + margin_px.y) * width + margin_px.x;
    out.insert(out.end(), row, row + columns);
  }
  return out;
}

}  // namespace

Frame without_margin(const Frame& frame, glm::ivec2 margin_px) {
  return {frame.width - 2 * margin_px.x, frame.height - 2 * margin_px.y,
          inner(frame.colour, frame.width, frame.height, margin_px),
          inner(frame.range_m, frame.width, frame.height, margin_px)};
}

RgbImage without_margin(RgbImage image, glm::ivec2 margin_px) {
  if (margin_px == glm::ivec2(0)) return image;
  return {image.width - 2 * margin_px.x, image.height - 2 * margin_px.y,
          inner(image.pixels, image.width, image.height, margin_px)};
}

}  // namespace vpe::core
