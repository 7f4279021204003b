#include "paging/build/merge.h"

#include <algorithm>
#include <filesystem>

#include "paging/build/shard_file.h"
#include "paging/build/stages.h"
#include "paging/planet/planet_file.h"
#include "vpe/base/parallel.h"

namespace paging {

namespace {

std::string part_name(const vpe::base::Shard& part) {
  return "part " + std::to_string(part.number) + " of " + std::to_string(part.of);
}

// The parts in their order, if they are all and of one build.
std::vector<std::unique_ptr<ShardFile>> open_parts(const std::vector<std::string>& paths) {
  std::map<std::int64_t, std::unique_ptr<ShardFile>> by_number;
  const ShardFile* first = nullptr;
  for (const std::string& path : paths) {
    auto file = std::make_unique<ShardFile>(path);
    if (first == nullptr) first = file.get();
    if (file->part().of != first->part().of) {
      throw PlanetError(path + ": " + part_name(file->part()) + ", but " + first->path() + " is " +
                        part_name(first->part()) + "; give the parts of one build");
    }
    if (file->fingerprint() != first->fingerprint()) {
      throw PlanetError(path + ": made of other sources, with other options or by another version than " +
                        first->path() + "; give the parts of one build");
    }
    const std::int64_t number = file->part().number;
    const auto [at, is_new] = by_number.emplace(number, std::move(file));
    if (!is_new) {
      throw PlanetError(path + ": " + part_name(at->second->part()) + ", as is " + at->second->path() +
                        "; give each part once");
    }
  }
  if (first == nullptr) throw PlanetError("no parts to merge: give the files that 'vpe build --part' made");
  if (static_cast<std::int64_t>(by_number.size()) != first->part().of) {
    std::string missing;
    int named = 0;
    for (std::int64_t n = 1; n <= first->part().of && named < 10; ++n) {
      if (by_number.contains(n)) continue;
      missing += (named++ > 0 ? ", " : "") + std::to_string(n);
    }
    const auto count = first->part().of - static_cast<std::int64_t>(by_number.size());
    throw PlanetError("of " + std::to_string(first->part().of) + " parts " + std::to_string(count) +
                      " are missing: " + missing + (count > named ? ", ..." : "") +
                      "; make them with 'vpe build ... --part', and give all to 'vpe merge'");
  }
  std::vector<std::unique_ptr<ShardFile>> out;
  for (auto& [number, file] : by_number) out.push_back(std::move(file));
  return out;
}

// What the merged file is a function of.
std::string fingerprint_of_merge(const std::vector<std::unique_ptr<ShardFile>>& parts) {
  std::string text = "merge of\n" + parts.front()->fingerprint();
  for (const auto& part : parts) text += part->meta().identity + "\n";
  return text;
}

class Merge {
 public:
  Merge(const MergeOptions& options, const ProgressFunction& progress)
      : options_(options),
        parts_(open_parts(options.parts)),
        writer_(options.output, fingerprint_of_merge(parts_), options.commit_s),
        stages_(progress),
        threads_(options.threads > 0 ? options.threads : vpe::base::default_threads()) {
    stages_.replaced = writer_.start() == PartialFileStart::kReplaced;
    meta_ = parts_.front()->meta();
    meta_.share.reset();
    build_.mesh_ratio = parts_.front()->meta().share->mesh_ratio;
    build_.radius_m = meta_.radius_m;
  }

  BuildSummary run() {
    copy_tiles();
    copy_images();
    build_above();
    return finish();
  }

 private:
  // 1. Tiles of the parts. Of most, no more is kept than where they are.
  void copy_tiles() {
    std::map<lod::TileKey, NodeRow> stored;
    for (NodeRow& row : writer_.nodes()) stored.emplace(*lod::unpack(row.key), std::move(row));
    std::int64_t total = 0;
    for (const auto& part : parts_) total += part->meta().tiles;
    stages_.add_kept(static_cast<std::int64_t>(stored.size()));
    stages_.begin("tiles", total, 0.8);
    std::vector<lod::TileKey> leaves;
    for (const auto& part : parts_) {
      for (const auto& [key, checkpoint] : part->above()) {
        const auto [at, is_new] = above_.emplace(key, checkpoint);
        if (is_new) continue;
        at->second.terms.include(checkpoint.terms);
        if (at->second.mesh_checksum != checkpoint.mesh_checksum) refuse(*part, key);
      }
    }
    for (const auto& part : parts_) {
      for (const NodeRow& row : part->nodes()) {
        const lod::TileKey key = *lod::unpack(row.key);
        for (const lod::MeshVariant& v : row.variants) mesh_triangles_ += v.triangles;
        if (!row.inner) leaves.push_back(key);
        if (key.level > 0 && above_.contains(lod::parent(key))) nodes_.emplace(key, node_of(row));
        if (!stored.contains(key)) writer_.put_tile(row, part->payload(row));
        stages_.advance();
      }
    }
    std::erase_if(stored, [&](const auto& entry) { return !above_.contains(entry.first); });
    stored_above_ = std::move(stored);
    try {
      plan_ = std::make_unique<BuildPlan>(std::move(leaves));
    } catch (const std::runtime_error& e) {
      throw PlanetError(options_.output + ": " + e.what() + ": the parts do not fit; build them again");
    }
  }

