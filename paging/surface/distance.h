// Distance from a place to the nearest ground.
#pragma once

#include <glm/vec3.hpp>

#include "paging/surface/surface.h"

namespace paging {

// Returns the distance from a place (metres from the planet's centre) to the nearest point of the surface, within 1e-9 of
// the planet's radius; 0 for a place on or below the surface. With an exaggeration: of the surface as drawn. Reads the
// finest tiles that might hold the nearest point, by their greatest heights. Any thread may call it. Throws PlanetError.
double distance_to_ground_m(const Surface& surface, const glm::dvec3& place_m, double exaggeration = 1.0);

}  // namespace paging
