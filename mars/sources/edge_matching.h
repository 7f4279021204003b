// Bending what lies below an inset, so that it meets the inset at its rim and the inset keeps its heights.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mars/sources/adjusted.h"
#include "mars/sources/source.h"

namespace mars {

struct EdgeMatching {
  std::vector<glm::dvec3> boundary;  // unit directions, of at most kBendPoints places along the rim
  std::vector<double> off_m;         // inset less base there
  double cell_m = 0;                 // size of the cells that off_m are medians of
  double reach_m = 0;                // from the rim, where the bend has faded out
  double radius_m = 0;               // of the sphere that distances are measured on
  Cap cap;                           // no place outside of it is bent
  double rms_m = 0;                  // inset less base over the rim, before
  double largest_m = 0;              // the largest of off_m, by size
  std::int64_t posts = 0;            // of the rim that were looked at
};

inline constexpr std::size_t kEdgePoints = 512;

// Looks at the inset's posts within two posts of its rim, of at most about max_posts posts of it, and takes the
// median of inset - base in each of up to kBendPoints cells along the rim. The reach is the larger of eight
// posts of the base and fifty times the 90th percentile of |inset - base|, so that the bend adds slopes of some
// per cent. Nothing when no post of the rim has data below it. Throws SourceError on read errors.
std::optional<EdgeMatching> fit_edge_matching(const ElevationSource& inset, const ElevationSource& base,
                                              double radius_m, std::size_t max_posts = 4'000'000);

// Adds the bend to heights of the base: the mean of off_m with weights 1 / (distance^2 + cell_m^2)^2, faded out
// with the distance from the rim. Smooth along the rim, where it follows off_m but for what changes within a
// cell or two; that is left to the fade. (Shepard's weights, without the cell, meet every off_m and leave a rim
// of beads: tried 2026-11-21.)
Adjust matching_edges(const EdgeMatching& bend);
std::string to_string(const EdgeMatching& bend, const std::string& inset);

}  // namespace mars