  [[noreturn]] static void refuse(const ShardFile& part, const lod::TileKey& key) {
    throw PlanetError(
        part.path() + ": tile " + lod::to_string(key) +
        " above it is another than in other parts: a source has changed under its name; build the "
        "parts again");
  }

  void copy_images() {
    std::int64_t total = 0;
    for (const auto& part : parts_) total += part->meta().image_tiles;
    const std::set<std::int64_t> stored = writer_.image_keys();
    stages_.add_kept(static_cast<std::int64_t>(stored.size()));
    stages_.begin("image", total, 0.15);
    for (const auto& part : parts_) {
      for (const std::int64_t key : part->image_keys()) {
        if (!stored.contains(key)) writer_.put_image(*lod::unpack(key), part->image(key));
        stages_.advance();
      }
    }
  }

  // 2. Inner tiles above several parts, deepest first.
  void build_above() {
    BuildContext context{build_, meta_, *plan_, nullptr, writer_, meshers_, {}, std::move(nodes_)};
    std::vector<lod::TileKey> keys;
    for (const lod::TileKey& key : plan_->inner()) {
      if (above_.contains(key)) keys.push_back(key);
    }
    stages_.begin("meshing", static_cast<std::int64_t>(keys.size()), 0.05);
    for (std::size_t at = 0; at < keys.size();) {
      const std::size_t begin = at;
      while (at < keys.size() && keys[at].level == keys[begin].level) ++at;
      std::vector<Node> made(at - begin);
      vpe::base::parallel_for(made.size(), threads_, [&](std::size_t n) {
        const lod::TileKey& key = keys[begin + n];
        const auto stored = stored_above_.find(key);
        made[n] = stored != stored_above_.end() ? node_of(stored->second) : build_inner(context, key);
        stages_.advance();
      });
      for (std::size_t n = 0; n < made.size(); ++n) context.nodes.emplace(keys[begin + n], std::move(made[n]));
    }
    std::vector<NodeRow> rows;
    for (const lod::TileKey& key : keys) {
      if (checksum(lod::pack(key), writer_.mesh(key, 0)) != above_.at(key).mesh_checksum) {
        refuse(*parts_.front(), key);
      }
      lod::MeshVariant& mesh = context.nodes.at(key).variants.front();
      mesh.terms = above_.at(key).terms.mesh;
      context.nodes.at(key).posts_terms = above_.at(key).terms.posts;
      mesh_triangles_ += mesh.triangles;
    }
    nest_errors(context, keys);
    for (const lod::TileKey& key : keys) rows.push_back(to_row(key, context.nodes.at(key)));
    writer_.replace_nodes(rows);
  }

  BuildSummary finish() {
    std::vector<ResamplingSum> sums;
    meta_.tiles = static_cast<std::int64_t>(above_.size());
    meta_.leaf_tiles = meta_.image_tiles = 0;
    for (const auto& part : parts_) {
      const PlanetMeta& m = part->meta();
      meta_.tiles += m.tiles;
      meta_.leaf_tiles += m.leaf_tiles;
      meta_.image_tiles += m.image_tiles;
      meta_.lowest_radius_m = std::min(meta_.lowest_radius_m, m.lowest_radius_m);
      meta_.highest_radius_m = std::max(meta_.highest_radius_m, m.highest_radius_m);
      meta_.finest_level = std::max(meta_.finest_level, m.finest_level);
      meta_.finest_image_level = std::max(meta_.finest_image_level, m.finest_image_level);
      const std::vector<ResamplingSum>& own = m.share->resampling;
      sums.resize(std::max(sums.size(), own.size()));
      for (std::size_t n = 0; n < own.size(); ++n) sums[n].include(own[n]);
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
  std::vector<std::unique_ptr<ShardFile>> parts_;
  PlanetWriter writer_;
  Stages stages_;
  int threads_;
  PlanetMeta meta_;
  BuildOptions build_;  // what is left of them: the mesh ratio and the radius
  MesherPool meshers_;
  std::unique_ptr<BuildPlan> plan_;
  std::map<lod::TileKey, SharedAncestorTerms> above_;
  std::map<lod::TileKey, Node> nodes_;            // children of tiles above
  std::map<lod::TileKey, NodeRow> stored_above_;  // that an earlier, stopped merge made
  std::int64_t mesh_triangles_ = 0;
};

}  // namespace

BuildSummary merge_parts(const MergeOptions& options, const ProgressFunction& progress) {
  return Merge(options, progress).run();
}

}  // namespace paging
