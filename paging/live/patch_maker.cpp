#include "paging/live/patch_maker.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>

#include "paging/live/grid_tiles.h"
#include "paging/live/memory_tiles.h"
#include "paging/live/patch_plan.h"
#include "vpe/base/parallel.h"

namespace paging {

namespace {

// Leaves that one thread measures after each other share the meters of their ancestors.
constexpr std::size_t kPatchChunk = 8;

// Holds what all patches of a planet use.
struct PatchInputs {
  std::shared_ptr<const PlanetFile> planet;
  PlanetGround ground;
  BaseTiles base;
  PatchPlanner planner;
};

// Makes one patch.
class PatchJob {
 public:
  PatchJob(const PatchInputs& inputs, const GroundChange& change, const PatchOptions& options, PatchPlan plan,
           PlanetMeta meta)
      : inputs_(inputs),
        planet_(*inputs.planet),
        change_(change),
        options_(options),
        plan_(std::move(plan)),
        meta_(std::move(meta)),
        store_(planet_),
        threads_(options.threads > 0 ? options.threads : vpe::base::default_threads()) {}

  std::shared_ptr<const TilePatch> run() {
    if (options_.full_grids) {
      make_grids();
    } else {
      make_meshes();
    }
    nest_errors(nodes_, plan_.inner);
    for (const lod::TileKey& key : plan_.inner) store_.replace_row(final_row(key));
    auto patch = std::make_shared<TilePatch>();
    patch->tiles = store_.take();
    describe();
    patch->meta = std::move(meta_);
    return patch;
  }

 private:
  SampledLeaf sample(const lod::TileKey& key, const GroundGrid& ground) const {
    return changed_leaf(meta_, planet_.meta().sources.size(), *plan_.tiles, ground, change_, key);
  }

  // Makes tiles that do not need each other.
  template <class Tile, class Make>
  std::vector<Tile> make_each(std::span<const lod::TileKey> keys, const Make& make) const {
    std::vector<Tile> made(keys.size());
    vpe::base::parallel_for(keys.size(), threads_, [&](std::size_t n) { made[n] = make(keys[n]); });
    return made;
  }

  // Calls make(keys) for the inner tiles of each level, deepest first.
  template <class Make>
  void for_each_level(const Make& make) const {
    const std::span<const lod::TileKey> inner = plan_.inner;
    for (std::size_t at = 0; at < inner.size();) {
      std::size_t end = at;
      while (end < inner.size() && inner[end].level == inner[at].level) ++end;
      make(inner.subspan(at, end - at));
      at = end;
    }
  }

  // Holds the planet's tiles beside those that are made as nodes, with their sources where a parent asks for them.
  void add_node(const lod::TileKey& key, bool with_sources) {
    const auto at = nodes_.find(key);
    if (at != nodes_.end() && (!with_sources || !at->second.sources.empty())) return;
    int mask = 0;
    for (const lod::Edge edge : lod::kEdges)
      if (!plan_.tiles->is_inner(key) && plan_.tiles->edge_step(key, edge) != 0)
        mask |= 1 << static_cast<int>(edge);
    nodes_.insert_or_assign(key, inputs_.base.node(key, mask, with_sources));
  }

  void add_nodes_beside() {
    for (const lod::TileKey& key : plan_.inner) {
      for (int c = 0; c < 4; ++c) {
        const lod::TileKey child = lod::child(key, c);
        if (!is_made_.contains(child)) add_node(child, true);
      }
    }
  }

  void remember_made() {
    is_made_.insert(plan_.leaves.begin(), plan_.leaves.end());
    is_made_.insert(plan_.inner.begin(), plan_.inner.end());
    add_nodes_beside();
  }

  // Makes full grids, and the planet's meshes with new heights.
  void make_grids() {
    remember_made();
    const IsMade is_made = [this](const lod::TileKey& key) { return is_made_.contains(key); };
    std::map<lod::TileKey, GridTile> tiles;
    const auto keep = [&](std::span<const lod::TileKey> keys, std::vector<GridTile> made) {
      for (std::size_t n = 0; n < keys.size(); ++n) {
        nodes_[keys[n]] = std::move(made[n].node);
        tiles.emplace(keys[n], std::move(made[n]));
      }
    };
    keep(plan_.leaves, make_each<GridTile>(plan_.leaves, [&](const lod::TileKey& key) {
           const auto ground = inputs_.ground.grid(key);
           return make_grid_leaf(meta_, inputs_.base, sample(key, *ground), *ground, store_);
         }));
    for_each_level([&](std::span<const lod::TileKey> keys) {
      keep(keys, make_each<GridTile>(keys, [&](const lod::TileKey& key) {
             GridChildren children;
             for (std::size_t c = 0; c < 4; ++c) {
               const lod::TileKey child = lod::child(key, static_cast<int>(c));
               children.nodes[c] = &nodes_.at(child);
               if (const auto at = tiles.find(child); at != tiles.end()) children.made[c] = &at->second;
             }
             const lod::TileInfo* was = planet_.tree().find(key);
             return was != nullptr && was->has_children
                        ? make_grid_inner(meta_, inputs_.base, children, key, store_)
                        : make_divided_tile(meta_, inputs_.base, children, key, is_made, store_);
           }));
    });
    measure_in_chunks(plan_.leaves, [&](std::span<const lod::TileKey> leaves) {
      return measure_divided_tiles(stored_, planet_.tree(), tiles, leaves);
    });
  }

