#include "paging/build/builder.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <mutex>
#include <set>

#include "mars/sources/layered_image.h"
#include "paging/build/build_inputs.h"
#include "paging/build/build_resampling.h"
#include "paging/build/build_steps.h"
#include "paging/build/planet_writer.h"
#include "paging/build/shard_file.h"
#include "paging/build/shard_plan.h"
#include "paging/build/source_heights.h"
#include "paging/build/stages.h"
#include "paging/planet/planet_file.h"
#include "vpe/base/parallel.h"

namespace paging {

namespace {

const std::set<lod::TileKey> kNoTiles;
constexpr double kImageShare = 0.06;  // of the time of a build

// Runs the stages of a build in their order; each skips what an earlier build has finished.
class Build {
 public:
  Build(const BuildOptions& options, const mars::ElevationSource& elevation, const mars::ImageSource* image,
        const PlanetMeta& meta, BuildPlan plan, std::vector<lod::TileKey> images,
        std::optional<PatchStart> patch, const ProgressFunction& progress)
      : options_(options),
        elevation_(elevation),
        image_(image),
        meta_(meta),
        plan_(std::move(plan)),
        shard_(shard_plan(plan_, options.shard)),
        images_(std::move(images)),
        layers_(plan_layers(options, image)),
        patch_(std::move(patch)),
        writer_(options.output,
                build_fingerprint(options, meta) + (patch_ ? patch_line(patch_->identity) : std::string()),
                options.commit_s, patch_ ? &*patch_ : nullptr),
        stages_(progress),
        threads_(options.threads > 0 ? options.threads : vpe::base::default_threads()) {
    stages_.replaced = writer_.start() == PartialFileStart::kReplaced;
    stages_.patched = patch_ && writer_.start() != PartialFileStart::kContinued;
  }

  BuildSummary run() {
    try {
      return run_stages();
    } catch (const UnusableSource&) {
      writer_.discard();
      throw;
    }
  }

 private:
  BuildSummary run_stages() {
    std::map<lod::TileKey, NodeRow> stored;
    for (NodeRow& row : writer_.nodes()) stored.emplace(*lod::unpack(row.key), std::move(row));
    build_leaves(stored);
    build_inner_tiles(stored);
    measure();
    build_images();
    build_layers();
    return finish();
  }

  // Stage 1 makes the finest tiles: heights and meshes.
  void build_leaves(const std::map<lod::TileKey, NodeRow>& stored) {
    const std::span<const lod::TileKey> leaves = shard_.leaves;
    std::vector<lod::TileKey> open;
    for (const lod::TileKey& key : leaves) {
      const auto row = stored.find(key);
      if (row == stored.end()) {
        open.push_back(key);
      } else {
        nodes_.emplace(key, recall_leaf(meta_, row->second));
      }
    }
    begin("sampling", leaves.size(), open.size(), 0.62);
    build_each(open, [this](const lod::TileKey& key) { return build_leaf(sampling_, meshing_, writer_, key); });
  }

  // Stage 2 makes the inner tiles, deepest first: posts and meshes over their children's posts.
  void build_inner_tiles(const std::map<lod::TileKey, NodeRow>& stored) {
    const std::vector<lod::TileKey>& inner = shard_.inner;
    const auto to_build = std::count_if(inner.begin(), inner.end(),
                                        [&](const lod::TileKey& key) { return !stored.contains(key); });
    begin("meshing", inner.size(), static_cast<std::size_t>(to_build), 0.15);
    for (std::size_t at = 0; at < inner.size();) {
      std::vector<lod::TileKey> open;
      for (const int level = inner[at].level; at < inner.size() && inner[at].level == level; ++at) {
        const auto row = stored.find(inner[at]);
        if (row == stored.end()) {
          open.push_back(inner[at]);
        } else {
          const bool is_final = patch_ && patch_->kept.contains(inner[at]);
          nodes_.emplace(inner[at],
                         is_final ? recall_measured(nodes_, row->second) : recall_inner(nodes_, row->second));
        }
      }
      build_each(open, [this](const lod::TileKey& key) { return build_inner(meshing_, stored_, key); });
    }
  }

