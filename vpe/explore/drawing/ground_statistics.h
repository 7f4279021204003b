// Statistics of the reference surface within a polygon: heights, slopes, the plane that fits best, and volumes above and
// below a reference.
//
// Typical usage:
//   const auto statistics = ground_statistics(surface, directions_of(places), {.level_m = -2500}, stop);
//   if (statistics && statistics->plane) tell(statistics->plane->dip_deg);
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "mars/geodesy/sphere.h"
#include "paging/surface/surface.h"
#include "vpe/explore/drawing/plane_fit.h"

namespace vpe::explore {

struct GroundStatisticsOptions {
  // Most cells (of two facets) that are read. Smaller: faster; large polygons are measured on coarser posts.
  double most_cells = 2e7;
  // Elevation of a sphere, metres above the planet's, against which volumes are measured. Absent: none are.
  std::optional<double> level_m = std::nullopt;
  // Ground of another planet file of the same body and radius, against which volumes are measured. Null: none are.
  std::shared_ptr<const paging::Surface> other = nullptr;
  // Slopes whose steeper ground is counted, degrees.
  std::vector<double> slope_limits_deg = {};
  // Called now and then with the share that is done, 0 to 1, on the calling thread. May be empty.
  std::function<void(double share)> progress = {};
};

// Holds what lies between S and a reference, within the walls from the planet's centre through the outline.
struct GroundVolume {
  double above_m3 = 0;       // ground above the reference
  double below_m3 = 0;       // empty space between the reference and lower ground; not negative
  double area_above_m2 = 0;  // on the planet's sphere
  double area_below_m2 = 0;
};

struct GroundStatistics {
  mars::LonLat middle;        // of the outline's corners; dip and strike are against the level there
  double sphere_area_m2 = 0;  // on the planet's sphere
  double area_m2 = 0;         // of the facets
  double lowest_m = 0;        // of the corners of facets and of their cut parts, above the sphere
  double highest_m = 0;
  double mean_m = 0;  // over the area on the sphere

  // Describe slopes of facets against the vertical in their middles, over the area on the sphere; percentiles to 0.01 degrees.
  double mean_slope_deg = 0;
  double rms_slope_deg = 0;
  double median_slope_deg = 0;
  double slope_90_deg = 0;  // nine tenths of the ground are less steep
  double steepest_deg = 0;
  std::vector<double> steeper_share;  // of each of slope_limits_deg

  // In the level frame of `middle`, whose origin is there on the planet's sphere.
  std::optional<FittedPlane> plane;
  std::optional<GroundVolume> over_plane;
  // Against the surface that goes through the ground below the outline (rim_surface.h). Absent for rims that are
  // too narrow.
  std::optional<GroundVolume> over_rim;
  std::optional<GroundVolume> over_level;
  // Against the other ground, taken at the corners of this ground's facets and linear between them.
  std::optional<GroundVolume> over_other;

  double nodata_share = 0;                // of the area on the sphere
  std::optional<double> synthetic_share;  // of it, from sources that are made up; absent unless is_exact
  // Largest distance of the ground from its sources' own posts, in the finest tiles that were used. Absent where none was
  // compared there, and unless is_exact.
  std::optional<double> resampling_max_m;
  bool is_exact = true;  // false where the polygon has more than most_cells cells
  double spacing_m = 0;  // of the finest posts that were used
};

// Largest distance of a polygon's corners from their middle, radians.
inline constexpr double kLargestStatistics_rad = 0.5;

// Returns why there are no statistics of an outline of unit directions, or "": it has fewer than three corners, no area, or
// is too large. Pure.
std::string why_no_statistics(std::span<const glm::dvec3> polygon);

// Computes the statistics of S within a closed outline of unit directions that does not cross itself. Where is_exact,
// areas, the plane and volumes over it are integrals over facets without an error but rounding. Volumes over the rim, a
// level and another ground are those of references that are linear on each facet; where one crosses the ground, the line between above and
// below is straight on the facet. Returns nullopt if it was asked to stop. Throws std::invalid_argument with
// why_no_statistics(), for another ground of another radius, and paging::PlanetError. Any thread may call it.
std::optional<GroundStatistics> ground_statistics(const paging::Surface& surface,
                                                  std::span<const glm::dvec3> polygon,
                                                  const GroundStatisticsOptions& options = {},
                                                  const std::stop_token& stop = {});

}  // namespace vpe::explore
