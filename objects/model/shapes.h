// Closed meshes of simple shapes, for tests and examples.
//
// Corners run counter-clockwise seen from outside. Normals are smooth up to 40 degrees (normals.h); without
// them each edge is run once each way. All have one material, and neither texture coordinates nor colours.
//
// Typical usage:
//   Mesh mesh;
//   append(mesh, make_cylinder(0.1F, 2, 24), glm::mat4(1), {120, 90, 60, 255});
//   append(mesh, make_cone(1, 3, 24), glm::translate(glm::mat4(1), {0, 0, 2}), {40, 110, 50, 255});
#pragma once

#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "objects/model/mesh.h"

namespace objects {

// Returns a box that stands on z = 0, the middle of its foot at the origin.
Mesh make_box(const glm::vec3& size_m);

// Returns an ellipsoid around the origin: `segments` around the z axis and half as many from pole to pole. At
// least 4. Its vertices lie on the ellipsoid.
Mesh make_ellipsoid(const glm::vec3& radii_m, int segments);

// Return a prism or pyramid that stands on z = 0, the middle of its foot at the origin. At least 3 segments.
// Its vertices lie on the cylinder or cone.
Mesh make_cylinder(float radius_m, float height_m, int segments);
Mesh make_cone(float radius_m, float height_m, int segments);

// Returns a ring around the z axis and the origin. At least 3 segments each way. Its vertices lie on the torus.
Mesh make_torus(float ring_radius_m, float tube_radius_m, int ring_segments, int tube_segments);

// Returns a block of rock, its largest side 1 m, that stands on z = 0: a ball that is squeezed, cut by planes
// and made rough, 20 * 4^subdivisions triangles. Subdivisions run from 0 to 8. The same on every machine.
Mesh make_rock(std::uint32_t seed, int subdivisions);

// Adds a mesh to another, which may be empty, with a material of one colour in place of its own. Texture
// coordinates and colours of the part do not count. Mirrored parts are turned right side out.
void append(Mesh& to, const Mesh& part, const glm::mat4& placed, Rgba colour);

}  // namespace objects