  // Stage 3 measures every inner mesh and its posts against the finest posts and facets below it.
  void measure() {
    constexpr std::size_t kChunk = 32;
    const std::span<const lod::TileKey> leaves = shard_.leaves;
    const std::size_t chunks = (leaves.size() + kChunk - 1) / kChunk;
    const std::map<std::int64_t, Bytes> checkpoints = writer_.checkpoints();
    std::vector<std::size_t> open;
    for (std::size_t c = 0; c < chunks; ++c) {
      const auto checkpoint = checkpoints.find(static_cast<std::int64_t>(c));
      if (checkpoint == checkpoints.end()) {
        open.push_back(c);
      } else {
        include(unpack_terms(checkpoint->second));
      }
    }
    stages_.begin("measuring", static_cast<std::int64_t>(chunks), 0.15,
                  static_cast<std::int64_t>(chunks - open.size()));
    mesh_shared_ancestors();
    std::mutex merge;
    vpe::base::parallel_for(open.size(), threads_, [&](std::size_t n) {
      const std::size_t first = open[n] * kChunk;
      const auto found = measure_chunk(stored_, shared_ancestors_, patch_ ? patch_->kept : kNoTiles,
                                       leaves.subspan(first, std::min(kChunk, leaves.size() - first)));
      writer_.put_checkpoint(static_cast<std::int64_t>(open[n]), pack_terms(found));
      {
        const std::lock_guard lock(merge);
        include(found);
      }
      stages_.advance();
    });
    nest_errors(nodes_, shard_.inner);
  }

  void include(const std::map<lod::TileKey, InnerTerms>& found) {
    for (const auto& [key, terms] : found) {
      const auto node = nodes_.find(key);
      if (node == nodes_.end()) {
        shared_terms_[key].terms.include(terms);
        continue;
      }
      node->second.variants.front().terms.include(terms.mesh);
      node->second.posts_terms.include(terms.posts);
    }
  }

  // Makes meshes and posts of the tiles that lie above other shards too.
  void mesh_shared_ancestors() {
    const std::vector<lod::TileKey>& keys = shard_.shared_ancestors;
    std::vector<SharedAncestor> tiles(keys.size());
    vpe::base::parallel_for(tiles.size(), threads_, [&](std::size_t n) {
      tiles[n] = sample_shared_ancestor(sampling_, meshing_, keys[n]);
    });
    for (std::size_t n = 0; n < tiles.size(); ++n) {
      shared_terms_[keys[n]].mesh_checksum = checksum(lod::pack(keys[n]), encode_mesh(tiles[n].mesh));
      shared_ancestors_.emplace(keys[n], std::move(tiles[n]));
    }
  }

  // Stage 4 makes the pyramid of the image.
  void build_images() {
    std::vector<lod::TileKey>& images = images_;
    const auto count = static_cast<std::int64_t>(images.size());
    images.erase(images.begin() + options_.shard.end(count), images.end());
    images.erase(images.begin(), images.begin() + options_.shard.begin(count));
    const std::set<std::int64_t> stored = writer_.image_keys();
    std::vector<lod::TileKey> open;
    std::copy_if(images.begin(), images.end(), std::back_inserter(open),
                 [&](const lod::TileKey& key) { return !stored.contains(lod::pack(key)); });
    begin("image", images.size(), open.size(), layers_.empty() ? kImageShare : kImageShare / 2);
    vpe::base::parallel_for(open.size(), threads_, [&](std::size_t n) {
      writer_.put_image(open[n], make_image_tile(*image_, open[n], meta_.radius_m, options_.image_quality));
      stages_.advance();
    });
    for (const lod::TileKey& key : images)
      meta_.finest_image_level = std::max(meta_.finest_image_level, key.level);
    meta_.image_tiles = static_cast<std::int64_t>(images.size());
  }

