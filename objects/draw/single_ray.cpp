#include "objects/draw/single_ray.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "objects/model/surface_sample.h"

namespace objects {

namespace {

// Objects are sorted from near to far.
std::optional<SeenObject> first_among(const std::vector<PlacedObject>& objects, const ObjectRay& ray,
                                      double until_m) {
  RayResult met;
  nearest_object(objects, all_of(objects), ray, until_m, 0, met);
  double through = 1;
  for (const ObjectHit& layer : met.layers) {
    const PlacedObject& o = objects[layer.object];
    const float opacity =
        o.level == nullptr
            ? layer.opacity
            : surface_colour(o.level->mesh, o.model->textures(), layer.triangle, layer.weights, 0).w;
    through *= 1 - static_cast<double>(opacity) / 255;
    if (through <= 0.5) return SeenObject{layer.range_m, o.instance};
  }
  if (!met.has_front) return std::nullopt;
  return SeenObject{met.front.range_m, objects[met.front.object].instance};
}

}  // namespace

std::optional<SeenObject> first_object(const Scene& scene, const ObjectRay& ray, double until_m) {
  LevelRule rule;
  rule.camera_m = ray.origin_m;
  const ObjectRays rays(scene, rule);
  std::vector<PlacedObject> objects;
  scene.visit(
      [&](const SceneBall& ball) {
        const glm::dvec3 to = ball.centre_m - ray.origin_m;
        const double along = glm::dot(to, ray.direction);
        if (along < -ball.radius_m || along - ball.radius_m > until_m) return false;
        return glm::length(to - along * ray.direction) <= ball.radius_m;
      },
      [&](std::uint32_t n) {
        objects.push_back(rays.placed(n));
        objects.back().by_rays = true;
      });
  std::sort(objects.begin(), objects.end(), [](const PlacedObject& a, const PlacedObject& b) {
    return a.near_m != b.near_m ? a.near_m < b.near_m : a.instance < b.instance;
  });
  return first_among(objects, ray, until_m);
}

std::optional<double> first_of(const Scene& scene, std::uint32_t instance, const ObjectRay& ray,
                               double until_m) {
  LevelRule rule;
  rule.camera_m = ray.origin_m;
  std::vector<PlacedObject> objects{ObjectRays(scene, rule).placed(instance)};
  objects.front().by_rays = true;
  const std::optional<SeenObject> seen = first_among(objects, ray, until_m);
  return seen ? std::optional(seen->range_m) : std::nullopt;
}

}  // namespace objects
