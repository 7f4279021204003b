#include "paging/build/merge.h"

#include <algorithm>
#include <filesystem>

#include "paging/build/build_inputs.h"
#include "paging/build/build_steps.h"
#include "paging/build/shard_file.h"
#include "paging/build/stages.h"
#include "paging/planet/planet_file.h"
#include "vpe/base/parallel.h"

namespace paging {

namespace {

std::string shard_name(const vpe::base::Shard& shard) {
  return "part " + std::to_string(shard.number) + " of " + std::to_string(shard.of);
}

// Opens the shards in their order. Throws PlanetError unless they are all shards of one build.
std::vector<std::unique_ptr<ShardFile>> open_shards(const std::vector<std::string>& paths) {
  std::map<std::int64_t, std::unique_ptr<ShardFile>> by_number;
  const ShardFile* first = nullptr;
  for (const std::string& path : paths) {
    auto file = std::make_unique<ShardFile>(path);
    if (first == nullptr) first = file.get();
    if (file->id().of != first->id().of) {
      throw PlanetError(path + ": " + shard_name(file->id()) + ", but " + first->path() + " is " +
                        shard_name(first->id()) + "; give the parts of one build");
    }
    if (file->fingerprint() != first->fingerprint()) {
      std::string texts;
      for (const std::string& text :
           fingerprint_differences(file->fingerprint(), first->fingerprint(), file->meta()))
        texts += (texts.empty() ? "" : "; ") + text;
      throw PlanetError(path + ": made of other sources, with other options or by another version than " +
                        first->path() + " (" + texts + "); give the parts of one build");
    }
    const std::int64_t number = file->id().number;
    const auto [at, is_new] = by_number.emplace(number, std::move(file));
    if (!is_new) {
      throw PlanetError(path + ": " + shard_name(at->second->id()) + ", as is " + at->second->path() +
                        "; give each part once");
    }
  }
  if (first == nullptr) throw PlanetError("no parts to merge: give the files that 'vpe build --part' made");
  if (static_cast<std::int64_t>(by_number.size()) != first->id().of) {
    std::string absent;
    int named = 0;
    for (std::int64_t n = 1; n <= first->id().of && named < 10; ++n) {
      if (by_number.contains(n)) continue;
      absent += (named++ > 0 ? ", " : "") + std::to_string(n);
    }
    const auto count = first->id().of - static_cast<std::int64_t>(by_number.size());
    throw PlanetError("of " + std::to_string(first->id().of) + " parts " + std::to_string(count) +
                      " are missing: " + absent + (count > named ? ", ..." : "") +
                      "; make them with 'vpe build ... --part', and give all to 'vpe merge'");
  }
  std::vector<std::unique_ptr<ShardFile>> out;
  for (auto& [number, file] : by_number) out.push_back(std::move(file));
  return out;
}

// Returns everything that the content of the merged file is a function of, as text.
std::string fingerprint_of_merge(const std::vector<std::unique_ptr<ShardFile>>& shards) {
  // With the format, because a merge that an older program began has not all tables.
  std::string text = "merge to format " + std::to_string(kFormatMajor) + "." + std::to_string(kFormatMinor) +
                     " of\n" + shards.front()->fingerprint();
  for (const auto& shard : shards) text += shard->meta().identity + "\n";
  return text;
}

class Merge {
 public:
  Merge(const MergeOptions& options, const ProgressFunction& progress)
      : options_(options),
        shards_(open_shards(options.shards)),
        writer_(options.output, fingerprint_of_merge(shards_), options.commit_s),
        stages_(progress),
        threads_(options.threads > 0 ? options.threads : vpe::base::default_threads()) {
    stages_.replaced = writer_.start() == PartialFileStart::kReplaced;
    meta_ = shards_.front()->meta();
    meta_.shard.reset();
  }

  BuildSummary run() {
    copy_tiles();
    copy_images();
    copy_layers();
    build_shared_ancestors();
    return finish();
  }

