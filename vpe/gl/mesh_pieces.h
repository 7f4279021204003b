// Pieces of a tile's mesh: triangles near each other, which are drawn or left out together. Pure; no OpenGL.
//
// Typical usage:
//   order_by_pieces(mesh);                                  // before anything is made of its triangles
//   const std::vector<MeshPiece> pieces = mesh_pieces(mesh, positions_m, frame);
//   seen_ranges(pieces, frame, {camera, frustum, horizon}, ranges);
#pragma once

#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "cull/frustum.h"
#include "cull/horizon.h"
#include "lod/mesh/mesh.h"

namespace vpe::gl {

// Indices [begin, end) of a mesh's triangles.
struct IndexRange {
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
  bool operator==(const IndexRange&) const = default;
};

// Triangles and a box around them, along the axes of their mesh's PieceFrame, relative to its origin.
struct MeshPiece {
  IndexRange range;
  glm::vec3 low_m{0, 0, 0};
  glm::vec3 high_m{0, 0, 0};
};

// The axes of the boxes: columns are unit vectors, body-fixed, the last one outwards.
struct PieceFrame {
  glm::dvec3 origin_m{0, 0, 0};
  glm::dmat3 axes{1.0};
};
PieceFrame piece_frame(const glm::dvec3& origin_m);

// Returns into how many squares a mesh of so many triangles is cut along each side: 1 to 8, a power of two.
int piece_rows(std::size_t triangles);

// Sorts the triangles of a mesh by the square of the tile that their middle lies in. Keeps their order within a square.
void order_by_pieces(lod::TileMesh& mesh);

// Returns the runs of triangles of one square, with the boxes around them. Of a mesh that order_by_pieces() has sorted
// there is at most one for each square. positions_m: of the mesh's vertices, relative to the frame's origin.
std::vector<MeshPiece> mesh_pieces(const lod::TileMesh& mesh, std::span<const glm::vec3> positions_m,
                                   const PieceFrame& frame);

// Describes what an image can show.
struct PieceView {
  cull::Frustum frustum;
  cull::Horizon horizon;
};

// Appends the ranges of the pieces that the image may show, joined where one ends as the next begins. Conservative: a
// triangle of which OpenGL draws a pixel is in one of them, also with its corners as far from their places as float
// storage and the vertex stage put them.
void seen_ranges(std::span<const MeshPiece> pieces, const PieceFrame& frame, const PieceView& view,
                 std::vector<IndexRange>& ranges);

}  // namespace vpe::gl
