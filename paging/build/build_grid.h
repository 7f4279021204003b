// Posts, borders and meshes of one tile, shared by the steps of a build.
#pragma once

#include <array>
#include <span>

#include "paging/build/build_steps.h"

namespace paging {

// Returns the index of the post at position `along` of an edge, in rows of `side` posts.
std::size_t edge_post(lod::Edge edge, int along, int side);

// Returns the unit directions of a tile's posts, row by row.
std::vector<glm::dvec3> post_directions(const lod::TileKey& key, const lod::GridLines& lines);

// Rounds heights that have passed check_heights() to quanta.
std::vector<std::int32_t> to_quanta(const std::vector<double>& heights_m, double quantum_m);

// Selects the border posts that a mesh keeps, out of every step-th post of each edge.
lod::BorderPosts borders_of(const lod::Posts& posts, const lod::GridLines& lines,
                            const std::array<int, 4>& step, double tolerance_m, double radius_m);

// Adds the heights of the vertices, in quanta, to a mesh over `posts`.
PackedMesh pack_mesh(lod::TileMesh mesh, const lod::Posts& posts, double quantum_m);

// Holds a finest tile as its sources give it.
struct SampledLeaf {
  lod::Posts posts;                  // multiples of the quantum, borders constrained
  std::vector<std::int32_t> quanta;  // as stored, not constrained
  std::vector<bool> nodata;
  std::vector<int> source;  // of each post, -1: nodata; empty on a planet of one source
  bool any_nodata = false;
  int coarser_neighbour_mask = 0;  // NodeRow::coarser_neighbour_mask
  std::array<int, 4> border_step{1, 1, 1, 1};
  lod::GridLines lines;
  std::vector<glm::dvec3> directions;
};
SampledLeaf sample_leaf(const SampleInputs& sampling, const lod::TileKey& key);

// Rounds the heights of posts as sampled to quanta, and moves those on borders with coarser neighbours onto their edges.
// Sets quanta and border_step.
void round_and_constrain(const PlanetMeta& meta, SampledLeaf& leaf);

// Holds what is stored of a finest tile. Its meshes are missing: they are of mesh_leaf(), or the tile has its full grid
// alone.
struct LeafTile {
  Node node;
  TilePayload payload;
};
LeafTile pack_leaf(const PlanetMeta& meta, const SampledLeaf& leaf);

// Meshes and stores a finest tile that has been sampled.
Node mesh_leaf(const MeshInputs& meshing, const SampledLeaf& leaf, TileStore& store);

// Makes the mesh of an inner tile over its children's posts.
PackedMesh mesh_inner(const MeshInputs& meshing, const lod::Posts& posts);

}  // namespace paging