  // Stage 5 makes the pyramids of the layers of the image.
  void build_layers() {
    if (layers_.empty()) return;
    writer_.begin_layers();
    const std::set<LayerTileKey> stored = writer_.layer_keys();
    struct Open {
      const mars::ImageSource* source = nullptr;
      lod::TileKey tile;
      LayerTileKey key;
    };
    std::vector<Open> open;
    std::size_t total = 0;
    const std::vector<mars::ImageLayerSource>& sources = *mars::layers_of(image_);
    for (std::size_t n = 0; n < layers_.size(); ++n) {
      const auto count = static_cast<std::int64_t>(layers_[n].size());
      for (std::int64_t k = options_.shard.begin(count); k < options_.shard.end(count); ++k, ++total) {
        const lod::TileKey& tile = layers_[n][static_cast<std::size_t>(k)];
        const LayerTileKey key{static_cast<std::int64_t>(n), lod::pack(tile)};
        if (!stored.contains(key)) open.push_back({sources[n].source.get(), tile, key});
      }
    }
    begin("image layers", total, open.size(), kImageShare / 2);
    vpe::base::parallel_for(open.size(), threads_, [&](std::size_t n) {
      writer_.put_layer_tile(
          open[n].key, make_layer_tile(*open[n].source, open[n].tile, meta_.radius_m, options_.image_quality));
      stages_.advance();
    });
    writer_.count_layers(meta_.image_layers);
  }

  BuildSummary finish() {
    BuildSummary summary;
    std::vector<NodeRow> measured;
    meta_.tiles = static_cast<std::int64_t>(nodes_.size());
    meta_.leaf_tiles = static_cast<std::int64_t>(shard_.leaves.size());
    meta_.lowest_radius_m = meta_.highest_radius_m = meta_.radius_m + nodes_.begin()->second.lowest_m;
    for (const auto& [key, node] : nodes_) {
      meta_.lowest_radius_m = std::min(meta_.lowest_radius_m, meta_.radius_m + node.lowest_m);
      meta_.highest_radius_m = std::max(meta_.highest_radius_m, meta_.radius_m + node.max_m);
      meta_.finest_level = std::max(meta_.finest_level, key.level);
      for (const lod::MeshVariant& v : node.variants) summary.mesh_triangles += v.triangles;
      if (node.inner && !(patch_ && patch_->kept.contains(key))) measured.push_back(to_row(key, node));
    }
    writer_.replace_nodes(measured);

    // Stage 6 measures the reference surface against the sources' own posts.
    stages_.begin("checking", 1, 0.02);
    ResamplingReport resampling = measure_made_tiles();
    check_files(meta_.sources);
    check_files(meta_.image_sources);
    meta_.levels = writer_.levels(static_cast<std::size_t>(meta_.tile.post_count()));
    set_resampling(meta_, resampling.sums);
    if (!options_.shard.is_all()) {
      meta_.shard = ShardMeta{options_.shard, options_.mesh_ratio, std::move(resampling.sums)};
      writer_.put_checkpoint(kSharedAncestorsCheckpoint, pack_shared_ancestors(shared_terms_));
    }
    writer_.seal(meta_);
    if (!meta_.shard) PlanetFile::open(writer_.part_path());  // throws when it cannot be used
    stages_.advance();                                        // the last chance to be interrupted
    writer_.publish(meta_);

    summary.posts = meta_.leaf_tiles * meta_.tile.post_count();
    summary.bytes = static_cast<std::int64_t>(std::filesystem::file_size(options_.output));
    summary.kept = stages_.kept();
    summary.meta = meta_;
    return summary;
  }

