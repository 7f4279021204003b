// Vertices and indices of a drawn tile, relative to the tile's centre. Pure; no OpenGL.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "lod/mesh/mesh.h"
#include "vpe/gl/mesh_pieces.h"

namespace vpe::gl {

// Place of a vertex relative to TileGeometry::centre_m, metres, body-fixed axes. Every appearance needs it.
using VertexPosition = glm::vec3;
static_assert(sizeof(VertexPosition) == 12);

// Place of a vertex in its tile: from 0 to 65535 over the chart rectangle, even in u and v. Textures need it.
struct VertexChart {
  std::uint16_t s = 0;
  std::uint16_t t = 0;
};
static_assert(sizeof(VertexChart) == 4);

// Unit vector, body-fixed: the normal of a vertex, for light of vertices alone. The octahedron |x| + |y| + |z| = 1 with its
// lower half folded over the upper one, in steps of 1/32767.
struct VertexNormal {
  std::int16_t x = 0;
  std::int16_t y = 0;
  bool operator==(const VertexNormal&) const = default;
};
static_assert(sizeof(VertexNormal) == 4);

// Converts a unit vector to the stored form, and back as the vertex shader does: off by less than 1e-4 radians.
VertexNormal pack_normal(const glm::vec3& unit);
glm::vec3 unpack_normal(const VertexNormal& normal);

// Ranges of a tile's parts in its indices.
struct IndexRanges {
  std::uint32_t surface = 0;  // triangles of the mesh: [0, surface)
  // Skirt of edge e: [skirts[e], skirts[e + 1]). Four indices a piece: two vertices of the border, their feet.
  std::array<std::uint32_t, 5> skirts{};
  std::uint32_t border_end = 0;  // lines of the border: [skirts[4], border_end)
};

struct TileGeometry {
  glm::dvec3 centre_m{0, 0, 0};
  std::vector<VertexPosition> positions_m;  // of the mesh, then of the feet of the skirts
  std::vector<VertexChart> charts;          // as many, or none
  std::vector<VertexNormal> normals;        // as many, or none
  std::uint32_t surface_vertices = 0;       // number of vertices of the mesh
  std::vector<std::uint32_t> indices;
  IndexRanges ranges;
  PieceFrame frame;               // of the pieces; its origin is centre_m
  std::vector<MeshPiece> pieces;  // of the surface, in the order of its triangles
  double quantisation_m = 0;  // no vertex is farther than this from its exact place, nor 2^-24 of its position
  double longest_edge_m = 0;  // longest edge of a triangle of the mesh
  std::size_t bytes() const {
    return positions_m.capacity() * sizeof(VertexPosition) + charts.capacity() * sizeof(VertexChart) +
           normals.capacity() * sizeof(VertexNormal) + indices.capacity() * 4 +
           pieces.capacity() * sizeof(MeshPiece);
  }
};

// Origin of positions at the tile's centre.
inline constexpr int kTileCentre = -1;

struct GeometryOptions {
  double exaggeration = 1;
  // kTileCentre, or j * (intervals + 1) + i: the vertex nearest to post i, j of the finest grid. For cameras so
  // near that rounding relative to the centre would be visible.
  int origin = kTileCentre;
  bool charts = true;  // false: no chart coordinates, which saves 4 bytes a vertex
  // One per vertex of the mesh, unit; none: no normals, which saves 4 bytes a vertex.
  std::span<const glm::vec3> normals = {};
};

// Makes the vertices and indices of a tile. height_m: one per vertex, above the sphere. The feet of the skirts
// stand at the border vertices themselves; the vertex shader lowers them by the depth that the frame needs.
TileGeometry make_geometry(const lod::TileKey& key, const lod::TileMesh& mesh, std::span<const double> height_m,
                           double radius_m, const GeometryOptions& options);

// Returns, for each line of a mesh's border in the order of TileGeometry, the triangle that it belongs to,
// counted from 0.
std::vector<std::uint32_t> border_triangles(const lod::TileMesh& mesh);

}  // namespace vpe::gl
