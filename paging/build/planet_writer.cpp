#include "paging/build/planet_writer.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "paging/planet/planet_database.h"

#ifndef VPE_VERSION
#define VPE_VERSION "0"
#endif

namespace paging {

namespace fs = std::filesystem;

namespace {

void sync_to_disk(const std::string& path) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return;
  ::fsync(fd);
  ::close(fd);
}

void write_meta(const Database& db, const PlanetMeta& meta) {
  Statement insert(db, "INSERT INTO meta VALUES(?, ?)");
  for (const auto& [key, value] : to_rows(meta)) {
    insert.bind(1, std::string_view(key)).bind(2, std::string_view(value));
    insert.step();
  }
}

}  // namespace

struct PlanetWriter::Statements {
  explicit Statements(const Database& db)
      : heights(db, "INSERT INTO heights VALUES(?, ?, ?)"),
        nodata(db, "INSERT INTO missing VALUES(?, ?, ?)"),
        origin(db, "INSERT INTO origin VALUES(?, ?, ?)"),
        resampling(db, "INSERT OR REPLACE INTO resampling VALUES(?, ?, ?, ?, ?, ?)"),
        image(db, "INSERT INTO image VALUES(?, ?, ?)"),
        checkpoint(db, "INSERT OR REPLACE INTO note VALUES(?, ?, ?)"),
        mesh(db, "INSERT INTO mesh VALUES(NULL, ?, ?, ?, ?)"),
        node(db, "INSERT OR REPLACE INTO node VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"),
        variant(db, "INSERT OR REPLACE INTO variant VALUES(?, ?, ?, ?, ?, ?)"),
        posts_error(db, "INSERT OR REPLACE INTO posts_error VALUES(?, ?, ?, ?, ?)"),
        read_heights(db, "SELECT checksum, data FROM heights WHERE key = ?"),
        read_nodata(db, "SELECT checksum, data FROM missing WHERE key = ?"),
        read_mesh(db, "SELECT checksum, data FROM mesh WHERE key = ? AND variant = ?") {}
  Statement heights;
  Statement nodata;
  Statement origin;
  Statement resampling;
  Statement image;
  Statement checkpoint;
  Statement mesh;
  Statement node;
  Statement variant;
  Statement posts_error;
  Statement read_heights;
  Statement read_nodata;
  Statement read_mesh;
  std::optional<Statement> layer;  // once there are layers
};

PlanetWriter::PlanetWriter(const std::string& path, const std::string& fingerprint, double commit_s,
                           const PatchStart* patch)
    : path_(path),
      part_path_(path + ".part"),
      commit_every_(commit_s),
      partial_(open_partial_file(part_path_, fingerprint, patch)) {
  sql_ = std::make_unique<Statements>(*partial_.db);
  if (patch == nullptr || partial_.start == PartialFileStart::kContinued) return;
  try {
    renumber_sources(*patch);
    commit();
  } catch (...) {
    sql_.reset();
    partial_.db.reset();
    remove_partial_file(part_path_);
    throw;
  }
}

// Rows of kept tiles name sources by their numbers in the finished planet.
void PlanetWriter::renumber_sources(const PatchStart& patch) {
  std::vector<NodeRow> rows;
  if (read_nodes(*partial_.db, rows)) partial_.db->fail("read the tile index of " + patch.path);
  for (NodeRow& row : rows) {
    const std::string before = std::exchange(row.sources, {});
    const std::vector<int> numbers = source_indices(before).value();  // read_nodes() has checked it
    for (const int number : numbers) {
      if (!row.sources.empty()) row.sources.push_back(',');
      row.sources += std::to_string(patch.source_numbers.at(static_cast<std::size_t>(number)));
    }
    if (row.sources != before) put_node(row);
  }
  std::vector<TileResampling> errors = read_resampling(*partial_.db);
  partial_.db->execute("DELETE FROM resampling");
  for (TileResampling& row : errors) {
    row.of.source = patch.source_numbers.at(static_cast<std::size_t>(row.of.source));
    put_row(row);
  }
}

void PlanetWriter::put_row(const TileResampling& row) {
  sql_->resampling.bind(1, row.key)
      .bind(2, std::int64_t{row.of.source})
      .bind(3, row.of.error.posts)
      .bind(4, row.of.error.max_m)
      .bind(5, row.of.error.rms_m)
      .bind(6, checksum(row));
  sql_->resampling.step();
}

PlanetWriter::~PlanetWriter() {
  if (finished_) return;
  sql_.reset();
  if (partial_.db && uncommitted_ && !broken_ && !discarded_) {
    try {
      partial_.db->execute("COMMIT");
      partial_.holds_tiles = true;
    } catch (const DatabaseError&) {
      // For example on a full disk: SQLite has gone back to the last commit, or will when the file is opened.
    }
  }
  partial_.db.reset();
  if (!partial_.holds_tiles || discarded_) remove_partial_file(part_path_);
}

