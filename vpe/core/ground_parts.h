// Solid things that are part of a planet's ground: added to it (arches, overhangs), or cut out of it (pits, tubes).
//
// Typical usage:
//   auto parts = std::make_shared<core::GroundParts>();
//   parts->push_back({.name = "arch", .centre_m = middle_m, .radius_m = 40, .voxel_m = 0.25, .solids = spans_of_arch});
//   request.ground_parts = parts;
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

namespace vpe::core {

// Holds a solid part of a vertical line, in metres above the planet's sphere, `low_m` below `high_m`.
struct SolidSpan {
  double low_m = 0;
  double high_m = 0;
};

// Adds what is solid along the vertical of a unit direction, in any order. Spans may overlap.
using SolidsAt = std::function<void(const glm::dvec3& up, std::vector<SolidSpan>& solids)>;

// One such thing. Immutable once it is in a request.
struct GroundPart {
  std::string name = {};         // for messages
  bool is_cut = false;           // false: it is added
  glm::dvec3 centre_m{0, 0, 0};  // of a ball that all of it lies in, body-fixed
  double radius_m = 0;           // of the ball
  double voxel_m = 1;            // side of the voxels that it is drawn with
  SolidsAt solids = {};          // any thread may call it
};

// Holds all of them. What is added stays where something is cut: (ground less what is cut) and what is added.
using GroundParts = std::vector<GroundPart>;

}  // namespace vpe::core