 private:
  // Stage 1 copies the tiles of the shards. Keeps of most tiles only their keys.
  void copy_tiles() {
    std::map<lod::TileKey, NodeRow> stored;
    for (NodeRow& row : writer_.nodes()) stored.emplace(*lod::unpack(row.key), std::move(row));
    std::int64_t total = 0;
    for (const auto& shard : shards_) total += shard->meta().tiles;
    stages_.add_kept(static_cast<std::int64_t>(stored.size()));
    stages_.begin("tiles", total, 0.8);
    std::vector<lod::TileKey> leaves;
    for (const auto& shard : shards_) {
      for (const auto& [key, ancestor] : shard->shared_ancestors()) {
        const auto [at, is_new] = shared_terms_.emplace(key, ancestor);
        if (is_new) continue;
        at->second.terms.include(ancestor.terms);
        if (at->second.mesh_checksum != ancestor.mesh_checksum) refuse(*shard, key);
      }
    }
    for (const auto& shard : shards_) {
      for (const NodeRow& row : shard->nodes()) {
        const lod::TileKey key = *lod::unpack(row.key);
        for (const lod::MeshVariant& v : row.variants) mesh_triangles_ += v.triangles;
        if (!row.inner) leaves.push_back(key);
        if (key.level > 0 && shared_terms_.contains(lod::parent(key))) nodes_.emplace(key, node_of(row));
        if (!stored.contains(key)) writer_.put_tile(row, shard->payload(row));
        stages_.advance();
      }
    }
    std::erase_if(stored, [&](const auto& entry) { return !shared_terms_.contains(entry.first); });
    stored_ancestors_ = std::move(stored);
    try {
      plan_ = std::make_unique<BuildPlan>(std::move(leaves));
    } catch (const std::runtime_error& e) {
      throw PlanetError(options_.output + ": " + e.what() + ": the parts do not match; build them again");
    }
  }

  [[noreturn]] static void refuse(const ShardFile& shard, const lod::TileKey& key) {
    throw PlanetError(
        shard.path() + ": tile " + lod::to_string(key) +
        " above it differs from that of other parts: a source has changed under its name; build the "
        "parts again");
  }

  void copy_images() {
    std::int64_t total = 0;
    for (const auto& shard : shards_) total += shard->meta().image_tiles;
    const std::set<std::int64_t> stored = writer_.image_keys();
    stages_.add_kept(static_cast<std::int64_t>(stored.size()));
    stages_.begin("image", total, 0.15);
    for (const auto& shard : shards_) {
      for (const std::int64_t key : shard->image_keys()) {
        if (!stored.contains(key)) writer_.put_image(*lod::unpack(key), shard->image(key));
        stages_.advance();
      }
    }
  }

  void copy_layers() {
    if (meta_.image_layers.empty()) return;
    writer_.begin_layers();
    const std::set<LayerTileKey> stored = writer_.layer_keys();
    stages_.add_kept(static_cast<std::int64_t>(stored.size()));
    for (const auto& shard : shards_) {
      for (const LayerTileKey& key : shard->layer_keys()) {
        if (!stored.contains(key)) writer_.put_layer_tile(key, shard->layer_tile(key));
        stages_.report_again();
      }
    }
    writer_.count_layers(meta_.image_layers);
  }

