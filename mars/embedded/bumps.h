// Smooth fields on the sphere, made of many equal bumps on a Fibonacci lattice. They show what is broader than
// about three lattice steps.
//
// value = step * sum coefficient_k (1 - chord^2 / reach^2)^3 over the bumps within `reach`.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mars/embedded/block.h"

namespace mars::embedded {

template <typename Coefficient>
struct Bumps {
  std::vector<glm::dvec3> centres;  // unit, in order of falling z
  std::span<const Coefficient> coefficients;
  double reach;  // chord on the unit sphere
  double step;
};

// Returns the unit centre of bump k of `count`.
glm::dvec3 bump_centre(int k, int count);

// Returns the centres of all bumps.
std::vector<glm::dvec3> bump_centres(int count);

// Set out[i] to the field at each direction. Terms are added in the order of k.
void sum_bumps(const Block& block, const Bumps<std::int16_t>& bumps, Lane<double>& out);
void sum_bumps(const Block& block, const Bumps<std::int8_t>& bumps, Lane<double>& out);

}  // namespace mars::embedded
