// All reliefs of a planet, in the order in which they change the ground.
//
// Typical usage:
//   const Relief relief = place(read_relief_file("pad.relief.toml"), planet_radius_m, ground_of(*source));
//   const double height_m = relief.height_m(direction, ground_m);
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "mars/sources/source.h"
#include "relief/cap_tree.h"
#include "relief/placed.h"
#include "relief/spec.h"

namespace relief {

inline constexpr std::size_t kMostReliefs = 100'000;

// Returns the height of the ground without reliefs at a unit direction, in metres above the datum; NaN for nodata. It must
// be a pure function.
using GroundHeight = std::function<double(const glm::dvec3& direction)>;

// Returns the radius of the base at a unit direction in metres. It must be a pure function.
using BaseRadius = std::function<double(const glm::dvec3& direction)>;

// Immutable: any number of threads may use it, and all results are pure functions of the arguments. The cost of a place
// grows with the number of reliefs that reach it, and with the logarithm of the number of all.
class Relief {
 public:
  Relief() = default;

  const std::vector<PlacedRelief>& placed() const { return placed_; }

  // Returns the ground at a unit direction after all changes. NaN stays NaN: no relief makes ground where there is no
  // data. Where no relief reaches, the height stays to the bit.
  double height_m(const glm::dvec3& direction, double ground_m) const;
  ReliefChange change(const glm::dvec3& direction, double ground_m) const;

  // Sets changes[i] to change(directions[i], ground_m[i]), to the bit, for places that lie close together. Sizes must be
  // equal.
  void change(std::span<const glm::dvec3> directions, std::span<const double> ground_m,
              std::span<ReliefChange> changes) const;

  // Returns true if a place of the cap may be changed.
  bool touches(const mars::Cap& cap) const;

  // Returns an interval that holds the changed heights in a cap whose ground has the heights of an interval.
  Interval bounds_m(const mars::Cap& cap, const Interval& ground_m) const;

  // Returns the least wanted distance of posts of the reliefs that touch a cap; infinity if none does.
  double spacing_m(const mars::Cap& cap) const;

 private:
  friend Relief place(std::vector<ReliefSpec> specs, const BaseRadius& radius_m, const GroundHeight& ground);

  std::vector<PlacedRelief> placed_;
  CapTree tree_;
};

// Places reliefs on a sphere of radius_m. The zero of each that counts from the ground is the ground at its place as the
// reliefs before it leave it; `ground` is called for these alone, and may be empty if there are none. Throws
// std::runtime_error with the name of the relief for one that has a problem_of(), reaches too far, or needs ground where
// there is none, and for more than kMostReliefs.
Relief place(std::vector<ReliefSpec> specs, double radius_m, const GroundHeight& ground);

// Places reliefs on another body likewise. Each lies on the sphere with the body's radius at its place: lengths are true there
// as far as the body's surface has the same radius and is across the direction from the centre.
Relief place(std::vector<ReliefSpec> specs, const BaseRadius& radius_m, const GroundHeight& ground);

// Returns the name of a relief in messages: 'relief 3 "pad"' or 'relief 3'. Numbers begin with 1.
std::string relief_title(const ReliefSpec& spec, std::size_t number);

}  // namespace relief
