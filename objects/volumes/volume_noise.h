// Noise of space for formulas of volumes (Perlin, Improving noise, SIGGRAPH 2002): smooth, without a grid that shows.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

namespace objects {

// Returns a smooth value from -1 to 1, about 0.25 in size, that changes over a length of 1. The same for the same
// arguments. Pure.
double volume_noise(std::uint64_t seed, const glm::dvec3& at);

// Returns a sum of `octaves` noises, each twice as fine and half as large as the one before: from -1 to 1. Pure.
double fractal_noise(std::uint64_t seed, const glm::dvec3& at, int octaves);

}  // namespace objects
