// Prints what commands tell of models.
#pragma once

#include <glm/vec3.hpp>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "objects/model/mesh.h"
#include "objects/sticks/stick_model.h"

namespace vpe::app {

struct Common;

struct Extent {
  glm::dvec3 low_m{0, 0, 0};
  glm::dvec3 high_m{0, 0, 0};
};

// Returns the box around the vertices of a mesh that has some.
Extent extent_of(const objects::Mesh& mesh);

// Returns "1.2 m wide, 3.4 m long, 0.5 m high".
std::string extent_text(const Extent& extent);

// Returns a vector as an array of three numbers.
nlohmann::json vector_json(const glm::dvec3& v);

// Print the figures of a model of sticks: those of a file, and those of one that was written, which are left out where
// nothing but errors shall be printed.
void print_sticks(const objects::StickModel& sticks, const Common& common);
void print_written_sticks(const std::string& output, const objects::StickModel& sticks, const Common& common);

}  // namespace vpe::app
