#include "vpe/overlay/features/image_sight.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "vpe/overlay/draped_lines.h"

namespace vpe::overlay {
namespace {

GroundSight::Frame frame_of(const VisibleTerrain& terrain) {
  const Scene& scene = terrain.scene();
  return {scene.view.camera.position_m,
          scene.radius_m,
          scene.appearance.exaggeration,
          glm::dvec2(terrain.width(), terrain.height()),
          0,
          {std::min(terrain.width(), terrain.height()) / 720.0, core::focal_px(scene.view)}};
}

}  // namespace

ImageSight::ImageSight(const VisibleTerrain& terrain)
    : GroundSight(frame_of(terrain)),
      terrain_(terrain),
      is_open_(terrain.scene().view.projection != core::Projection::kPerspective) {
  if (is_open_) return;
  const core::View& view = terrain.scene().view;
  const core::SubRectangle part = core::drawn_part(view);
  const mars::Axes& axes = view.camera.axes;
  const double focal = core::focal_px(view);
  const glm::dvec2 principal = 0.5 * glm::dvec2(view.width, view.height) + view.principal_offset_px;
  const glm::dvec2 low = glm::dvec2(part.x, part.y) - principal - kLineMargin_px;
  const glm::dvec2 high = glm::dvec2(part.x + part.width, part.y + part.height) - principal + kLineMargin_px;
  const auto plane = [&](const glm::dvec3& side, double edge) {
    return glm::normalize(side * focal - axes.forward * edge);
  };
  inward_ = {plane(axes.right, low.x), -plane(axes.right, high.x), plane(-axes.up, low.y),
             -plane(-axes.up, high.y)};
}

bool ImageSight::is_hidden(glm::dvec2 at_px, const glm::dvec3&, double distance_m) const {
  const auto x = static_cast<int>(std::floor(at_px.x));
  const auto y = static_cast<int>(std::floor(at_px.y));
  const auto is_beyond = [&](int i, int j) {
    const std::size_t p = terrain_.index(i, j);
    if (!terrain_.is_ground(p)) return true;
    const double reach_m =
        static_cast<double>(terrain_.scene().range_m[p]) + terrain_.noise_m(p) + terrain_.deviation_m(p);
    return distance_m > reach_m + kHiddenLineShare * distance_m;
  };
  // Most places are seen at their own pixels.
  if (x >= 0 && y >= 0 && x < terrain_.width() && y < terrain_.height() && !is_beyond(x, y)) return false;
  for (int j = std::max(0, y - 1); j <= std::min(terrain_.height() - 1, y + 1); ++j) {
    for (int i = std::max(0, x - 1); i <= std::min(terrain_.width() - 1, x + 1); ++i) {
      if (!is_beyond(i, j)) return false;
    }
  }
  return true;
}

bool ImageSight::may_show(const glm::dvec3& centre_m, double radius_m) const {
  if (is_open_) return true;
  return std::ranges::all_of(
      inward_, [&](const glm::dvec3& n) { return glm::dot(n, centre_m - frame().camera_m) > -radius_m; });
}

}  // namespace vpe::overlay
