// Places with names, as seen from one eye: visible, or hidden by what.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "panorama/horizon/skyline.h"
#include "vpe/core/appearance/gazetteer.h"

namespace panorama {

// Of a feature only its centre, on the ground, is looked at: a crater's floor may be hidden and its rim not.
struct Landmark {
  vpe::core::Place feature;
  GroundPoint centre;  // its range and direction are those of the straight line from the camera
  std::optional<GroundPoint> hidden_by;  // the first ground on that line; nothing: the centre is visible
  std::string hidden_by_name;            // the smallest feature whose circle holds that ground; may be empty
};

// Radius of the ground in a direction (any length but 0), metres from the planet's centre.
using GroundRadius = std::function<double(const glm::dvec3& direction)>;

// The features whose centres are at most `within_m` away in a straight line, nearest first. Ground that a line
// meets nearer than kLandmarkReach of its length before the centre hides it; where the line only grazes the
// ground about the centre, rounding is less than that.
inline constexpr double kLandmarkReach = 1e-6;
std::vector<Landmark> landmarks(const SkylineCamera& camera, std::span<const vpe::core::Place> features,
                                double within_m, const GroundRadius& radius, const GroundRange& range,
                                vpe::base::ThreadPool& pool);

// The smallest feature whose circle holds a place; null when none does.
const vpe::core::Place* smallest_feature_around(std::span<const vpe::core::Place> features, mars::LonLat place,
                                                double radius_m);

// How far a camera at `camera_radius_m` can ever see ground between two radii, straight: past the sphere of the
// lowest to a top of the highest beyond its horizon.
double farthest_sight_m(double camera_radius_m, double lowest_radius_m, double highest_radius_m);

}  // namespace panorama