  // Makes what the builder makes.
  void make_meshes() {
    remember_made();
    const auto keep = [&](std::span<const lod::TileKey> keys, std::vector<Node> made) {
      for (std::size_t n = 0; n < keys.size(); ++n) nodes_[keys[n]] = std::move(made[n]);
    };
    keep(plan_.leaves, make_each<Node>(plan_.leaves, [&](const lod::TileKey& key) {
           return mesh_leaf(meshing_, sample(key, *inputs_.ground.grid(key)), store_);
         }));
    for_each_level([&](std::span<const lod::TileKey> keys) {
      keep(keys,
           make_each<Node>(keys, [&](const lod::TileKey& key) { return build_inner(meshing_, stored_, key); }));
    });
    // Tiles above the change are measured over all finest tiles below them.
    std::set<lod::TileKey> kept;
    for (const lod::TileKey& key : plan_.tiles->inner())
      if (!is_made_.contains(key)) kept.insert(key);
    std::vector<lod::TileKey> below;
    for (const lod::TileKey& leaf : plan_.tiles->leaves()) {
      if (!is_made_.contains({leaf.face, 0, 0, 0})) continue;
      below.push_back(leaf);
      if (!is_made_.contains(leaf)) add_node(leaf, false);
    }
    measure_in_chunks(
        below, [&](std::span<const lod::TileKey> leaves) { return measure_chunk(stored_, {}, kept, leaves); });
  }

  template <class Measure>
  void measure_in_chunks(std::span<const lod::TileKey> leaves, const Measure& measure) {
    const std::size_t chunks = (leaves.size() + kPatchChunk - 1) / kPatchChunk;
    std::vector<std::map<lod::TileKey, InnerTerms>> found(chunks);
    vpe::base::parallel_for(chunks, threads_, [&](std::size_t n) {
      const std::size_t first = n * kPatchChunk;
      found[n] = measure(leaves.subspan(first, std::min(kPatchChunk, leaves.size() - first)));
    });
    for (const auto& some : found) {
      for (const auto& [key, terms] : some) {
        Node& node = nodes_.at(key);
        node.variants.front().terms.include(terms.mesh);
        node.posts_terms.include(terms.posts);
      }
    }
  }

  NodeRow final_row(const lod::TileKey& key) const {
    NodeRow row = to_row(key, nodes_.at(key));
    // What bounds the error of a tile's posts is not known in files before format 1.2.
    const lod::TileInfo* was = planet_.tree().find(key);
    if (options_.full_grids && was != nullptr && was->has_children && !was->posts_terms.known())
      row.posts_terms.reset();
    return row;
  }

  // Sets counts and bounds of the planet with the patch.
  void describe() {
    std::map<int, LevelSummary> levels;
    for (const LevelSummary& level : meta_.levels) levels[level.level] = level;
    const double radius_m = meta_.radius_m;
    double lowest_m = std::numeric_limits<double>::infinity();
    double highest_m = -lowest_m;
    const auto include = [&](const lod::TileKey& key, double low_m, double high_m) {
      const double spacing_m = lod::post_spacing_m(key.level, meta_.tile.intervals(), radius_m);
      lowest_m = std::min(lowest_m, radius_m + low_m - facet_sagitta_m(spacing_m, radius_m));
      highest_m = std::max(highest_m, radius_m + high_m);
    };
    for (const lod::TileInfo& tile : planet_.tree().tiles())
      if (!tile.has_children && !is_made_.contains(tile.key))
        include(tile.key, tile.min_height_m, tile.max_height_m);
    for (const lod::TileKey& key : plan_.leaves) include(key, nodes_.at(key).min_m, nodes_.at(key).max_m);
    meta_.lowest_radius_m = lowest_m;
    meta_.highest_radius_m = highest_m;
    const auto count = [&](const lod::TileKey& key) {
      LevelSummary& level = levels[key.level];
      level.level = key.level;
      const lod::TileInfo* was = planet_.tree().find(key);
      const int leaf = plan_.tiles->is_inner(key) ? 0 : 1;
      const int leaf_before = was != nullptr && !was->has_children ? 1 : 0;
      level.tiles += was == nullptr ? 1 : 0;
      level.leaf_tiles += leaf - leaf_before;
      meta_.tiles += was == nullptr ? 1 : 0;
      meta_.leaf_tiles += leaf - leaf_before;
      meta_.finest_level = std::max(meta_.finest_level, key.level);
    };
    for (const lod::TileKey& key : plan_.leaves) count(key);
    for (const lod::TileKey& key : plan_.inner) count(key);
    if (meta_.levels.empty()) return;  // a file of format 1.0
    meta_.levels.clear();
    for (auto& [number, level] : levels) meta_.levels.push_back(std::move(level));
  }

