// Craters smaller than the data show: a seeded population on nested lattices.
//
// Level L contains diameters from 2^L to 2^(L+1) metres. Each cell of a cubic lattice has one random point; the points in
// a thin spherical layer at the surface are the candidates, so that their density is even, without seams or poles. How many
// of them exist follows from the ground at their places (crater_density()).
//
// A crater has no volume: what its ejecta and rim rise above the ground is what its cavity lies below. No cavity covers a
// post of the data, and ejecta fade towards posts, so that posts keep their heights.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mars/embedded/block.h"
#include "mars/embedded/ground.h"

namespace mars::embedded {

inline constexpr int kSmallestCraterLevel = 3;
inline constexpr int kLargestCraterLevel = 12;  // 4 to 8 km: larger ones are in the data

// Returns the smallest level present at a spacing (a power of two): diameters of four spacings and more.
int smallest_crater_level(double spacing_m);

// Returns the number of craters of diameters of `diameter_m` and more for each square metre, on ground of this density
// relative to the southern highlands (Ground::cratered).
//
// It is the production function of Ivanov (2001) for Mars, for an age between 0.15 Ga (0) and 3.8 Ga (1), where old ground
// has ten times the craters of 1 Ga. It is at most 4 % of geometric saturation, 1.54 D^-2 (Gault 1970; Hartmann 1984).
// It is tabulated at powers of two metres from 8 m to 8192 m and interpolated by powers of D.
double crater_density(double diameter_m, double cratered);

struct Crater {
  glm::dvec3 centre;  // unit
  double radius_m = 0;
  float depth_m = 0;  // floor below the plain
  float rim_m = 0;    // crest of the rim above the plain
  float floor = 0;    // (radius of the flat floor / radius)^2, 0 = bowl
  float sharp = 1;    // 1 fresh .. 0 worn down
  float lobe_m = 0;   // thickness of a fluidised ejecta sheet
  int level = 0;
};

// Extent of the ejecta in radii; exactly 0 beyond.
inline constexpr double kEjectaReach = 2.5;

// Describes a crater that exists if keep is below what the ground at its place allows.
struct Candidate {
  Crater crater;
  float keep = 0;
};

// Returns the edge of the lattice cells in metres.
double crater_cell_m(int level);

// Appends the candidates of a level that may touch the ball about `centre` (a point near the unit sphere) with
// radius `reach` (chord), in a fixed order.
void find_candidates(const glm::dvec3& centre, double reach, int level, std::vector<Candidate>& out);

// Appends the candidates that exist, which depends on the ground at their places and on the posts beside them.
void keep_craters(std::span<const Candidate> candidates, const MeasuredMars& mars, Simd simd,
                  std::vector<Crater>& out);

// Sums heights of craters in units of 1 / kCraterUnits metre: integers, so that the sum does not depend on the
// order.
inline constexpr float kCraterUnits = 1024.0F;
inline constexpr int kHollowCraterLevel = 10;  // 1 km
struct CraterSum {
  alignas(64) Lane<std::int32_t> relief;  // heights [1 / kCraterUnits m]
  // Holds how much floors of craters of kHollowCraterLevel and more smooth roughness below 1 km: 0..1 (maximum).
  alignas(64) Lane<float> hollow;
  alignas(64) Lane<float> fresh;  // 0..1: fresh walls and rims (maximum)

  // Sets all to 0.
  void clear();
};

// Adds a crater. `ragged` is noise with a wavelength of about the crater's radius, which makes its outline
// irregular. `post_m` are the distances to the nearest posts.
void add_crater(const Block& block, const Crater& crater, const Lane<float>& ragged, const Lane<double>& post_m,
                CraterSum& sum);

}  // namespace mars::embedded
