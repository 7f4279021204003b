#include "paging/build/shard_file.h"

#include <filesystem>

#include "paging/build/build_inputs.h"
#include "paging/planet/planet_database.h"

namespace paging {

std::optional<BuildSummary> finished_shard(const BuildOptions& options, const PlanetMeta& described) {
  std::error_code none;
  if (!std::filesystem::exists(options.output, none)) return std::nullopt;
  try {
    Database db = open_planet_database(options.output);
    Statement fingerprint(db, "SELECT text FROM recipe");
    if (!fingerprint.step() || fingerprint.text(0) != build_fingerprint(options, described))
      return std::nullopt;
    BuildSummary summary;
    summary.meta = from_rows(read_meta_rows(db), options.output);
    if (!is_intact(db) || content_identity(db) != summary.meta.identity) return std::nullopt;
    summary.bytes = static_cast<std::int64_t>(std::filesystem::file_size(options.output));
    summary.posts = summary.meta.leaf_tiles * summary.meta.tile.post_count();
    summary.mesh_triangles = db.integer("SELECT sum(triangles) FROM variant");
    summary.kept = summary.meta.tiles + summary.meta.image_tiles;
    for (const ImageLayer& layer : summary.meta.image_layers) summary.kept += layer.tiles;
    summary.is_kept_whole = true;
    return summary;
  } catch (const PlanetError&) {
    return std::nullopt;  // damaged, as below: it is built again
  } catch (const DatabaseError&) {
    return std::nullopt;
  }
}

ShardFile::ShardFile(const std::string& path) : path_(path) {
  std::error_code none;
  if (!std::filesystem::exists(path, none)) {
    throw PlanetError(path + ": no such file; make it with 'vpe build ... --part k/n'");
  }
  try {
    db_ = std::make_unique<Database>(open_planet_database(path));
    const std::map<std::string, std::string> rows = read_meta_rows(*db_);
    if (rows.empty()) {
      throw PlanetError(path + ": a build that has not ended; run it again to continue it");
    }
    meta_ = from_rows(rows, path);
    if (!meta_.shard) throw PlanetError(path + ": a whole planet, not a part of one; leave it out");
    Statement fingerprint(*db_, "SELECT text FROM recipe");
    if (fingerprint.step()) fingerprint_ = fingerprint.text(0);
    const std::string line = fingerprint_line(id());
    if (!fingerprint_.ends_with(line)) damaged("its build fingerprint is that of another part");
    fingerprint_.resize(fingerprint_.size() - line.size());
    fingerprint_ = portable_fingerprint(fingerprint_);
    heights_ = std::make_unique<Statement>(*db_, "SELECT checksum, data FROM heights WHERE key = ?");
    nodata_ = std::make_unique<Statement>(*db_, "SELECT checksum, data FROM missing WHERE key = ?");
    if (has_table(*db_, "origin"))
      origin_ = std::make_unique<Statement>(*db_, "SELECT checksum, data FROM origin WHERE key = ?");
    mesh_ = std::make_unique<Statement>(*db_, "SELECT checksum, data FROM mesh WHERE key = ? AND variant = ?");
    image_ = std::make_unique<Statement>(*db_, "SELECT checksum, data FROM image WHERE key = ?");
    if (!meta_.image_layers.empty()) {
      layer_ = std::make_unique<Statement>(
          *db_, "SELECT checksum, data FROM image_layer WHERE layer = ? AND key = ?");
    }
    if (content_identity(*db_) != meta_.identity) damaged("its rows differ from those that were written");
  } catch (const DatabaseError& e) {
    throw PlanetError(std::string(e.what()) + "; not a part of a planet, or damaged: build it again");
  }
}

void ShardFile::damaged(const std::string& what) const {
  throw PlanetError(path_ + ": damaged: " + what + "; remove it and build this part again");
}

std::vector<NodeRow> ShardFile::nodes() const {
  std::vector<NodeRow> rows;
  try {
    if (const auto bad = read_nodes(*db_, rows))
      damaged("the tile index is wrong at row " + std::to_string(*bad));
  } catch (const DatabaseError& e) {
    damaged(e.what());
  }
  return rows;
}

std::map<lod::TileKey, SharedAncestorTerms> ShardFile::shared_ancestors() const {
  try {
    Statement checkpoint(*db_, "SELECT checksum, data FROM note WHERE number = ?");
    return unpack_shared_ancestors(verified(checkpoint.bind(1, kSharedAncestorsCheckpoint),
                                            kSharedAncestorsCheckpoint, kSharedAncestorsCheckpoint,
                                            "checkpoint of shared ancestors"));
  } catch (const CodecError& e) {
    damaged(e.what());
  } catch (const DatabaseError& e) {
    damaged(e.what());
  }
}

Bytes ShardFile::verified(Statement& statement, std::int64_t key, std::int64_t seed, const char* what) const {
  const auto name = [&] {
    const auto tile = lod::unpack(key);
    return std::string(what) + (tile ? " of tile " + lod::to_string(*tile) : "");
  };
  try {
    if (!statement.step()) damaged("no " + name());
    const auto data = statement.blob(1);
    Bytes out(data.begin(), data.end());
    const bool intact = checksum(seed, out) == statement.integer(0);
    statement.reset();
    if (!intact) damaged("wrong checksum: " + name());
    return out;
  } catch (const DatabaseError& e) {
    damaged(name() + ": " + e.what());
  }
}

TilePayload ShardFile::payload(const NodeRow& row) {
  TilePayload payload;
  payload.heights = verified(heights_->bind(1, row.key), row.key, row.key, "heights");
  const auto optional = [&](Statement& statement, const char* what) {
    statement.bind(1, row.key);
    if (!statement.step()) return Bytes();
    statement.reset();
    return verified(statement.bind(1, row.key), row.key, row.key, what);
  };
  payload.nodata = optional(*nodata_, "nodata mask");
  if (origin_) payload.origin = optional(*origin_, "sources of the posts");
  // A finest tile's last variant is its full grid, without a mesh.
  const auto meshes = static_cast<std::int64_t>(row.variants.size()) - (row.inner ? 0 : 1);
  for (std::int64_t v = 0; v < meshes; ++v) {
    payload.meshes.push_back(verified(mesh_->bind(1, row.key).bind(2, v), row.key, row.key + v, "mesh"));
  }
  return payload;
}

std::vector<TileResampling> ShardFile::resampling() const {
  try {
    return read_resampling(*db_);
  } catch (const DatabaseError& e) {
    damaged(e.what());
  }
}

std::vector<std::int64_t> ShardFile::image_keys() const {
  std::vector<std::int64_t> keys;
  Statement rows(*db_, "SELECT key FROM image ORDER BY key");
  while (rows.step()) keys.push_back(rows.integer(0));
  return keys;
}

std::vector<LayerTileKey> ShardFile::layer_keys() const {
  std::vector<LayerTileKey> keys;
  if (meta_.image_layers.empty()) return keys;
  Statement rows(*db_, "SELECT layer, key FROM image_layer ORDER BY layer, key");
  while (rows.step()) keys.push_back({rows.integer(0), rows.integer(1)});
  for (const LayerTileKey& at : keys) {
    if (at.layer < 0 || at.layer >= static_cast<std::int64_t>(meta_.image_layers.size()) ||
        !lod::unpack(at.key))
      damaged("a tile of an image layer that does not exist");
  }
  return keys;
}

Bytes ShardFile::layer_tile(const LayerTileKey& at) {
  return verified(layer_->bind(1, at.layer).bind(2, at.key), at.key, at.key, "image layer");
}

Bytes ShardFile::image(std::int64_t key) { return verified(image_->bind(1, key), key, key, "image"); }

}  // namespace paging