  const PatchInputs& inputs_;
  const PlanetFile& planet_;
  const GroundChange& change_;
  const PatchOptions& options_;
  const PatchPlan plan_;
  PlanetMeta meta_;
  MemoryTiles store_;
  int threads_;
  MesherPool meshers_;
  Nodes nodes_;
  std::set<lod::TileKey> is_made_;
  const MeshInputs meshing_{meta_, *plan_.tiles, options_.mesh_ratio, meshers_};
  const StoredTiles stored_{meta_, store_, nodes_};
};

void check_options(const PatchOptions& options) {
  const auto refuse = [](const std::string& what) { throw std::invalid_argument("patch: " + what); };
  if (!(options.mesh_ratio > 0 && std::isfinite(options.mesh_ratio))) refuse("mesh_ratio must be above 0");
  if (!(options.finest_spacing_m >= 0)) refuse("finest_spacing_m must not be below 0");
  if (options.most_finest_tiles == 0) refuse("most_finest_tiles must be above 0");
}

// Describes the planet with the sources of a change.
PlanetMeta changed_meta(const PlanetMeta& planet, const GroundChange& change) {
  PlanetMeta meta = planet;
  for (mars::SourceInfo info : change.infos()) {
    if (!info.datum.is_known()) info.datum = planet.datum;
    meta.illustration = meta.illustration || info.illustration;
    meta.sources.push_back(std::move(info));
  }
  meta.build_settings.clear();  // no build makes this planet
  meta.arguments.clear();
  meta.identity.clear();
  return meta;
}

}  // namespace

class PatchMaker::Impl {
 public:
  Impl(const std::shared_ptr<const PlanetFile>& planet, std::size_t budget_bytes)
      : inputs_{planet, PlanetGround(planet, budget_bytes - budget_bytes / 4),
                BaseTiles(planet, budget_bytes / 4), PatchPlanner(planet->tree())} {}

  const PatchInputs& inputs() const { return inputs_; }

  MadePatch make(const GroundChange& change, const PatchOptions& options) const {
    PatchPlan plan = planned(change, options);
    MadePatch made = described(plan);
    if (plan.leaves.empty()) return made;
    made.patch =
        PatchJob(inputs_, change, options, std::move(plan), changed_meta(inputs_.planet->meta(), change)).run();
    return made;
  }

  MadePatch plan(const GroundChange& change, const PatchOptions& options) const {
    return described(planned(change, options));
  }

 private:
  PatchPlan planned(const GroundChange& change, const PatchOptions& options) const {
    check_options(options);
    return inputs_.planner.plan(change, options);
  }

  MadePatch described(const PatchPlan& plan) const {
    MadePatch made;
    if (plan.leaves.empty()) return made;
    made.is_coarser = plan.is_coarser;
    made.finest_tiles = static_cast<std::int64_t>(plan.leaves.size());
    made.tiles = made.finest_tiles + static_cast<std::int64_t>(plan.inner.size());
    int finest = 0;
    for (const lod::TileKey& key : plan.leaves) finest = std::max(finest, key.level);
    const PlanetMeta& meta = inputs_.planet->meta();
    made.spacing_m = lod::post_spacing_m(finest, meta.tile.intervals(), meta.radius_m);
    return made;
  }

  PatchInputs inputs_;
};

PatchMaker::PatchMaker(std::shared_ptr<const PlanetFile> planet, std::size_t budget_bytes)
    : impl_(std::make_unique<const Impl>(planet, budget_bytes)) {}
PatchMaker::~PatchMaker() = default;
PatchMaker::PatchMaker(PatchMaker&&) noexcept = default;
PatchMaker& PatchMaker::operator=(PatchMaker&&) noexcept = default;

const std::shared_ptr<const PlanetFile>& PatchMaker::planet() const { return impl_->inputs().planet; }

double PatchMaker::ground_m(const glm::dvec3& direction) const {
  return impl_->inputs().ground.height_m(direction);
}

MadePatch PatchMaker::make(const GroundChange& change, const PatchOptions& options) const {
  return impl_->make(change, options);
}

MadePatch PatchMaker::plan(const GroundChange& change, const PatchOptions& options) const {
  return impl_->plan(change, options);
}

}  // namespace paging
