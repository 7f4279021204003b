// Colour, opacity and normal of a place on a mesh.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <vector>

#include "objects/model/mesh.h"
#include "objects/model/texture_pyramid.h"

namespace objects {

// Returns the colour, 0 to 255, without light, and the opacity, 0 to 255, at weights (u, v) of a triangle's second and
// third corner: the product of the material's colour, the texture and the colours of vertices. Opacity is 255 for
// opaque materials, and 0 or 255 for masked ones. footprint_m is the side of what a pixel covers. Pure.
glm::vec4 surface_colour(const Mesh& mesh, const std::vector<TexturePyramid>& textures, std::uint32_t triangle,
                         const glm::vec2& weights, float footprint_m);

// Returns the unit normal of the triangle's plane, outward where its corners run counter-clockwise; (0, 0, 1) for a
// triangle without area. Pure.
glm::vec3 plane_normal(const Mesh& mesh, std::uint32_t triangle);

// Returns the unit normal of the surface at weights: interpolated where vertices have normals, else that of the plane.
// Pure.
glm::vec3 surface_normal(const Mesh& mesh, std::uint32_t triangle, const glm::vec2& weights);

}  // namespace objects
