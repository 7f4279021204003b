#include "vpe/overlay/features/area_pixels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "vpe/overlay/features/area_colours.h"

namespace vpe::overlay {
namespace {

glm::dvec2 place_of(const glm::dvec3& point_m) {
  return glm::dvec2(std::atan2(point_m.y, point_m.x), std::atan2(point_m.z, std::hypot(point_m.x, point_m.y))) /
         mars::kRadiansPerDegree;
}

// Fills the pixels of one row.
class RowFill {
 public:
  RowFill(const std::vector<SceneLayer>& layers, const core::View& view, const FeatureScale& scale,
          const GroundAnswers& ground)
      : view_(view),
        ground_(ground),
        part_(core::drawn_part(view)),
        camera_m_(view.camera.position_m),
        pixel_rad_(1 / core::focal_px(view)) {
    for (const SceneLayer& layer : layers)
      if (!layer.features->areas().empty()) areas_.emplace_back(*layer.features, layer.opacity, scale);
  }

  void fill(int y, const PixelBlock& block) {
    const std::size_t row = block.begin + static_cast<std::size_t>(y) * block.stride;
    for (int x = 0; x < part_.width; ++x) {
      const std::size_t n = row + static_cast<std::size_t>(x);
      auto range_m = static_cast<double>(block.range_m[n]);
      const glm::dvec3 ray = core::pixel_ray(view_, part_.x + x + 0.5, part_.y + y + 0.5);
      if (std::isnan(range_m)) range_m = ground_.cast(camera_m_, ray);
      if (!std::isfinite(range_m) || range_m <= 0) continue;
      const FillColour own = colour(x, y, ray, range_m);
      if (own.a > 0) block.colour[n] = own.over(block.colour[n]);
    }
  }

 private:
  FillColour colour(int x, int y, const glm::dvec3& ray, double range_m) {
    const glm::dvec3 point_m = camera_m_ + ray * range_m;
    const glm::dvec2 place = place_of(point_m);
    FillColour sum;
    bool has_places = false;
    std::array<glm::dvec2, 4> places;
    for (const AreaColours& areas : areas_) {
      // Ground that is seen at a slant covers more of it: the pad is for edges of extents alone.
      const double pad_rad = 4 * range_m * pixel_rad_ / glm::length(point_m);
      const double shrink = std::max(std::cos(place.y * mars::kRadiansPerDegree), 1e-3);
      areas.find(place, std::min(pad_rad / mars::kRadiansPerDegree / shrink, AreaTree::kLargestPad_deg),
                 found_);
      if (found_.empty()) continue;
      if (!has_places) places = places_in(x, y, point_m, ray, range_m);
      has_places = true;
      FillColour own;
      for (const glm::dvec2& at : places) own.add(areas.at(found_, at, range_m, nullptr), 0.25);
      sum = own.over(sum);
    }
    return sum;
  }

  // Returns the places of four points in a pixel on the plane of the ground at its middle.
  std::array<glm::dvec2, 4> places_in(int x, int y, const glm::dvec3& point_m, const glm::dvec3& ray,
                                      double range_m) const {
    constexpr double kFarthest =
        2;  // times the range; at rims of the ground the plane may be seen from its edge
    constexpr std::array<glm::dvec2, 4> kAt{glm::dvec2{0.25, 0.25}, glm::dvec2{0.75, 0.25},
                                            glm::dvec2{0.25, 0.75}, glm::dvec2{0.75, 0.75}};
    const glm::dvec3 normal = ground_.normal(point_m);
    const double depth_m = glm::dot(normal, ray) * range_m;
    std::array<glm::dvec2, 4> places;
    for (std::size_t k = 0; k < places.size(); ++k) {
      const glm::dvec3 along = core::pixel_ray(view_, part_.x + x + kAt[k].x, part_.y + y + kAt[k].y);
      const double at_m = depth_m / glm::dot(normal, along);
      const bool is_near = at_m > range_m / kFarthest && at_m < range_m * kFarthest;
      places[k] = place_of(is_near ? camera_m_ + along * at_m : point_m);
    }
    return places;
  }

  const core::View& view_;
  const GroundAnswers& ground_;
  core::SubRectangle part_;
  glm::dvec3 camera_m_;
  double pixel_rad_;
  std::vector<AreaColours> areas_;
  std::vector<std::uint32_t> found_;
};

}  // namespace

void fill_pixels(const std::vector<SceneLayer>& layers, const core::View& view, const FeatureScale& scale,
                 const GroundAnswers& ground, base::ThreadPool& pool, const PixelBlock& block) {
  const glm::ivec2 size = core::drawn_size(view);
  pool.run(static_cast<std::size_t>(size.y),
           [&](std::size_t y) { RowFill(layers, view, scale, ground).fill(static_cast<int>(y), block); });
}

}  // namespace vpe::overlay
