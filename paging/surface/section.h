// Sections of the reference surface by the vertical plane of a great circle: one straight piece for each facet.
//
// Typical usage:
//   section(surface, from, to, [&](const SectionPiece& piece) { draw(piece.begin_m, piece.end_m); });
#pragma once

#include <functional>
#include <glm/vec3.hpp>

#include "paging/surface/surface.h"

namespace paging {

// Two places whose angle is within this of a half circle have no great circle of their own.
inline constexpr double kNearlyOpposite_rad = 1e-6;

// Holds a straight line on one facet, from one of its borders (or the section's start) to the next. Body-fixed,
// metres from the planet's centre.
struct SectionPiece {
  glm::dvec3 begin_m{0, 0, 0};
  glm::dvec3 end_m{0, 0, 0};
};

// Visits every piece between two directions (any length but 0) in order; none for equal directions. Heights
// are not exaggerated. Together the pieces are the reference surface over the shorter great circle, joined up
// to rounding: ends of neighbouring pieces agree within kSectionError of the radius. Throws PlanetError, and
// std::invalid_argument for opposite directions (within 1e-6 rad), which every great circle joins. Any thread
// may call it.
inline constexpr double kSectionError = 4e-15;
void section(const Surface& surface, const glm::dvec3& from, const glm::dvec3& to,
             const std::function<void(const SectionPiece&)>& visit);

// Summarizes a section: the sum of the pieces' lengths, exact but for rounding (kSectionError of the radius
// for each facet), and the lowest and highest point above the sphere.
struct SectionFigures {
  double length_m = 0;
  double lowest_m = std::numeric_limits<double>::infinity();
  double highest_m = -std::numeric_limits<double>::infinity();
};
SectionFigures section_figures(const Surface& surface, const glm::dvec3& from, const glm::dvec3& to);

}  // namespace paging
