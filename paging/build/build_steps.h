// The steps of a build, one tile each. Used by the builder alone; any number of threads may run them for
// different tiles at once.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <span>
#include <unordered_map>

#include "paging/build/build_plan.h"
#include "paging/build/builder.h"
#include "paging/build/planet_writer.h"

namespace paging {

// What a build keeps in memory of a tile.
struct Node {
  double min_m = 0;  // of the finest posts
  double max_m = 0;
  double lowest_m = 0;  // of S: facets sag below their posts
  double slope = 0;     // lod::steepest_slope
  bool inner = false;
  int coarser_neighbour_mask = 0;  // NodeRow::steps
  std::set<int> sources;
  std::vector<lod::MeshVariant> variants;
  lod::ErrorTerms posts_terms;  // of an inner tile, as lod::TileInfo
};

// What is measured of an inner tile against S.
struct InnerTerms {
  lod::ErrorTerms mesh;
  lod::ErrorTerms posts;
  void include(const InnerTerms& other) {
    mesh.include(other.mesh);
    posts.include(other.posts);
  }
};

// Of an inner tile that other builds store.
struct SharedAncestor {
  PackedMesh mesh;
  lod::Posts posts;
};

// Meshers keep scratch memory; each is used by one thread at a time.
class MesherPool {
 public:
  class Lease {
   public:
    Lease(MesherPool& pool, std::unique_ptr<lod::Mesher> mesher) : pool_(&pool), mesher_(std::move(mesher)) {}
    ~Lease() { pool_->give_back(std::move(mesher_)); }
    Lease(const Lease&) = delete;
    Lease& operator=(const Lease&) = delete;
    lod::Mesher* operator->() const { return mesher_.get(); }

   private:
    MesherPool* pool_;
    std::unique_ptr<lod::Mesher> mesher_;
  };
  Lease borrow() {
    const std::lock_guard lock(mutex_);
    if (idle_.empty()) return {*this, std::make_unique<lod::Mesher>()};
    std::unique_ptr<lod::Mesher> mesher = std::move(idle_.back());
    idle_.pop_back();
    return {*this, std::move(mesher)};
  }

 private:
  void give_back(std::unique_ptr<lod::Mesher> mesher) {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(mesher));
  }
  std::mutex mutex_;
  std::vector<std::unique_ptr<lod::Mesher>> idle_;
};

struct BuildContext {
  const BuildOptions& options;
  const PlanetMeta& meta;
  const BuildPlan& plan;
  const mars::ElevationSource* elevation;  // null where nothing is sampled any more
  PlanetWriter& writer;
  MesherPool& meshers;
  std::map<lod::TileKey, SharedAncestor> above;  // tiles that this build measures, but others store
  std::map<lod::TileKey, Node> nodes;  // ordered, so that nothing depends on hashing; read-only during a step
};

// Samples, meshes and stores a finest tile.
Node build_leaf(const BuildContext& context, const lod::TileKey& key);

// Takes an inner tile's posts from its children (which must be in context.nodes), meshes and stores it. Its
// error terms are 0 until they have been measured.
Node build_inner(const BuildContext& context, const lod::TileKey& key);

// Mesh and posts that build_inner would make, from the sources instead of the children: for a tile that lies
// above more than one part of a divided build.
SharedAncestor sample_above(const BuildContext& context, const lod::TileKey& key);

// The tile's Node from what is stored of it, instead of building it: equal to what building it returns. An
// inner tile's children must be in context.nodes.
Node recall_leaf(const BuildContext& context, const NodeRow& row);
Node recall_inner(const BuildContext& context, const NodeRow& row);

// Largest errors of every ancestor's mesh and posts over some finest tiles; from context.above, else as stored.
std::map<lod::TileKey, InnerTerms> measure_chunk(const BuildContext& context,
                                                 std::span<const lod::TileKey> leaves);

// measure_chunk's result as bytes and back; unpack throws CodecError.
Bytes pack_terms(const std::map<lod::TileKey, InnerTerms>& terms);
std::map<lod::TileKey, InnerTerms> unpack_terms(std::span<const std::uint8_t> packed);

// Makes errors nest: none of these inner tiles, deepest first, states less than anything below it.
void nest_errors(BuildContext& context, std::span<const lod::TileKey> inner);

void build_image(const BuildContext& context, const mars::ImageSource& image, const lod::TileKey& key);

// What is stored of a Node, and back: all but lowest_m.
NodeRow to_row(const lod::TileKey& key, const Node& node);
Node node_of(const NodeRow& row);

// Bound of how far a facet of the tile's finest cells sags below the sphere through its posts: a point of a
// flat triangle is within longest edge / sqrt(3) of a post.
inline double facet_sag_m(double spacing_m, double radius_m) {
  return 2.5 * spacing_m * spacing_m / (6.0 * radius_m);
}

// A stored tile's finest or own posts, borders constrained; and a stored mesh's heights in metres.
lod::Posts read_posts(const BuildContext& context, const lod::TileKey& key);
std::vector<double> vertex_heights(const PackedMesh& mesh, double quantum_m);

// Radial distance that a mesh of this level keeps to its posts.
double mesh_tolerance_m(const BuildOptions& options, int level);

}  // namespace paging
