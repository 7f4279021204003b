#include "paging/build/partial_planet_file.h"

#include <filesystem>
#include <vector>

#include "paging/planet/codec.h"
#include "paging/planet/planet_database.h"
#include "paging/planet/planet_meta.h"

namespace paging {

namespace fs = std::filesystem;

const char* const kRaisePageLimit = "PRAGMA max_page_count = 4294967294";
const char* const kDropPartialTables = "DROP TABLE IF EXISTS recipe; DROP TABLE IF EXISTS note";
const char* const kKeepShardTables = "DELETE FROM note WHERE number >= 0";

namespace {

constexpr const char* kPartialTables =
    "CREATE TABLE recipe(text TEXT NOT NULL);"
    "CREATE TABLE note(number INTEGER PRIMARY KEY, checksum INTEGER NOT NULL, data BLOB NOT NULL)";

std::unique_ptr<Database> open_exclusively(const std::string& path) {
  auto db = std::make_unique<Database>(path, Database::Mode::kCreate);
  db->execute("PRAGMA page_size = 8192");
  db->execute(kRaisePageLimit);
  // New pages need no rollback: the journal costs little here, and a killed build leaves whole transactions.
  db->execute("PRAGMA journal_mode = TRUNCATE");
  db->execute("PRAGMA synchronous = NORMAL");
  db->execute("PRAGMA locking_mode = EXCLUSIVE");
  db->execute("BEGIN EXCLUSIVE");
  return db;
}

bool has_fingerprint(Database& db, const std::string& fingerprint) {
  if (db.integer("PRAGMA application_id") != kApplicationId) return false;
  Statement text(db, "SELECT text FROM recipe");
  return text.step() && text.text(0) == fingerprint;
}

// Returns whether all rows match their checksums. `sql` selects a key, what is added to it as a seed,
// checksum, data.
bool rows_are_intact(const Database& db, const char* sql) {
  Statement rows(db, sql);
  while (rows.step()) {
    if (checksum(rows.integer(0) + rows.integer(1), rows.blob(3)) != rows.integer(2)) return false;
  }
  return true;
}

// Returns whether every row is as it was written, and every tile has all of its rows. Damage is not repaired:
// neither a killed build nor a sudden power loss leaves any, and a disk that changes bits cannot be relied on.
bool is_intact(Database& db) {
  check_schema(db);
  Statement check(db, "PRAGMA integrity_check(1)");
  if (!check.step() || check.text(0) != "ok") return false;
  for (const char* sql :
       {"SELECT key, 0, checksum, data FROM heights", "SELECT key, 0, checksum, data FROM missing",
        "SELECT key, variant, checksum, data FROM mesh", "SELECT key, 0, checksum, data FROM image",
        "SELECT number, 0, checksum, data FROM note"}) {
    if (!rows_are_intact(db, sql)) return false;
  }
  std::vector<NodeRow> nodes;
  if (read_nodes(db, nodes)) return false;
  // A finest tile's last variant is its full grid, without a mesh.
  std::int64_t meshes = 0;
  std::int64_t variants = 0;
  for (const NodeRow& node : nodes) {
    variants += static_cast<std::int64_t>(node.variants.size());
    meshes += static_cast<std::int64_t>(node.variants.size()) - (node.inner ? 0 : 1);
  }
  return db.integer("SELECT count(*) FROM heights JOIN node USING (key)") ==
             static_cast<std::int64_t>(nodes.size()) &&
         db.integer("SELECT count(*) FROM heights") == static_cast<std::int64_t>(nodes.size()) &&
         db.integer("SELECT count(*) FROM mesh JOIN node USING (key)") == meshes &&
         db.integer("SELECT count(*) FROM mesh") == meshes &&
         db.integer("SELECT count(*) FROM variant") == variants;
}

// Continues the partial file at `path`; returns no database when it must be made again.
PartialPlanetFile continue_partial_file(const std::string& path, const std::string& fingerprint) {
  try {
    auto db = open_exclusively(path);
    // A build that ended before its first commit leaves what SQLite rolls back to: an empty file.
    if (db->integer("SELECT count(*) FROM sqlite_schema") == 0) return {};
    if (!has_fingerprint(*db, fingerprint) || !is_intact(*db))
      return {nullptr, PartialFileStart::kReplaced, false};
    db->execute("DELETE FROM meta");
    const bool holds_tiles = db->integer("SELECT count(*) FROM node") > 0;
    return {std::move(db), PartialFileStart::kContinued, holds_tiles};
  } catch (const DatabaseError& e) {
    if (e.busy()) {
      throw DatabaseError(path + ": another build is writing it; wait for it, or give another output name",
                          e.code());
    }
    return {nullptr, PartialFileStart::kReplaced, false};  // not a database, or too damaged to read
  }
}

}  // namespace

PartialPlanetFile open_partial_file(const std::string& path, const std::string& fingerprint) {
  PartialPlanetFile partial;
  if (fs::exists(path)) {
    partial = continue_partial_file(path, fingerprint);
    if (partial.db) return partial;
  }
  remove_partial_file(path);
  partial.db = open_exclusively(path);
  partial.db->execute("PRAGMA application_id = " + std::to_string(kApplicationId));
  partial.db->execute("PRAGMA user_version = " + std::to_string(kFormatMajor));
  partial.db->execute(kSchema);
  partial.db->execute(kPartialTables);
  Statement(*partial.db, "INSERT INTO recipe VALUES(?)").bind(1, std::string_view(fingerprint)).step();
  return partial;
}

void remove_partial_file(const std::string& path) {
  std::error_code ignored;
  // Only older versions left the last two.
  for (const char* suffix : {"", "-journal", "-wal", "-shm"}) fs::remove(path + suffix, ignored);
}

}  // namespace paging
