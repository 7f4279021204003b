#include "paging/planet_writer.h"

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>

#ifndef VPE_VERSION
#define VPE_VERSION "0"
#endif

namespace paging {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kCommitBytes = std::size_t{64} << 20;

std::string fresh_part(const std::string& path) {
  const std::string part = path + ".part";
  std::error_code ignored;
  for (const char* suffix : {"", "-wal", "-shm", "-journal"}) fs::remove(part + suffix, ignored);
  return part;
}

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
        missing(db, "INSERT INTO missing VALUES(?, ?, ?)"),
        image(db, "INSERT INTO image VALUES(?, ?, ?)"),
        mesh(db, "INSERT INTO mesh VALUES(NULL, ?, ?, ?, ?)"),
        node(db, "INSERT INTO node VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"),
        variant(db, "INSERT INTO variant VALUES(?, ?, ?, ?, ?, ?)"),
        read_heights(db, "SELECT data FROM heights WHERE key = ?"),
        read_mesh(db, "SELECT data FROM mesh WHERE key = ? AND variant = ?") {}
  Statement heights;
  Statement missing;
  Statement image;
  Statement mesh;
  Statement node;
  Statement variant;
  Statement read_heights;
  Statement read_mesh;
};

PlanetWriter::PlanetWriter(const std::string& path)
    : path_(path), part_(fresh_part(path)), db_(std::make_unique<Database>(part_, Database::Mode::kCreate)) {
  db_->execute("PRAGMA page_size = 8192");
  db_->execute("PRAGMA journal_mode = OFF");
  db_->execute("PRAGMA synchronous = OFF");
  db_->execute("PRAGMA locking_mode = EXCLUSIVE");
  db_->execute("PRAGMA application_id = " + std::to_string(kApplicationId));
  db_->execute("PRAGMA user_version = " + std::to_string(kFormatMajor));
  db_->execute(kSchema);
  sql_ = std::make_unique<Statements>(*db_);
  db_->execute("BEGIN");
}

PlanetWriter::~PlanetWriter() {
  if (finished_) return;
  sql_.reset();
  db_.reset();
  std::error_code ignored;
  fs::remove(part_, ignored);
}

void PlanetWriter::commit_now_and_then() {
  if (bytes_since_commit_ < kCommitBytes) return;
  bytes_since_commit_ = 0;
  db_->execute("COMMIT");
  db_->execute("BEGIN");
}

void PlanetWriter::put(Statement& statement, const lod::TileKey& key, std::span<const std::uint8_t> packed) {
  const std::int64_t row = lod::pack(key);
  const std::lock_guard lock(mutex_);
  statement.bind(1, row).bind(2, checksum(row, packed)).bind(3, packed);
  statement.step();
  bytes_since_commit_ += packed.size();
  commit_now_and_then();
}

void PlanetWriter::put_heights(const lod::TileKey& key, std::span<const std::uint8_t> packed) {
  put(sql_->heights, key, packed);
}

void PlanetWriter::put_missing(const lod::TileKey& key, std::span<const std::uint8_t> packed) {
  put(sql_->missing, key, packed);
}

void PlanetWriter::put_image(const lod::TileKey& key, std::span<const std::uint8_t> packed) {
  put(sql_->image, key, packed);
}

void PlanetWriter::put_mesh(const lod::TileKey& key, int variant, std::span<const std::uint8_t> packed) {
  const std::int64_t row = lod::pack(key);
  const std::lock_guard lock(mutex_);
  sql_->mesh.bind(1, row)
      .bind(2, static_cast<std::int64_t>(variant))
      .bind(3, checksum(row + variant, packed))
      .bind(4, packed);
  sql_->mesh.step();
  bytes_since_commit_ += packed.size();
  commit_now_and_then();
}

void PlanetWriter::put_node(const NodeRow& row) {
  const auto key = lod::unpack(row.key);
  const std::lock_guard lock(mutex_);
  sql_->node.bind(1, row.key)
      .bind(2, static_cast<std::int64_t>(key->face))
      .bind(3, std::int64_t{key->level})
      .bind(4, std::int64_t{key->i})
      .bind(5, std::int64_t{key->j})
      .bind(6, row.min_m)
      .bind(7, row.max_m)
      .bind(8, row.slope)
      .bind(9, std::int64_t{row.inner})
      .bind(10, std::int64_t{row.steps})
      .bind(11, std::string_view(row.sources))
      .bind(12, checksum(row));
  sql_->node.step();
  std::int64_t number = 0;
  for (const lod::MeshVariant& v : row.variants) {
    sql_->variant.bind(1, row.key)
        .bind(2, number++)
        .bind(3, v.terms.relief_m)
        .bind(4, v.terms.sag_m)
        .bind(5, v.terms.total_m)
        .bind(6, std::int64_t{v.triangles});
    sql_->variant.step();
  }
}

Bytes PlanetWriter::read(Statement& statement, const lod::TileKey& key) {
  if (!statement.step()) db_->fail("read back tile " + lod::to_string(key));
  const auto data = statement.blob(0);
  Bytes out(data.begin(), data.end());
  statement.reset();
  return out;
}

Bytes PlanetWriter::heights(const lod::TileKey& key) {
  const std::lock_guard lock(mutex_);
  sql_->read_heights.bind(1, lod::pack(key));
  return read(sql_->read_heights, key);
}

Bytes PlanetWriter::mesh(const lod::TileKey& key, int variant) {
  const std::lock_guard lock(mutex_);
  sql_->read_mesh.bind(1, lod::pack(key)).bind(2, std::int64_t{variant});
  return read(sql_->read_mesh, key);
}

std::string PlanetWriter::identity() {
  // In key order, so that the order in which threads finished does not show.
  Bytes all;
  for (const char* table : {"node", "heights", "missing", "image"}) {
    Statement rows(*db_, std::string("SELECT checksum FROM ") + table + " ORDER BY key");
    while (rows.step()) {
      const auto sum = static_cast<std::uint64_t>(rows.integer(0));
      for (int shift = 0; shift < 64; shift += 8) all.push_back(static_cast<std::uint8_t>(sum >> shift));
    }
  }
  Statement rows(*db_, "SELECT checksum FROM mesh ORDER BY key, variant");
  while (rows.step()) {
    const auto sum = static_cast<std::uint64_t>(rows.integer(0));
    for (int shift = 0; shift < 64; shift += 8) all.push_back(static_cast<std::uint8_t>(sum >> shift));
  }
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(checksum(kApplicationId, all)));
  return text;
}

void PlanetWriter::seal(PlanetMeta& meta) {
  const std::lock_guard lock(mutex_);
  meta.identity = identity();
  meta.program = VPE_VERSION;
  write_meta(*db_, meta);
  db_->execute("COMMIT");
  sql_.reset();
  db_.reset();
}

void PlanetWriter::publish(const PlanetMeta& meta) {
  {
    Database db(part_, Database::Mode::kCreate);
    db.execute("BEGIN");
    db.execute("DELETE FROM meta");
    write_meta(db, meta);
    db.execute("COMMIT");
  }
  sync_to_disk(part_);
  std::error_code error;
  fs::rename(part_, path_, error);
  if (error) {
    throw DatabaseError(path_ + ": cannot rename the finished " + part_ + ": " + error.message());
  }
  finished_ = true;
}

}  // namespace paging
