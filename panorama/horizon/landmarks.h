// Named features as seen from a viewpoint: visible, or hidden by nearer ground.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "panorama/horizon/skyline.h"
#include "vpe/core/appearance/gazetteer.h"

namespace panorama {

// Describes a feature by its centre on the ground, and by what else of it is visible if that is hidden: a crater's
// floor may be hidden while its rim is visible.
struct Landmark {
  vpe::core::Place feature;
  GroundPoint centre;  // range and direction are those of the straight line from the viewpoint
  std::optional<GroundPoint> hidden_by;  // the first ground on that line; absent: the centre is visible
  std::string hidden_by_name;            // the smallest feature whose circle holds that ground; may be empty
  // Extent::kPoints: the highest visible one of core::points_within(), if the centre is hidden or too far away.
  std::optional<GroundPoint> seen_at;
};

// Returns the radius of the ground in a direction (any length but 0), in metres from the planet's centre.
using GroundRadius = std::function<double(const glm::dvec3& direction)>;

enum class Extent : std::uint8_t { kCentre, kPoints };

// Returns the features whose centres, or with Extent::kPoints visible points, are at most `within_m` away in a straight line, nearest first. A centre is
// hidden by ground that its line meets nearer than it by more than kLandmarkReach of the line's length; where
// the line only grazes the ground about the centre, rounding is less than that.
inline constexpr double kLandmarkReach = 1e-6;
std::vector<Landmark> landmarks(const Viewpoint& viewpoint, std::span<const vpe::core::Place> features,
                                double within_m, const GroundRadius& radius, const GroundRange& range,
                                vpe::base::ThreadPool& pool, Extent extent = Extent::kCentre);

// Returns the smallest feature whose circle holds a place, or null.
const vpe::core::Place* smallest_feature_around(std::span<const vpe::core::Place> features, mars::LonLat place,
                                                double radius_m);

// Returns the largest distance at which ground between two radii can be seen along a straight line from
// `camera_radius_m`: past the sphere of the lowest radius to a summit of the highest beyond its horizon.
double farthest_sight_m(double camera_radius_m, double lowest_radius_m, double highest_radius_m);

}  // namespace panorama
