// Steps of a build, one tile each. Used by the builder, by merging and by patches in memory. Any number of threads may run a
// step for different tiles at once.
//
// Each step takes only what it needs: SampleInputs where sources are sampled, MeshInputs where posts are
// meshed, StoredTiles where tiles that an earlier step stored are read back.
#pragma once

#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "lod/mesh/mesh.h"
#include "paging/build/builder.h"
#include "paging/plan/build_plan.h"
#include "paging/planet/tile_store.h"
#include "vpe/base/object_pool.h"

namespace paging {

// Holds what a build keeps in memory of a tile.
struct Node {
  double min_m = 0;  // of the finest posts
  double max_m = 0;
  double lowest_m = 0;  // of the reference surface: facets lie below their posts by up to the sagitta
  double slope = 0;     // lod::steepest_slope
  bool inner = false;
  int coarser_neighbour_mask = 0;  // NodeRow::coarser_neighbour_mask
  std::set<int> sources;
  std::vector<lod::MeshVariant> variants;
  lod::ErrorTerms posts_terms;  // of an inner tile, as lod::TileInfo
};
// Ordered by key, so that nothing depends on hashing. Read-only during a step.
using Nodes = std::map<lod::TileKey, Node>;

// Holds the errors of an inner tile, measured against the reference surface.
struct InnerTerms {
  lod::ErrorTerms mesh;
  lod::ErrorTerms posts;
  void include(const InnerTerms& other) {
    mesh.include(other.mesh);
    posts.include(other.posts);
  }
};

// Holds an inner tile that lies above several shards. Each of these shards measures it, merging stores it.
struct SharedAncestor {
  PackedMesh mesh;
  lod::Posts posts;
};
using SharedAncestors = std::map<lod::TileKey, SharedAncestor>;

// Meshers keep scratch memory; one thread at a time uses each.
using MesherPool = vpe::base::ObjectPool<lod::Mesher>;

struct SampleInputs {
  const PlanetMeta& meta;
  const BuildPlan& plan;
  const mars::ElevationSource& elevation;
};

struct MeshInputs {
  const PlanetMeta& meta;
  const BuildPlan& plan;
  double mesh_ratio;  // BuildOptions::mesh_ratio
  MesherPool& meshers;
};

struct StoredTiles {
  const PlanetMeta& meta;
  TileStore& store;
  const Nodes& nodes;  // of all tiles that are read
};

// Samples, meshes and stores a finest tile.
Node build_leaf(const SampleInputs& sampling, const MeshInputs& meshing, TileStore& store,
                const lod::TileKey& key);

// Takes an inner tile's posts from its children, which must be stored, and meshes and stores it. Its error
// terms are 0 until they have been measured.
Node build_inner(const MeshInputs& meshing, const StoredTiles& stored, const lod::TileKey& key);

// Makes the mesh and posts that build_inner() makes, from the sources instead of the children: for a tile that
// lies above more than one shard.
SharedAncestor sample_shared_ancestor(const SampleInputs& sampling, const MeshInputs& meshing,
                                      const lod::TileKey& key);

// Return a tile's Node from its stored row instead of building the tile. The result equals what building
// returns. An inner tile's children must be in `nodes`.
Node recall_leaf(const PlanetMeta& meta, const NodeRow& row);
Node recall_inner(const Nodes& nodes, const NodeRow& row);
// Does the same for an inner tile whose errors are final.
Node recall_measured(const Nodes& nodes, const NodeRow& row);

// Computes the largest errors of every ancestor's mesh and posts over some finest tiles, except for ancestors among
// `kept`, whose errors are known. Ancestors are taken from `shared_ancestors`, else as stored.
std::map<lod::TileKey, InnerTerms> measure_chunk(const StoredTiles& stored,
                                                 const SharedAncestors& shared_ancestors,
                                                 const std::set<lod::TileKey>& kept,
                                                 std::span<const lod::TileKey> leaves);

// Converts the result of measure_chunk() to bytes and back; unpack_terms() throws CodecError.
Bytes pack_terms(const std::map<lod::TileKey, InnerTerms>& terms);
std::map<lod::TileKey, InnerTerms> unpack_terms(std::span<const std::uint8_t> packed);

// Makes errors nest: afterwards none of these inner tiles, deepest first, states a smaller error than any tile
// below it.
void nest_errors(Nodes& nodes, std::span<const lod::TileKey> inner);

// Samples an image tile and returns it as JPEG. Nodata texels are grey.
Bytes make_image_tile(const mars::ImageSource& image, const lod::TileKey& key, double radius_m, int quality);
// Samples a tile of an image layer (mars::ImageLayerSource) and packs it (layer_tile.h).
Bytes make_layer_tile(const mars::ImageSource& layer, const lod::TileKey& key, double radius_m, int quality);

// Convert a Node to its row and back, except lowest_m.
NodeRow to_row(const lod::TileKey& key, const Node& node);
Node node_of(const NodeRow& row);

// Reads a stored tile's posts with constrained borders: the finest ones of a leaf, its own of an inner tile.
lod::Posts read_posts(const StoredTiles& stored, const lod::TileKey& key);
// Returns the same from the tile's heights in quanta, as they are stored.
lod::Posts posts_of_quanta(const StoredTiles& stored, const lod::TileKey& key,
                           std::span<const std::int32_t> quanta);
// Returns the heights of a stored mesh's vertices in metres.
std::vector<double> vertex_heights(const PackedMesh& mesh, double quantum_m);

// Returns the radial distance within which the mesh of a tile of this level keeps to its posts.
double mesh_tolerance_m(const MeshInputs& meshing, int level);

}  // namespace paging