// An error may have undone the whole transaction (SQLite, "Response to errors within a transaction"), so
// nothing may follow it: a later row would be committed without those before it.
template <typename Puts>
void PlanetWriter::write(const Puts& puts) {
  const std::lock_guard lock(mutex_);
  if (broken_) throw DatabaseError(*broken_);
  try {
    puts();
    uncommitted_ = true;
    commit_when_due();
  } catch (const DatabaseError& e) {
    broken_ = std::make_unique<DatabaseError>(e);
    throw;
  }
}

void PlanetWriter::commit_when_due() {
  if (std::chrono::steady_clock::now() - last_commit_ >= commit_every_) commit();
}

void PlanetWriter::commit() {
  partial_.db->execute("COMMIT");
  partial_.holds_tiles = true;
  uncommitted_ = false;
  partial_.db->execute("BEGIN EXCLUSIVE");
  last_commit_ = std::chrono::steady_clock::now();
}

void PlanetWriter::put(Statement& statement, std::int64_t row, std::span<const std::uint8_t> packed) {
  statement.bind(1, row).bind(2, checksum(row, packed)).bind(3, packed);
  statement.step();
}

void PlanetWriter::put_tile(const NodeRow& row, const TilePayload& payload) {
  write([&] {
    put(sql_->heights, row.key, payload.heights);
    if (!payload.nodata.empty()) put(sql_->nodata, row.key, payload.nodata);
    if (!payload.origin.empty()) put(sql_->origin, row.key, payload.origin);
    std::int64_t variant = 0;
    for (const Bytes& packed : payload.meshes) {
      sql_->mesh.bind(1, row.key).bind(2, variant).bind(3, checksum(row.key + variant, packed)).bind(4, packed);
      sql_->mesh.step();
      ++variant;
    }
    put_node(row);
  });
}

void PlanetWriter::put_image(const lod::TileKey& key, std::span<const std::uint8_t> packed) {
  write([&] { put(sql_->image, lod::pack(key), packed); });
}

// Nothing is lost with the empty table, so that it alone is no work to keep.
void PlanetWriter::begin_layers() {
  const std::lock_guard lock(mutex_);
  if (!has_table(*partial_.db, "image_layer")) partial_.db->execute(kLayerSchema);
  sql_->layer.emplace(*partial_.db, "INSERT INTO image_layer VALUES(NULL, ?, ?, ?, ?)");
}

void PlanetWriter::put_layer_tile(const LayerTileKey& key, std::span<const std::uint8_t> packed) {
  write([&] {
    sql_->layer->bind(1, key.layer).bind(2, key.key).bind(3, checksum(key.key, packed)).bind(4, packed);
    sql_->layer->step();
  });
}

std::set<LayerTileKey> PlanetWriter::layer_keys() {
  const std::lock_guard lock(mutex_);
  std::set<LayerTileKey> keys;
  if (!has_table(*partial_.db, "image_layer")) return keys;
  Statement rows(*partial_.db, "SELECT layer, key FROM image_layer");
  while (rows.step()) keys.insert({rows.integer(0), rows.integer(1)});
  return keys;
}

void PlanetWriter::count_layers(std::vector<ImageLayer>& layers) {
  const std::lock_guard lock(mutex_);
  for (ImageLayer& layer : layers) {
    layer.finest_level = -1;
    layer.tiles = layer.bytes = 0;
  }
  if (layers.empty()) return;
  Statement rows(*partial_.db, "SELECT layer, key >> 54 & 31, length(data) FROM image_layer");
  while (rows.step()) {
    ImageLayer& layer = layers.at(static_cast<std::size_t>(rows.integer(0)));
    layer.finest_level = std::max(layer.finest_level, static_cast<int>(rows.integer(1)));
    ++layer.tiles;
    layer.bytes += rows.integer(2);
  }
}

void PlanetWriter::put_checkpoint(std::int64_t number, std::span<const std::uint8_t> packed) {
  write([&] { put(sql_->checkpoint, number, packed); });
}

void PlanetWriter::put_node(const NodeRow& row) {
  const auto key = lod::unpack(row.key);
  sql_->node.bind(1, row.key)
      .bind(2, static_cast<std::int64_t>(key->face))
      .bind(3, std::int64_t{key->level})
      .bind(4, std::int64_t{key->i})
      .bind(5, std::int64_t{key->j})
      .bind(6, row.min_m)
      .bind(7, row.max_m)
      .bind(8, row.slope)
      .bind(9, std::int64_t{row.inner})
      .bind(10, std::int64_t{row.coarser_neighbour_mask})
      .bind(11, std::string_view(row.sources))
      .bind(12, checksum(row));
  sql_->node.step();
  std::int64_t number = 0;
  for (const lod::MeshVariant& v : row.variants) {
    sql_->variant.bind(1, row.key)
        .bind(2, number++)
        .bind(3, v.terms.height_error_m)
        .bind(4, v.terms.sagitta_m)
        .bind(5, v.terms.total_m)
        .bind(6, std::int64_t{v.triangles});
    sql_->variant.step();
  }
  if (!row.posts_terms) return;
  sql_->posts_error.bind(1, row.key)
      .bind(2, row.posts_terms->height_error_m)
      .bind(3, row.posts_terms->sagitta_m)
      .bind(4, row.posts_terms->total_m)
      .bind(5, posts_checksum(row));
  sql_->posts_error.step();
}

