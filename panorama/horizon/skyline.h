// The skyline: where ground ends and sky begins, as seen from one eye.
//
// Ground has one radius for each direction from the planet's centre, so of two rays of one vertical plane from
// a camera above it the lower meets ground when the higher does, and no farther along the ground. At each azimuth
// there is therefore one elevation up to which rays meet ground and above which none does: the skyline.
//
// Azimuth is clockwise from north (at a pole: from the meridian of the camera's longitude), elevation up from the
// horizontal at the camera, both straight lines in vacuum. All functions may be called from any thread.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "mars/geodesy/sphere.h"
#include "panorama/projection.h"
#include "vpe/base/parallel.h"

namespace panorama {

struct SkylineCamera {
  glm::dvec3 position_m;  // body-fixed, from the planet's centre; above the ground
  mars::LocalFrame frame;
  double radius_m = 0;  // of the sphere that elevations are counted from
};
SkylineCamera skyline_camera(mars::LonLat place, double alt_m, double radius_m);

// Unit, body-fixed.
glm::dvec3 ray_of(const SkylineCamera& camera, const Direction& direction);

// Distance from the camera along a unit direction to the ground, metres; infinity where there is none. Called from
// several threads at once.
using GroundRange = std::function<double(const glm::dvec3& ray)>;

// A point of the ground, and where it is seen.
struct GroundPoint {
  Direction direction;
  double range_m = 0;
  mars::LonLat place;
  double elevation_m = 0;  // above the sphere
};
GroundPoint ground_point(const SkylineCamera& camera, const Direction& direction, double range_m);

// Where the skyline is looked for first. Any values do: wrong ones cost a few casts more.
struct ElevationBracket {
  double low_deg = -90;
  double high_deg = 90;
};

// The highest ground at an azimuth: the ray at its elevation meets ground, and one kSkyline_deg higher does
// not. Exact for ground as `range` has it. Near a smooth horizon at distance d the range is then short by at
// most sqrt(2 R d kSkyline_deg) (angle in radians): 0.02 % at 2 m above Mars.
// Throws std::invalid_argument where no ray from straight down on meets ground.
inline constexpr double kSkyline_deg = 1e-9;
GroundPoint skyline_at(const SkylineCamera& camera, double azimuth_deg, const GroundRange& range,
                       const ElevationBracket& first = {});

// The same at many azimuths; `first` is empty or has one for each.
std::vector<GroundPoint> skyline(const SkylineCamera& camera, std::span<const double> azimuths_deg,
                                 const GroundRange& range, vpe::base::ThreadPool& pool,
                                 std::span<const ElevationBracket> first = {});

// Ranges over a round image, row by row from the top, metres, infinity for the sky.
struct RangeImage {
  PanoramaMap map;
  std::span<const float> range_m;
};

// A row above and a row below the highest ground of the column next to each azimuth.
std::vector<ElevationBracket> first_brackets(const RangeImage& image, std::span<const double> azimuths_deg);

// The farthest ground seen: no pixel of the image, of whatever elevation, and no given point of the skyline
// is farther (but for the image's rounding), and about the farthest ones the skyline is searched in steps of
// a kFarthestSteps-th of a column. Ground seen through a gap narrower than that may be missed. Throws
// std::invalid_argument where nothing is seen.
inline constexpr int kFarthestSteps = 32;
GroundPoint farthest_ground(const SkylineCamera& camera, const RangeImage& image,
                            std::span<const GroundPoint> skyline, const GroundRange& range,
                            vpe::base::ThreadPool& pool);

}  // namespace panorama
