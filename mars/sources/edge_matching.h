// Edge matching: warps the base around an inset so that it meets the inset at its data boundary. The inset
// keeps its heights.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mars/sources/adjusted.h"
#include "mars/sources/source.h"

namespace mars {

// Largest number of places along the boundary at which the difference is kept.
inline constexpr std::size_t kEdgePoints = 512;

struct EdgeMatching {
  std::vector<glm::dvec3> boundary;  // unit directions of at most kEdgePoints places along the boundary
  std::vector<double> off_m;         // inset minus base there
  double cell_m = 0;                 // size of the cells whose medians are off_m
  double reach_m = 0;                // distance from the boundary at which the correction has faded out
  double radius_m = 0;               // of the sphere on which distances are measured
  Cap cap;                           // no place outside of it is changed
  double rms_m = 0;                  // inset minus base over the boundary, before the correction
  double largest_m = 0;              // the largest of off_m by magnitude, with its sign
  std::int64_t posts = 0;            // number of boundary posts used
};

// Compares the inset's posts within two posts of its data boundary with the base, looking at most at about
// max_posts posts of the inset. Takes the median of inset - base in each of up to kEdgePoints cells along the
// boundary. The reach is the larger of eight posts of the base and fifty times the 90th percentile of |inset -
// base|, so that the correction adds slopes of a few per cent. Returns nullopt if no boundary post has data
// below it. Throws SourceError on read errors.
std::optional<EdgeMatching> fit_edge_matching(const ElevationSource& inset, const ElevationSource& base,
                                              double radius_m, std::size_t max_posts = 4'000'000);

// Returns the adjustment of the base: it adds the mean of off_m with weights 1 / (distance^2 + cell_m^2)^2,
// faded out with the distance from the boundary. It is smooth along the boundary, where it follows off_m except
// for what changes within a cell or two; the fade of the stack covers that. (Shepard's weights without cell_m
// meet every off_m exactly, but leave a string of bumps along the boundary.)
HeightAdjustment edge_adjustment(const EdgeMatching& matching);

// Returns the treatment that planet files store. The text identifies the planet: it must not change.
std::string to_string(const EdgeMatching& matching, const std::string& inset);

}  // namespace mars