void PlanetWriter::put_resampling(std::span<const TileResampling> rows) {
  write([&] {
    for (const TileResampling& row : rows) put_row(row);
  });
}

void PlanetWriter::replace_nodes(std::span<const NodeRow> rows) {
  write([&] {
    for (const NodeRow& row : rows) put_node(row);
  });
}

std::vector<NodeRow> PlanetWriter::nodes() {
  const std::lock_guard lock(mutex_);
  std::vector<NodeRow> rows;
  const auto bad = read_nodes(*partial_.db, rows);
  if (bad) {
    throw DatabaseError(part_path_ + ": the tile index is damaged at row " + std::to_string(*bad) +
                        "; remove this file, then build again");
  }
  return rows;
}

std::set<std::int64_t> PlanetWriter::image_keys() {
  const std::lock_guard lock(mutex_);
  std::set<std::int64_t> keys;
  Statement rows(*partial_.db, "SELECT key FROM image");
  while (rows.step()) keys.insert(rows.integer(0));
  return keys;
}

std::vector<LevelSummary> PlanetWriter::levels(std::size_t posts) {
  const std::lock_guard lock(mutex_);
  return summarize_levels(*partial_.db, posts);
}

std::vector<TileResampling> PlanetWriter::resampling() {
  const std::lock_guard lock(mutex_);
  return read_resampling(*partial_.db);
}

std::map<std::int64_t, Bytes> PlanetWriter::checkpoints() {
  const std::lock_guard lock(mutex_);
  std::map<std::int64_t, Bytes> out;
  Statement rows(*partial_.db, "SELECT number, data FROM note");
  while (rows.step()) {
    const auto data = rows.blob(1);
    out.emplace(rows.integer(0), Bytes(data.begin(), data.end()));
  }
  return out;
}

std::optional<Bytes> PlanetWriter::find(Statement& statement, const lod::TileKey& key, std::int64_t seed) {
  if (!statement.step()) {
    statement.reset();
    return std::nullopt;
  }
  const auto data = statement.blob(1);
  Bytes out(data.begin(), data.end());
  const bool intact = checksum(seed, out) == statement.integer(0);
  statement.reset();
  if (!intact) {
    throw DatabaseError(part_path_ + ": tile " + lod::to_string(key) +
                        " is damaged (wrong checksum); remove this file, then build again");
  }
  return out;
}

Bytes PlanetWriter::read(Statement& statement, const lod::TileKey& key, std::int64_t seed) {
  auto found = find(statement, key, seed);
  if (!found) partial_.db->fail("read back tile " + lod::to_string(key));
  return std::move(*found);
}

Bytes PlanetWriter::heights(const lod::TileKey& key) {
  const std::lock_guard lock(mutex_);
  sql_->read_heights.bind(1, lod::pack(key));
  return read(sql_->read_heights, key, lod::pack(key));
}

Bytes PlanetWriter::nodata(const lod::TileKey& key) {
  const std::lock_guard lock(mutex_);
  sql_->read_nodata.bind(1, lod::pack(key));
  return find(sql_->read_nodata, key, lod::pack(key)).value_or(Bytes());
}

Bytes PlanetWriter::mesh(const lod::TileKey& key, int variant) {
  const std::lock_guard lock(mutex_);
  sql_->read_mesh.bind(1, lod::pack(key)).bind(2, std::int64_t{variant});
  return read(sql_->read_mesh, key, lod::pack(key) + variant);
}

void PlanetWriter::seal(PlanetMeta& meta) {
  const std::lock_guard lock(mutex_);
  if (broken_) throw DatabaseError(*broken_);
  meta.identity = content_identity(*partial_.db);
  meta.program = VPE_VERSION;
  write_meta(*partial_.db, meta);
  partial_.db->execute("COMMIT");
  sql_.reset();
  partial_.db.reset();
}

void PlanetWriter::publish(const PlanetMeta& meta) {
  {
    Database db(part_path_, Database::Mode::kCreate);
    db.execute(kRaisePageLimit);
    db.execute("BEGIN");
    db.execute(meta.shard ? kKeepShardTables : kDropPartialTables);
    db.execute("DELETE FROM meta");
    write_meta(db, meta);
    db.execute("COMMIT");
  }
  sync_to_disk(part_path_);
  std::error_code error;
  fs::rename(part_path_, path_, error);
  if (error) {
    throw DatabaseError(path_ + ": cannot rename the finished " + part_path_ + ": " + error.message());
  }
  finished_ = true;
}

}  // namespace paging
