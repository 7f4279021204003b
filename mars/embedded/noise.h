// Gradient noise in three dimensions (Perlin 2002: quintic fade), hashed instead of tabled.
#pragma once

#include <cstdint>

#include "mars/embedded/block.h"

namespace mars::embedded {

// Sets `out` to noise of wavelength `wavelength_m` on the sphere of kRadius_m at the block's directions: mean
// 0, standard deviation about 1, |value| < 8, C2. Each `seed` rotates the lattice (one of 8 rotations) and
// shifts it. Values depend on direction, wavelength and seed alone.
void noise(const Block& block, double wavelength_m, std::uint32_t seed, Lane<float>& out);

// Does the same in double precision. Use it where noise is multiplied by kilometres of height: the steps of a
// float (1e-7 of the amplitude) would show at a post spacing of a metre.
void noise(const Block& block, double wavelength_m, std::uint32_t seed, Lane<double>& out);

// Holds points in metres from the planet's centre.
struct Points {
  alignas(64) Lane<double> x, y, z;
};

// Does the same at any points (|coordinate| / wavelength < 2^30).
void noise(const Points& points_m, std::size_t padded, Simd simd, double wavelength_m, std::uint32_t seed,
           Lane<float>& out);

}  // namespace mars::embedded
