// The relief that a click makes, and its outline on the ground.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "relief/spec.h"

namespace vpe::explore {

// Returns a relief of a kind at a place, about size_m from its middle to its end, with usual proportions. Sizes have two
// significant digits, within the limits of their keys. It has no problem_of() for any size.
relief::ReliefSpec usual_relief(relief::ReliefKind kind, mars::LonLat place, double size_m, double azimuth_deg);

// Returns the unit directions of the outline of a relief on a sphere, a closed line without its last corner: the rim's
// crest of a crater, the floor, crest or area of others. At least 3 and at most a few thousand.
std::vector<glm::dvec3> relief_outline(const relief::ReliefSpec& relief, double radius_m);

}  // namespace vpe::explore
