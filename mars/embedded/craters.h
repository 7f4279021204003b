// Craters: a seeded population on nested lattices, and the named ones of the gazetteer.
//
// Level L contains diameters from 2^L to 2^(L+1) metres, N(>D) ~ D^-2. Each cell of a cubic lattice has one
// random point; the points in a thin spherical layer at the surface are the candidates, so that their density
// is even, without seams or poles. Terrain::cratered at the place of a candidate decides whether the crater
// exists.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mars/embedded/block.h"

namespace mars::embedded {

inline constexpr int kSmallestCraterLevel = 1;
inline constexpr int kLargestCraterLevel = 17;

// Returns the smallest level present at a spacing (a power of two): diameters of four spacings and more.
int smallest_crater_level(double spacing_m);

struct Crater {
  glm::dvec3 centre;  // unit
  double radius_m = 0;
  float depth_m = 0;  // floor below the plain
  float rim_m = 0;    // crest of the rim above the plain
  float floor = 0;    // (radius of the flat floor / radius)^2, 0 = bowl
  float peak_m = 0;   // central peak
  float ring = 0;     // (radius of a peak ring / radius)^2, 0 = none
  float sharp = 1;    // 1 fresh .. 0 worn down
  float lobe_m = 0;   // thickness of a fluidised ejecta sheet
  int level = 0;
};

// Extent of the ejecta in radii; exactly 0 beyond.
inline constexpr double kEjectaReach = 2.5;

// Describes a crater that exists if keep < share * density of the ground at its place.
struct Candidate {
  Crater crater;
  float keep = 0;
};

// Returns the edge of the lattice cells in metres.
double crater_cell_m(int level);

// Appends the candidates of a level that may touch the ball about `centre` (a point near the unit sphere) with
// radius `reach` (chord), in a fixed order.
void find_candidates(const glm::dvec3& centre, double reach, int level, std::vector<Candidate>& out);

// Appends the candidates that exist, which depends on the ground at their places.
void keep_craters(std::span<const Candidate> candidates, Simd simd, std::vector<Crater>& out);

// Appends the named craters that may touch the ball.
void find_named_craters(const glm::dvec3& centre, double reach, double smallest_m, std::vector<Crater>& out);

// Sums heights of craters in units of 1 / kCraterUnits metre: integers, so that the sum does not depend on the
// order.
inline constexpr int kLargeCraterLevel = 12;  // 4 km
inline constexpr int kBasinLevel = 15;        // 33 km
inline constexpr float kCraterUnits = 1024.0F;
struct CraterSum {
  alignas(64) Lane<std::int32_t> relief;  // heights of craters below kLargeCraterLevel [1 / kCraterUnits m]
  alignas(64) Lane<std::int32_t> large;   // heights of the others, which younger troughs cut away
  // How much floors and ejecta smooth older roughness shorter than the crater, 0..1 (maxima).
  alignas(64) Lane<float> buried;  // by craters of kLargeCraterLevel and more
  alignas(64) Lane<float> filled;  // of kBasinLevel and more
  alignas(64) Lane<float> ignored;
  alignas(64) Lane<float> fresh;  // 0..1: fresh walls and rims (maximum)

  // Sets all to 0.
  void clear();
};

// Adds a crater. `ragged` is noise with a wavelength of about the crater's radius, which makes its outline
// irregular.
void add_crater(const Block& block, const Crater& crater, const Lane<float>& ragged, CraterSum& sum);

}  // namespace mars::embedded
