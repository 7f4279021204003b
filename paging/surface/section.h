// The section of S by the vertical plane of a great circle: straight pieces, one a facet.
#pragma once

#include <functional>
#include <glm/vec3.hpp>

#include "paging/surface/surface.h"

namespace paging {

// A straight line on one facet, from one of its borders (or the section's start) to the next. Body-fixed,
// metres from the planet's centre.
struct SectionPiece {
  glm::dvec3 begin_m{0, 0, 0};
  glm::dvec3 end_m{0, 0, 0};
};

// Of S itself; heights are not exaggerated. Visits every piece between two directions (any length but 0), in
// order; nothing for equal ones. Together they are S over the shorter great circle, without gaps but for
// rounding: ends of neighbouring pieces agree within kSectionError of the radius. Throws std::invalid_argument
// for opposite directions (within 1e-6 rad), through which every great circle goes, and PlanetError. Any
// thread.
inline constexpr double kSectionError = 4e-15;
void section(const Surface& surface, const glm::dvec3& from, const glm::dvec3& to,
             const std::function<void(const SectionPiece&)>& visit);

// How far it is along S, metres: the sum of the pieces' lengths, exact but for rounding (kSectionError of the
// radius a facet), and the lowest and highest of S on the way, above the sphere.
struct SectionFigures {
  double length_m = 0;
  double lowest_m = std::numeric_limits<double>::infinity();
  double highest_m = -std::numeric_limits<double>::infinity();
};
SectionFigures section_figures(const Surface& surface, const glm::dvec3& from, const glm::dvec3& to);

}  // namespace paging
