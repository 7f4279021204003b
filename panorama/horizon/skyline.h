// The skyline: the boundary between ground and sky as seen from a viewpoint.
//
// Ground has one radius for each direction from the planet's centre. So of two rays in one vertical plane from
// a viewpoint above it the lower meets ground when the higher does, and no farther along the ground. At each
// azimuth there is therefore one elevation up to which rays meet ground and above which none does: the skyline.
//
// Azimuth is clockwise from north (at a pole: from the meridian of the viewpoint's longitude), elevation up
// from the horizontal at the viewpoint, both for straight lines in vacuum. All functions may be called from any
// thread.
//
// Typical usage:
//   const Viewpoint viewpoint = viewpoint_at(place, alt_m, radius_m);
//   const GroundRange range = [&](const glm::dvec3& ray) { return surface.cast(viewpoint.position_m, ray); };
//   const std::vector<GroundPoint> points = skyline(viewpoint, azimuths_deg, range, pool);
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "mars/geodesy/sphere.h"
#include "panorama/projection.h"
#include "panorama/viewpoint.h"
#include "vpe/base/parallel.h"

namespace panorama {

// Returns the direction as a unit vector in the body-fixed frame.
glm::dvec3 ray_of(const Viewpoint& viewpoint, const Direction& direction);

// Returns the distance from the viewpoint along a unit direction to the ground, in metres; infinity where there
// is none. Called from several threads at once.
using GroundRange = std::function<double(const glm::dvec3& ray)>;

// Describes a point of the ground, and the direction in which it is seen.
struct GroundPoint {
  Direction direction;
  double range_m = 0;
  mars::LonLat place;
  double elevation_m = 0;  // above the sphere
};
// Returns the point at a distance in a direction.
GroundPoint ground_point(const Viewpoint& viewpoint, const Direction& direction, double range_m);

// Describes the elevations where the search for the skyline begins. Any values are correct; wrong ones cost a
// few more casts.
struct ElevationBracket {
  double low_deg = -90;
  double high_deg = 90;
};

// Returns the highest ground at an azimuth: the ray at its elevation meets ground, and one kSkyline_deg higher
// does not. Exact for the ground that `range` describes. Near a smooth horizon at distance d the range is too
// short by at most sqrt(2 R d kSkyline_deg) (angle in radians): 0.02 % at 2 m above Mars. Throws
// std::invalid_argument where no ray meets ground, even straight down.
inline constexpr double kSkyline_deg = 1e-9;
GroundPoint skyline_at(const Viewpoint& viewpoint, double azimuth_deg, const GroundRange& range,
                       const ElevationBracket& first = {});

// Returns the highest ground at many azimuths. `first` is empty or has one bracket for each azimuth.
std::vector<GroundPoint> skyline(const Viewpoint& viewpoint, std::span<const double> azimuths_deg,
                                 const GroundRange& range, vpe::base::ThreadPool& pool,
                                 std::span<const ElevationBracket> first = {});

// Holds ranges over a round image, row by row from the top, in metres; infinity for the sky.
struct RangeImage {
  PanoramaMap map;
  std::span<const float> range_m;
};

// Returns brackets from one row below to one row above the highest ground of the column next to each azimuth.
std::vector<ElevationBracket> first_brackets(const RangeImage& image, std::span<const double> azimuths_deg);

// Returns the farthest ground seen. No pixel of the image, at any elevation, and no given point of the skyline
// is farther (except for the image's rounding). About the farthest ones the skyline is searched in steps of 1 /
// kFarthestSteps of a column. Ground seen through a narrower opening may be missed. Throws
// std::invalid_argument where no ground is seen.
inline constexpr int kFarthestSteps = 32;
GroundPoint farthest_ground(const Viewpoint& viewpoint, const RangeImage& image,
                            std::span<const GroundPoint> skyline, const GroundRange& range,
                            vpe::base::ThreadPool& pool);

}  // namespace panorama
