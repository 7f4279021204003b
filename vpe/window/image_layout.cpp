#include "vpe/window/image_layout.h"

#include <algorithm>

namespace vpe::window {

glm::ivec2 ImageLayout::counts() const {
  return {stereo == core::StereoLayout::kSideBySide ? 2 : 1, stereo == core::StereoLayout::kOverUnder ? 2 : 1};
}

glm::ivec2 ImageLayout::eye_size() const {
  return {std::max(1, static_cast<int>(view.width) / counts().x),
          std::max(1, static_cast<int>(view.height) / counts().y)};
}

ViewArea ImageLayout::image_area() const {
  const glm::ivec2 size = eye_size() * counts();
  return {view.x, view.y, static_cast<double>(size.x), static_cast<double>(size.y)};
}

ViewArea ImageLayout::eye_area(int eye) const {
  const glm::dvec2 size = eye_size();
  const bool is_below = counts().y > 1;
  return {view.x + (is_below ? 0 : eye * size.x), view.y + (is_below ? eye * size.y : 0), size.x, size.y};
}

int ImageLayout::eye_at(glm::dvec2 cursor) const {
  for (int eye = eyes() - 1; eye > 0; --eye) {
    const ViewArea area = eye_area(eye);
    if (cursor.x >= area.x && cursor.y >= area.y) return eye;
  }
  return 0;
}

std::optional<glm::dvec2> ImageLayout::camera_xy(glm::dvec2 cursor) const {
  if (!image_area().holds(cursor.x, cursor.y)) return std::nullopt;
  return xy_of(eye_at(cursor), cursor);
}

glm::dvec2 ImageLayout::xy_of(int eye, glm::dvec2 cursor) const {
  const ViewArea area = eye_area(eye);
  return {cursor.x - area.x, cursor.y - area.y};
}

}  // namespace vpe::window
