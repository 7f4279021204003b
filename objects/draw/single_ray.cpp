#include "objects/draw/single_ray.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "objects/draw/volume_rays.h"
#include "objects/model/surface_sample.h"

namespace objects {

std::optional<SeenObject> first_among(std::span<const PlacedObject> objects, const ObjectRay& ray,
                                      double until_m) {
  RayResult met;
  nearest_object(objects, all_of(objects), ray, until_m, 0, met);
  std::vector<VolumeCrossing> crossings;
  enter_volumes(objects, all_of(objects), ray, until_m, crossings);
  double through = 1;
  std::optional<SeenObject> seen;
  in_order(
      met, crossings,
      [&](const ObjectHit& hit) {
        const PlacedObject& o = objects[hit.object];
        const float opacity =
            met.has_front && hit.range_m >= met.front.range_m ? 255
            : o.level == nullptr
                ? hit.opacity
                : surface_colour(o.level->mesh, o.model->textures(), hit.triangle, hit.weights, 0).w;
        through *= 1 - static_cast<double>(opacity) / 255;
        if (through <= 0.5) seen = SeenObject{hit.range_m, o.instance};
        return !seen;
      },
      [&](const VolumeStretch& stretch) {
        for (const std::uint32_t n : stretch.crossings) {
          const VolumeCrossing& c = crossings[n];
          const PlacedObject& o = objects[c.object];
          march(*o.volume, c.ray, stretch.begin_m - c.begin_m, stretch.end_m - c.begin_m,
                [&](const VolumeStep& step) {
                  const double left = through * std::exp(-step.depth);
                  if (left <= 0.5) {
                    const double share = std::log(2 * through) / step.depth;
                    seen = SeenObject{c.begin_m + step.begin + share * (step.end - step.begin), o.instance};
                  }
                  through = left;
                  return !seen;
                });
          if (seen) break;
        }
        return !seen;
      });
  return seen;
}

std::optional<SeenObject> first_object(const Scene& scene, const ObjectRay& ray, double until_m) {
  LevelRule rule;
  rule.camera_m = ray.origin_m;
  rule.least_ray_px = 0;
  const ObjectRays rays(scene, rule);
  std::vector<PlacedObject> objects;
  scene.visit([&](const SceneBall& ball) { return may_meet(ray, until_m, ball); },
              [&](std::uint32_t n) { objects.push_back(rays.placed(n)); });
  std::sort(objects.begin(), objects.end(), [](const PlacedObject& a, const PlacedObject& b) {
    return a.near_m != b.near_m ? a.near_m < b.near_m : a.instance < b.instance;
  });
  return first_among(objects, ray, until_m);
}

}  // namespace objects
