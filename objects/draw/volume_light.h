// The sun's light inside the volumes of a scene, computed once for an image.
//
// Light changes little within a volume, so it is computed at the posts of a lattice and interpolated: the share of the sun
// that other objects and the volume itself let through. What the ground hides is asked for at fewer posts, as that takes
// long.
//
// Typical usage:
//   const VolumeLights lights(rays, before_sun, light, cone, pool);
//   const VolumeLight* of = lights.find(instance);
//   if (of != nullptr) incidence = of->at(place_m);
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <map>
#include <vector>

#include "objects/draw/object_shader.h"
#include "vpe/base/parallel.h"

namespace objects {

// Holds the light of one volume.
class VolumeLight {
 public:
  // Gives the most posts of a volume's light.
  static constexpr int kMostPosts = 16384;

  // Makes a lattice in a box of the model frame, with posts not closer than spacing_m, and no light on it.
  VolumeLight(const glm::dvec3& low_m, const glm::dvec3& high_m, double spacing_m);

  std::size_t size() const { return posts_.size(); }
  // Returns the place of a post, model frame.
  glm::dvec3 place_m(std::size_t post) const;
  float& post(std::size_t n) { return posts_[n]; }
  // Returns the least distance of posts beside each other.
  double spacing_m() const { return std::min({step_m_.x, step_m_.y, step_m_.z}); }
  // Returns the light at a place of the model frame, 0 to 1; beyond the box that at its border.
  float at(const glm::dvec3& place_m) const;

 private:
  glm::dvec3 low_m_;
  glm::dvec3 step_m_;
  std::array<int, 3> sides_{};
  std::vector<float> posts_;
};

// Holds the light of all volumes that a camera may see. Immutable once made; any thread may call any member.
class VolumeLights {
 public:
  // Holds no light: volumes are fully lit.
  VolumeLights() = default;
  // `cone` holds the rays of the image. The result does not depend on the threads of the pool.
  VolumeLights(const ObjectRays& rays, const SunGrid& before_sun, const ImageLight& light, const ViewCone& cone,
               vpe::base::ThreadPool& pool);

  // Returns the light of an instance; null if there is none.
  const VolumeLight* find(std::uint32_t instance) const;

 private:
  std::map<std::uint32_t, VolumeLight> lights_;
};

// Returns whether a scene has volumes. Pure.
bool has_volumes(const Scene& scene);

}  // namespace objects
