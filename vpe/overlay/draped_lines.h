// Lines of features on the ground, as an image shows them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <optional>
#include <vector>

#include "vpe/overlay/features/ground_sight.h"
#include "vpe/overlay/ground_features.h"
#include "vpe/overlay/visible_terrain.h"

namespace vpe::overlay {

// Holds a part of a line that is seen, or hidden by ground, throughout.
struct DrapedRun {
  std::uint32_t feature = 0;
  bool is_hidden = false;
  std::vector<glm::dvec2> points_px;  // of the layer; at least two; across a seam they go on beyond the edge
  double distance_m = 0;              // of its middle from the camera
};

// Holds the share of its distance by which a place must lie behind the ground to be hidden.
inline constexpr double kHiddenLineShare = 5e-4;
// Lines are followed so far beside the image, for wide ones.
inline constexpr double kLineMargin_px = 8;

// Calls `draw` with each run of all lines in and beside an image, in the order of the features. Places on a line are followed
// until they are at most a pixel apart: between them the run is straight, so that it is off the line on the reference surface
// by no more than the ground rises between two pixels. Parts outside of their style's range of scales are left out.
void drape_lines(const GroundFeatures& features, const GroundSight& sight,
                 const std::function<void(const DrapedRun&)>& draw);
// Does the same for some of features.pieces(), [begin, end), which begin with a whole line.
void drape_lines(const GroundFeatures& features, std::size_t begin, std::size_t end, const GroundSight& sight,
                 const std::function<void(const DrapedRun&)>& draw);
// Does the same for an image with ranges (features/image_sight.h).
void drape_lines(const GroundFeatures& features, const VisibleTerrain& terrain,
                 const std::function<void(const DrapedRun&)>& draw);

// Holds where an image shows a place on the ground.
struct DrapedPlace {
  glm::dvec2 at_px;        // in the layer
  double distance_m = 0;   // from the camera
  bool is_hidden = false;  // by nearer ground
};
// Returns where the image shows a place; nullopt where it does not, as behind the camera.
std::optional<DrapedPlace> drape(const GroundSight& sight, glm::dvec2 place_deg);
std::optional<DrapedPlace> drape(const VisibleTerrain& terrain, glm::dvec2 place_deg);

}  // namespace vpe::overlay
