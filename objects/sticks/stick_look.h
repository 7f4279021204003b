// What a model of sticks looks like from far away.
#pragma once

#include <glm/vec3.hpp>

#include "objects/sticks/stick_model.h"

namespace objects {

struct StickLook {
  glm::dvec3 area_m2{0, 0, 0};  // of the silhouettes along x, y and z
  glm::dvec3 colour{0, 0, 0};   // mean of all voxels, 0 to 255
  double opacity = 1;           // mean along the vertical of the columns that hold something
};

// Returns the look of a level. Pure.
StickLook look_of(const StickModel::Level& level);

}  // namespace objects
