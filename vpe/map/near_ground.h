// Values of the ground in a direction that is known within an error, where their rounding does not depend on it.
#pragma once

#include <glm/vec3.hpp>
#include <optional>

#include "paging/surface/surface.h"

namespace vpe::map {

// Holds a point of a facet on which all directions within an error lie. Each value is the float that the exact value rounds
// to in every one of these directions, or nullopt where there are several. For one thread.
class NearGround {
 public:
  // `point` is that of PlaceCursor::move_near(); it and the unit `direction` must outlive the object.
  NearGround(const paging::SurfacePoint& point, const glm::dvec3& direction, double error_rad);

  // Returns the height, metres.
  std::optional<float> elevation() const;
  // Return the values of paging::slope_and_aspect(), degrees.
  std::optional<float> slope() const;
  std::optional<float> aspect() const;
  // Returns the cosine of incidence of a light in the sky of the place, at least 0.
  std::optional<float> shade(double azimuth_deg, double elevation_deg) const;

 private:
  // Holds components of the normal in the frame of the place.
  struct Tilt {
    double east;
    double north;
    double up;
    double error;  // of each
  };
  // Returns nullopt too near to a pole.
  std::optional<Tilt> tilt() const;

  const paging::SurfacePoint& point_;
  const glm::dvec3& direction_;
  double error_rad_;
};

}  // namespace vpe::map
