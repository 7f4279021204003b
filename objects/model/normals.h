// Normals of meshes that have none, or lost them.
#pragma once

#include <glm/vec3.hpp>

#include "objects/model/mesh.h"

namespace objects {

// Gives the cosine of 40 degrees: edges that bend more stay sharp.
inline constexpr double kCosineOfSharp = 0.76604444311897804;

// Returns the cross product of a triangle's sides in double: twice its area long, 0 of a triangle without area.
// Pure.
glm::dvec3 area_normal(const Mesh& mesh, std::size_t triangle);

// Gives a mesh normals: at each corner the mean, weighted by area, of the triangles around the position that
// are connected to it by edges that are not sharp. Adds vertices where one position has several normals.
// Normals that the mesh has do not count. Deterministic.
void add_normals(Mesh& mesh);

}  // namespace objects
