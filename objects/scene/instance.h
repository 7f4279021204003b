// One object: a model at a place.
#pragma once

#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace objects {

// A place of a model in the body-fixed frame: x_body = position + scale * rotation * mirror(x_model). The rotation is
// stored in single precision: a point r metres from the origin is placed within 1.5e-7 scale r.
struct Instance {
  glm::dvec3 position_m{0, 0, 0};  // of the model's origin, from the planet's centre
  glm::quat rotation{1, 0, 0, 0};  // unit
  float scale = 1;                 // above 0
  std::uint32_t model = 0;         // of Scene::models()
  std::uint32_t name = 0;          // of Scene::names(); 0: none
  bool is_mirrored = false;        // x_model counts to the left
  bool operator==(const Instance&) const = default;
};

}  // namespace objects
