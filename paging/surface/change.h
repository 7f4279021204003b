// Measures of what has changed between two planets: areas, differences of height, volumes.
//
// The difference is later - earlier in one direction, of the reference surfaces, in metres along the vertical. It is taken at
// the posts of the finest tiles that either planet has at a place, and is linear over their triangles (posts.h). Integrals
// over a triangle are in closed form, also where it has parts above and below zero. So the figures do not depend on levels
// of detail.
//
// Typical usage:
//   const Surface earlier(PlanetFile::open("a.vpe"), budget), later(PlanetFile::open("b.vpe"), budget);
//   const ChangeStatistics change = measure_change(earlier, later, {}, {}, pool);
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "mars/geodesy/sphere.h"
#include "paging/surface/surface.h"
#include "vpe/base/parallel.h"

namespace paging {

// Describes the ground that counts. Both functions are called from several threads at once; an empty one counts everything.
struct ChangeRegion {
  // Returns false if nothing over a tile counts.
  std::function<bool(const lod::TileKey&)> may_hold;
  // Returns whether a triangle of posts counts, by the unit direction to its middle.
  std::function<bool(const glm::dvec3&)> holds;
};

struct ChangeOptions {
  // Ground has changed where the difference is larger than this, in either direction. >= 0.
  double threshold_m = 0;
  // Is called on the caller's thread with the share of the work that is done. May throw, which ends the work.
  std::function<void(double)> tell;
};

struct ChangeExtreme {
  double difference_m = 0;
  mars::LonLat place;
};

// Holds the change over a region. Areas are on the sphere of the planets' radius. Means, the median and the root mean square
// weigh differences by area; without any area with data they are nullopt.
struct ChangeStatistics {
  double area_m2 = 0;         // with data in both
  double nodata_area_m2 = 0;  // at nodata of either; left out of all else
  double changed_area_m2 = 0;
  std::optional<double> mean_m;
  std::optional<double> median_m;  // within 1e-4 of itself
  std::optional<double> rms_m;
  std::optional<ChangeExtreme> least;  // most negative
  std::optional<ChangeExtreme> most;
  // Volumes between both surfaces, (r_later^3 - r_earlier^3) / 3 over the solid angle: where ground has risen, and where it
  // has sunk, both >= 0. The threshold has no part in them.
  double gained_m3 = 0;
  double lost_m3 = 0;
  std::int64_t triangles = 0;  // of posts that count, those at nodata included
};

// Measures the change from one planet to the other. The result does not depend on the pool, and swapping the planets negates
// differences and swaps volumes to the bit. Throws PlanetError for planets that are not comparable (require_comparable())
// and for unreadable tiles, std::invalid_argument for a threshold that is negative or no number.
ChangeStatistics measure_change(const Surface& earlier, const Surface& later, const ChangeRegion& region,
                                const ChangeOptions& options, vpe::base::ThreadPool& pool);

// Returns the share of a triangle over which a linear function is larger than `above`, from its values at the corners. Pure.
double share_above(double a, double b, double c, double above);

// Returns the mean over a triangle of the positive part of a linear function, from its values at the corners. Pure.
double mean_of_positive_part(double a, double b, double c);

}  // namespace paging
