// Objects that are part of the ground, as they stand on a planet.
//
// Typical usage:
//   request.ground_parts = ground_parts(parts, planet_radius_m);
#pragma once

#include <memory>
#include <vector>

#include "objects/draw/object_spans.h"
#include "objects/files/scene_file.h"
#include "objects/scene/scene.h"
#include "vpe/core/ground_parts.h"

namespace vpe::app {

// Holds one of them.
struct PlacedPart {
  std::shared_ptr<const objects::Scene> scene;  // of this instance alone
  objects::GroundRole role;                     // add or cut
};
using PlacedParts = std::vector<PlacedPart>;

// Returns the stretches of the vertical of a unit direction in a part: t is the distance from the planet's centre
// (objects/draw/object_spans.h). Any thread may call it.
std::vector<objects::ObjectSpan> part_spans(const PlacedPart& part, const glm::dvec3& up);

// Returns the parts as images of the ground take them. Their voxels have the role's side, or a 128th of the diameter of their
// balls. Null if there is none.
std::shared_ptr<const core::GroundParts> ground_parts(const PlacedParts& parts, double planet_radius_m);

}  // namespace vpe::app
