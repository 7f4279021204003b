// What things that stand on the ground need to know about its light.
#pragma once

#include <glm/vec3.hpp>

namespace vpe::core {

// Any thread may call any member of an implementation.
class GroundLight {
 public:
  virtual ~GroundLight() = default;

  // Returns the factor, 0 to 1, on the colour of ground that the sun lights, when something hides the sun there: the
  // light without the sun over that with it. 1 where ground is not lit or in shadow already. place_m is near the ground,
  // from the planet's centre; posts of about footprint_m apart decide its slope.
  virtual double shadow_factor(const glm::dvec3& place_m, double footprint_m) const = 0;

  // Returns whether no ground hides the sun from a place above the ground. True where ground casts no shadows.
  virtual bool sees_sun(const glm::dvec3& place_m) const = 0;
};

}  // namespace vpe::core
