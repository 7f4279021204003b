// Craters: a seeded population on nested lattices, and the named ones of the gazetteer.
//
// Level L holds diameters from 2^L to 2^(L+1) metres, N(>D) ~ D^-2. Its candidates are one random point a cell
// of a cubic lattice; those in a shell about the sphere are taken, so that density is even, without seams or
// poles. How many survive is decided by Terrain::cratered at the candidate's own place.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mars/embedded/block.h"

namespace mars::embedded {

inline constexpr int kSmallestCraterLevel = 1;
inline constexpr int kLargestCraterLevel = 17;

// The smallest level kept at a (power of two) spacing: diameters of four spacings and more.
int smallest_crater_level(double spacing_m);

struct Crater {
  glm::dvec3 centre;  // unit
  double radius_m = 0;
  float depth_m = 0;  // floor below the plain
  float rim_m = 0;    // crest above it
  float floor = 0;    // (radius of the flat floor / radius)^2, 0 = bowl
  float peak_m = 0;   // central peak
  float ring = 0;     // (radius of a peak ring / radius)^2, 0 = none
  float sharp = 1;    // 1 fresh .. 0 worn down
  float lobe_m = 0;   // thickness of a fluidised ejecta sheet
  int level = 0;
};

// How far the ejecta are modelled, in radii; exactly 0 beyond.
inline constexpr double kEjectaReach = 2.5;

// A candidate whose fate depends on the ground: it is there when keep < share * density of its ground.
struct Candidate {
  Crater crater;
  float keep = 0;
};

// Edge of the lattice's cells.
double crater_cell_m(int level);

// Appends the candidates of a level that may touch the ball about `centre` (a point near the unit sphere) with
// radius `reach` (chord), in a fixed order.
void find_candidates(const glm::dvec3& centre, double reach, int level, std::vector<Candidate>& out);

// Appends the craters among the candidates, by the ground they are on.
void keep_craters(std::span<const Candidate> candidates, Simd simd, std::vector<Crater>& out);

// Named craters that may touch the ball.
void find_named_craters(const glm::dvec3& centre, double reach, double smallest_m, std::vector<Crater>& out);

// Relief of craters in units of 1 / kCraterUnits metre: integers, so that the sum does not depend on order.
inline constexpr int kLargeCraterLevel = 12;  // 4 km
inline constexpr int kBasinLevel = 15;        // 33 km
inline constexpr float kCraterUnits = 1024.0F;
struct CraterSum {
  alignas(64) Lane<std::int32_t> relief;  // of craters below kLargeCraterLevel [1 / kCraterUnits m]
  alignas(64) Lane<std::int32_t> large;   // of the others, which younger troughs cut away
  // Older roughness shorter than the crater is smoothed by its floor and ejecta, 0..1 (maxima).
  alignas(64) Lane<float> buried;  // by craters of kLargeCraterLevel and more
  alignas(64) Lane<float> filled;  // of kBasinLevel and more
  alignas(64) Lane<float> ignored;
  alignas(64) Lane<float> fresh;  // 0..1: fresh walls and rims (maximum)
  void clear();
};
// `ragged`: noise of about the crater's own radius in wavelength; makes outlines irregular.
void add_crater(const Block& block, const Crater& crater, const Lane<float>& ragged, CraterSum& sum);

}  // namespace mars::embedded