  // Measures the tiles that this build makes. Those that a patch keeps keep their errors, since each has few posts.
  ResamplingReport measure_made_tiles() {
    std::vector<lod::TileKey> made;
    if (patch_) {
      std::ranges::copy_if(shard_.leaves, std::back_inserter(made),
                           [&](const lod::TileKey& key) { return !patch_->kept.contains(key); });
    }
    const std::span<const lod::TileKey> leaves = patch_ ? std::span<const lod::TileKey>(made) : shard_.leaves;
    ResamplingReport found =
        measure_resampling(sampling_, stored_, options_.resampling_posts,
                           wanted_posts(options_, meta_, leaves, patch_ || !options_.shard.is_all()), leaves,
                           threads_, [this] { stages_.report_again(); });
    writer_.put_resampling(found.tiles);
    if (patch_) {
      for (const TileResampling& row : writer_.resampling()) {
        const lod::TileKey key = *lod::unpack(row.key);
        if (patch_->kept.contains(key)) found.sums[{key.level, row.of.source}].include(sum_of(row.of.error));
      }
    }
    return found;
  }

  void begin(const char* name, std::size_t total, std::size_t open, double share) {
    stages_.add_kept(static_cast<std::int64_t>(total - open));
    stages_.begin(name, static_cast<std::int64_t>(total), share, static_cast<std::int64_t>(total - open));
  }

  // Builds tiles that do not need each other.
  template <typename MakeNode>
  void build_each(const std::vector<lod::TileKey>& keys, const MakeNode& build) {
    std::vector<Node> made(keys.size());
    vpe::base::parallel_for(keys.size(), threads_, [&](std::size_t n) {
      made[n] = build(keys[n]);
      stages_.advance();
    });
    for (std::size_t n = 0; n < keys.size(); ++n) nodes_.emplace(keys[n], std::move(made[n]));
  }

  const BuildOptions& options_;
  const mars::ElevationSource& elevation_;
  const mars::ImageSource* image_;
  PlanetMeta meta_;
  BuildPlan plan_;
  ShardPlan shard_;
  std::vector<lod::TileKey> images_;
  std::vector<std::vector<lod::TileKey>> layers_;  // by layer
  std::optional<PatchStart> patch_;
  PlanetWriter writer_;
  Stages stages_;
  int threads_;
  MesherPool meshers_;
  Nodes nodes_;
  SharedAncestors shared_ancestors_;
  std::map<lod::TileKey, SharedAncestorTerms> shared_terms_;
  const SampleInputs sampling_{meta_, plan_, elevation_};
  const MeshInputs meshing_{meta_, plan_, options_.mesh_ratio, meshers_};
  const StoredTiles stored_{meta_, writer_, nodes_};
};

std::vector<lod::TileKey> image_tiles(const BuildOptions& options, const mars::ImageSource* image) {
  return image != nullptr ? plan_images(options, *image) : std::vector<lod::TileKey>();
}

}  // namespace

BuildSummary build_planet(const BuildOptions& options, const mars::ElevationSource& elevation,
                          const mars::ImageSource* image, const ProgressFunction& progress,
                          std::optional<BuildPlan> plan) {
  const PlanetMeta meta = describe_planet(options, elevation, image);
  if (!options.shard.is_all() && options.keep_shard)
    if (const auto finished = finished_shard(options, meta)) return *finished;
  if (!plan) plan = plan_tiles(options, elevation);
  return Build(options, elevation, image, meta, std::move(*plan), image_tiles(options, image), {}, progress)
      .run();
}

BuildSummary patch_planet(const BuildOptions& options, const PatchedPlanet& patched,
                          const mars::ElevationSource& elevation, const mars::ImageSource* image,
                          const ProgressFunction& progress, std::optional<BuildPlan> plan) {
  if (!options.shard.is_all()) throw PlanetError(patched.path + ": a part of a planet cannot be patched");
  const FinishedPlanet finished = read_finished(patched.path);
  // The fill is seen nowhere on a planet without nodata, and more sources leave it so.
  const PlanetMeta meta =
      describe_planet(options, elevation, image,
                      finished.with_nodata.empty() ? std::optional(finished.meta.fill_m) : std::nullopt);
  if (!plan) plan = plan_tiles(options, elevation);
  std::vector<lod::TileKey> images = image_tiles(options, image);
  PatchStart patch = plan_patch(finished, patched, meta, *plan, {images, plan_layers(options, image)});
  return Build(options, elevation, image, meta, std::move(*plan), std::move(images), std::move(patch), progress)
      .run();
}

}  // namespace paging
