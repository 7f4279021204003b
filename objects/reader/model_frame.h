// From the axes of a file to those of a model (objects/model/mesh.h): x right, y forward, z up.
#pragma once

#include <glm/mat4x4.hpp>

namespace objects {

// Returns the map from the coordinates of a file to metres of the model: a turn and a factor. Pure.
inline glm::dmat4 model_frame(bool has_y_up, double unit_m) {
  const double s = unit_m;
  if (!has_y_up) return glm::dmat4(s, 0, 0, 0, 0, s, 0, 0, 0, 0, s, 0, 0, 0, 0, 1);
  return glm::dmat4(-s, 0, 0, 0, 0, 0, s, 0, 0, s, 0, 0, 0, 0, 0, 1);
}

}  // namespace objects