  // Stage 2 makes the inner tiles above several shards, deepest first.
  void build_shared_ancestors() {
    const MeshInputs meshing{meta_, *plan_, shards_.front()->meta().shard->mesh_ratio, meshers_};
    const StoredTiles written{meta_, writer_, nodes_};
    std::vector<lod::TileKey> keys;
    for (const lod::TileKey& key : plan_->inner()) {
      if (shared_terms_.contains(key)) keys.push_back(key);
    }
    stages_.begin("meshing", static_cast<std::int64_t>(keys.size()), 0.05);
    for (std::size_t at = 0; at < keys.size();) {
      const std::size_t begin = at;
      while (at < keys.size() && keys[at].level == keys[begin].level) ++at;
      std::vector<Node> made(at - begin);
      vpe::base::parallel_for(made.size(), threads_, [&](std::size_t n) {
        const lod::TileKey& key = keys[begin + n];
        const auto stored = stored_ancestors_.find(key);
        made[n] =
            stored != stored_ancestors_.end() ? node_of(stored->second) : build_inner(meshing, written, key);
        stages_.advance();
      });
      for (std::size_t n = 0; n < made.size(); ++n) nodes_.emplace(keys[begin + n], std::move(made[n]));
    }
    std::vector<NodeRow> rows;
    for (const lod::TileKey& key : keys) {
      if (checksum(lod::pack(key), writer_.mesh(key, 0)) != shared_terms_.at(key).mesh_checksum) {
        refuse(*shards_.front(), key);
      }
      lod::MeshVariant& mesh = nodes_.at(key).variants.front();
      mesh.terms = shared_terms_.at(key).terms.mesh;
      nodes_.at(key).posts_terms = shared_terms_.at(key).terms.posts;
      mesh_triangles_ += mesh.triangles;
    }
    nest_errors(nodes_, keys);
    for (const lod::TileKey& key : keys) rows.push_back(to_row(key, nodes_.at(key)));
    writer_.replace_nodes(rows);
  }

  BuildSummary finish() {
    ResamplingSums sums;
    meta_.tiles = static_cast<std::int64_t>(shared_terms_.size());
    meta_.leaf_tiles = meta_.image_tiles = 0;
    for (const auto& shard : shards_) {
      const PlanetMeta& m = shard->meta();
      meta_.tiles += m.tiles;
      meta_.leaf_tiles += m.leaf_tiles;
      meta_.image_tiles += m.image_tiles;
      meta_.lowest_radius_m = std::min(meta_.lowest_radius_m, m.lowest_radius_m);
      meta_.highest_radius_m = std::max(meta_.highest_radius_m, m.highest_radius_m);
      meta_.finest_level = std::max(meta_.finest_level, m.finest_level);
      meta_.finest_image_level = std::max(meta_.finest_image_level, m.finest_image_level);
      for (const auto& [place, own] : m.shard->resampling) sums[place].include(own);
      writer_.put_resampling(shard->resampling());
    }
    meta_.levels = writer_.levels(static_cast<std::size_t>(meta_.tile.post_count()));
    set_resampling(meta_, sums);
    stages_.begin("checking", 1, 0);
    writer_.seal(meta_);
    PlanetFile::open(writer_.part_path());
    stages_.advance();  // the last chance to be interrupted
    writer_.publish(meta_);

    BuildSummary summary;
    summary.mesh_triangles = mesh_triangles_;
    summary.posts = meta_.leaf_tiles * meta_.tile.post_count();
    summary.bytes = static_cast<std::int64_t>(std::filesystem::file_size(options_.output));
    summary.kept = stages_.kept();
    summary.meta = meta_;
    return summary;
  }

  const MergeOptions& options_;
  std::vector<std::unique_ptr<ShardFile>> shards_;
  PlanetWriter writer_;
  Stages stages_;
  int threads_;
  PlanetMeta meta_;
  MesherPool meshers_;
  std::unique_ptr<BuildPlan> plan_;
  std::map<lod::TileKey, SharedAncestorTerms> shared_terms_;
  Nodes nodes_;                                       // shared ancestors and their children
  std::map<lod::TileKey, NodeRow> stored_ancestors_;  // those that an earlier, stopped merge made
  std::int64_t mesh_triangles_ = 0;
};

}  // namespace

BuildSummary merge_shards(const MergeOptions& options, const ProgressFunction& progress) {
  return Merge(options, progress).run();
}

}  // namespace paging
