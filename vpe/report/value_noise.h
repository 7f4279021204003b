// Seeded noise as a function of a point, for made-up terrain. The same bits on every machine.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

namespace vpe::report {

// Returns a smooth value in about -1..1 whose waves are about one unit long: random values at the points of the
// unit lattice, interpolated with 3 t^2 - 2 t^3. May be called from any thread.
double value_noise(const glm::dvec3& point, std::uint64_t seed);

}  // namespace vpe::report
