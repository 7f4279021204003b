// Posts, borders and meshes of one tile: what the steps of a build share.
#pragma once

#include <array>
#include <span>

#include "paging/build/build_steps.h"

namespace paging {

// Index of the post `along` an edge in rows of `side` posts.
std::size_t edge_post(lod::Edge edge, int along, int side);

// Unit directions of a tile's posts, in their order.
std::vector<glm::dvec3> post_directions(const lod::TileKey& key, const lod::GridLines& lines);

// Throws PlanetError for a height that no 32-bit number of quanta is, naming its place when directions are given.
std::vector<std::int32_t> to_quanta(const std::vector<double>& heights_m, double quantum_m,
                                    std::span<const glm::dvec3> directions = {});

// Border posts that a mesh keeps, out of every step-th of each edge.
lod::BorderPosts borders_of(const lod::Posts& posts, const lod::GridLines& lines,
                            const std::array<int, 4>& step, double tolerance_m, double radius_m);

PackedMesh pack_mesh(lod::TileMesh mesh, const lod::Posts& posts, double quantum_m);

// A finest tile as its sources give it.
struct SampledLeaf {
  lod::Posts posts;                  // multiples of the quantum, borders constrained
  std::vector<std::int32_t> quanta;  // as stored, not constrained
  std::vector<bool> nodata;
  bool any_nodata = false;
  int coarser_neighbour_mask = 0;  // NodeRow::steps
  std::array<int, 4> border_step{1, 1, 1, 1};
  lod::GridLines lines;
  std::vector<glm::dvec3> directions;
};
SampledLeaf sample_leaf(const BuildContext& context, const lod::TileKey& key);

// The mesh of an inner tile over `posts`, its children's.
PackedMesh mesh_inner(const BuildContext& context, const lod::Posts& posts);

}  // namespace paging
