// Rays against the objects of a scene, as a camera sees them.
//
// Typical usage:
//   const ObjectRays rays(scene, rule);
//   const std::vector<PlacedObject> objects = rays.in_cone(cone, until_m);
//   nearest_object(objects, all_of(objects), ray, until_m, footprint, seen);
#pragma once

#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
#include <vector>

#include "objects/scene/scene.h"

namespace objects {

// Says how the levels of models follow from their distance.
struct LevelRule {
  glm::dvec3 camera_m{0, 0, 0};
  double focal_px = 1;      // pixels of a unit of tangent at the image's middle
  double stretch = 1;       // core::corner_stretch()
  double tolerance_px = 0;  // of the image of a model's error; 0: the finest levels
  // Below this size at the image's middle an object is drawn by the share of the pixels that it covers, in place of rays.
  double least_ray_px = 1.5;
};

// Gives the size, across, below which an object is not drawn. There it begins with half of its opacity, and has all of it from
// kFullDiameter_px on.
inline constexpr double kLeastDiameter_px = 0.5;
inline constexpr double kFullDiameter_px = 1.0;
// Give the sizes from which on rays meet an object: with several rays in each pixel at edges, and with one. With a tolerance
// of less than half of that: from twice the tolerance on.
inline constexpr double kSmoothRayDiameter_px = 1.5;
inline constexpr double kHardRayDiameter_px = 3;
// Gives the spacing of a volume's posts below which a coarser level is taken whatever the tolerance: a pixel has one ray
// through a volume.
inline constexpr double kLeastPosts_px = 0.5;

// Holds an instance with what rays need.
struct PlacedObject {
  const Model* model = nullptr;
  const Model::Level* level = nullptr;  // of meshes, else null
  const VolumeLevel* volume = nullptr;  // of a semi-transparent volume, else null
  std::size_t level_index = 0;
  std::uint32_t instance = 0;
  bool is_mirrored = false;
  float scale = 1;
  double near_m = 0;       // distance of its ball from the camera
  double diameter_px = 0;  // largest size in the image
  bool by_rays = true;
  SceneBall around;          // body-fixed
  glm::dvec3 position_m{};   // of the model's origin, body-fixed
  glm::dmat3 to_model{};     // of directions: the inverse of scale, rotation and mirroring
  glm::dmat3 to_body{};      // rotation and mirroring, without scale
  glm::dvec3 ball_m{};       // centre, model frame
  double ball_radius_m = 0;  // model frame
};

// Holds all directions within an angle of an axis.
struct ViewCone {
  glm::dvec3 axis{0, 0, 1};  // unit
  double cosine = 1;
  double sine = 0;  // not negative: the angle is at most 180 degrees
};
// Returns whether a ball reaches into a cone about `origin_m`. Never false for one that does.
bool meets(const ViewCone& cone, const glm::dvec3& origin_m, const glm::dvec3& centre_m, double radius_m);

// Describes a place where a ray meets an object.
struct ObjectHit {
  double range_m = 0;  // along the unit ray
  std::uint32_t object = 0;
  std::uint32_t triangle = 0;
  glm::vec2 weights{0, 0};  // of the triangle's second and third corner
  StickVoxel voxel;         // of sticks
  glm::vec3 face{0, 0, 1};  // outward normal of the voxel's side, model frame
  float opacity = 255;      // of a layer of sticks, 0 to 255
};

// Marks the number of an image of the scene (seen_posters.h) in ObjectHit::object. Then `weights` is its uv and
// `opacity` is PosterHit::texels.
inline constexpr std::uint32_t kPosterBit = std::uint32_t{1} << 31U;
inline bool is_poster(std::uint32_t object) { return (object & kPosterBit) != 0; }

struct ObjectRay {
  glm::dvec3 origin_m;   // body-fixed
  glm::dvec3 direction;  // unit
};

// Returns true if a ray may meet what a ball holds, up to until_m along it. Pure.
inline bool may_meet(const ObjectRay& ray, double until_m, const SceneBall& ball) {
  const glm::dvec3 to = ball.centre_m - ray.origin_m;
  const double along = glm::dot(to, ray.direction);
  if (along < -ball.radius_m || along - ball.radius_m > until_m) return false;
  return glm::length(to - along * ray.direction) <= ball.radius_m;
}

// Holds what a ray meets: semi-transparent places from near to far, then at most one opaque place behind them.
struct RayResult {
  std::vector<ObjectHit> layers;
  ObjectHit front;
  bool has_front = false;
};

// Finds objects for one camera. Any thread may call any member.
class ObjectRays {
 public:
  // The scene must outlive this.
  ObjectRays(const Scene& scene, const LevelRule& rule) : scene_(scene), rule_(rule) {}

  const Scene& scene() const { return scene_; }
  const LevelRule& rule() const { return rule_; }
  // Returns an instance as this camera sees it.
  PlacedObject placed(std::uint32_t instance) const;
  // Returns the objects whose balls reach into a cone about the camera, and are nearer than until_m and not too small
  // to be drawn, from near to far. Equal distances: by instance.
  std::vector<PlacedObject> in_cone(const ViewCone& cone, double until_m) const;
  // Returns false if nothing in a ball is large enough to be drawn. Never false if something is.
  bool is_drawn(const SceneBall& ball) const;

 private:
  double diameter_px(double radius_m, double distance_m) const;

  const Scene& scene_;
  LevelRule rule_;
};

// Names objects by their numbers in a list.
using ObjectNumbers = std::vector<std::uint32_t>;
ObjectNumbers all_of(std::span<const PlacedObject> objects);

// Finds what a ray meets before until_m among the named objects of a list that is sorted from near to far, as in_cone()
// sorts it. footprint is the angle of a pixel, radians. Volumes are left out (volume_rays.h). `out` is overwritten.
void nearest_object(std::span<const PlacedObject> objects, std::span<const std::uint32_t> named,
                    const ObjectRay& ray, double until_m, double footprint, RayResult& out);

// Returns the share of light that comes along a ray through the named objects: 0 behind an opaque one. Volumes are taken
// one level coarser than images take them.
double light_through(std::span<const PlacedObject> objects, std::span<const std::uint32_t> named,
                     const ObjectRay& ray);

}  // namespace objects
