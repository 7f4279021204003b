// Evaluates the surface of the embedded Mars, block by block.
#pragma once

#include <functional>
#include <span>

#include "mars/embedded/block.h"
#include "mars/embedded/craters.h"
#include "mars/embedded/landforms.h"

namespace mars::embedded {

inline constexpr double kFinestDetail_m = 0.0625;

// Returns the spacing rounded down to a power of two, at least kFinestDetail_m and at most 2^20 m. It decides
// which detail is included.
double detail_spacing_m(double spacing_m);

struct Surface {
  Octaves octaves;
  Terrain ground;
  CraterSum craters;
  alignas(64) Lane<double> height_m;
  alignas(
      64) Lane<float> grain;     // fine heights relative to their own size, about -2..2; changes the brightness
  alignas(64) Lane<float> sand;  // 0..1: share of the ground under sand
  alignas(64) Lane<float> crest;      // 0 between ridges of sand .. 1 on their crests
  alignas(64) Lane<float> rock;       // 0..1: share of rock that is visible from nearby
  alignas(64) Lane<float> rock_tone;  // -1 dark .. 1 bright
};

// Evaluates a block. `touching` are the indices of the craters that may touch it.
void evaluate(const Block& block, double detail_m, std::span<const Crater> craters,
              std::span<const std::uint32_t> touching, Surface& out);

// Receives the surface of a block and, for each of its directions, its index in the input.
using SurfaceSink = std::function<void(const Block&, std::span<const std::uint32_t> index, const Surface&)>;

// Splits any directions into compact blocks, finds their craters and evaluates them.
void evaluate_all(std::span<const glm::dvec3> directions, double spacing_m, Simd simd, const SurfaceSink& sink);

}  // namespace mars::embedded
