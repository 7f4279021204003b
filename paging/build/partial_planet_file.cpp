#include "paging/build/partial_planet_file.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <string_view>
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

void put_fingerprint(const Database& db, const std::string& fingerprint) {
  Statement(db, "INSERT INTO recipe VALUES(?)").bind(1, std::string_view(fingerprint)).step();
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

constexpr std::size_t kDatabaseHeaderBytes = 100;

std::string first_bytes(const std::string& path) {
  std::string bytes(kDatabaseHeaderBytes, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(file.gcount()));
  return bytes;
}

bool holds_only_zeros(std::string_view bytes) {
  return std::all_of(bytes.begin(), bytes.end(), [](char c) { return c == '\0'; });
}

// Returns true if SQLite may have written the journal. One that was not synced begins with zeros.
bool is_journal(const std::string& path) {
  constexpr std::string_view kMagic = "\xd9\xd5\x05\xf9\x20\xa1\x63\xd7";
  const std::string bytes = first_bytes(path);
  return bytes.empty() || bytes.starts_with(kMagic) || holds_only_zeros(bytes.substr(0, 12));
}

[[noreturn]] void refuse_foreign(const std::string& path, const std::string& part) {
  throw DatabaseError(path + ": cannot write '" + part +
                      "': a file of this name exists that is not an unfinished planet file of vpe; move it, or "
                      "give the planet file another name");
}

// Throws unless everything at `path`, and beside it where SQLite would remove it, is this program's.
void require_own_files(const std::string& path) {
  std::error_code error;
  const std::string journal = path + "-journal";
  const bool has_journal = fs::exists(journal, error);
  if (has_journal && !is_journal(journal)) refuse_foreign(journal, path);
  if (fs::exists(path, error)) {
    if (!fs::is_regular_file(path, error)) refuse_foreign(path, path);
    if (!std::ifstream(path, std::ios::binary)) {
      throw DatabaseError(path +
                              ": cannot read the unfinished planet file; change its permissions, or give the "
                              "planet file another name",
                          SQLITE_CANTOPEN);
    }
    const std::string bytes = first_bytes(path);
    // Before its first commit a killed build leaves an empty file, or later pages and the journal that undoes
    // them.
    const bool may_be_undone = bytes.empty() || (has_journal && holds_only_zeros(bytes));
    if (!may_be_undone && !is_planet_file(path)) refuse_foreign(path, path);
    if (!bytes.empty()) return;  // side files of a database of ours are SQLite's
  }
  // SQLite removes these beside an empty database.
  for (const char* suffix : {"-wal", "-shm"}) {
    if (fs::exists(path + suffix, error)) refuse_foreign(path + suffix, path);
  }
}

// Returns true for errors that say what the file holds, in contrast to what the disk, the permissions, the
// memory or another process allow.
bool tells_of_content(const DatabaseError& error) {
  return error.code() == SQLITE_CORRUPT || error.code() == SQLITE_NOTADB || error.code() == SQLITE_ERROR ||
         error.code() == SQLITE_SCHEMA || error.code() == SQLITE_FORMAT;
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
    if (!tells_of_content(e)) throw;
    return {nullptr, PartialFileStart::kReplaced, false};  // damaged
  }
}

// Removes tiles of layers that the patch drops, and gives those that stay their new numbers. These are not less than the old
// ones, so the highest goes first.
void take_layers(Database& db, const PatchStart& patch) {
  Statement remove(db, "DELETE FROM image_layer WHERE layer = ? AND key = ?");
  for (const LayerTileKey& key : patch.dropped_layer_tiles) remove.bind(1, key.layer).bind(2, key.key).step();
  Statement renumber(db, "UPDATE image_layer SET layer = ? WHERE layer = ?");
  for (std::size_t n = patch.layer_numbers.size(); n-- > 0;) {
    if (patch.layer_numbers[n] != static_cast<int>(n))
      renumber.bind(1, std::int64_t{patch.layer_numbers[n]}).bind(2, static_cast<std::int64_t>(n)).step();
  }
}

// Makes the partial file a copy of a finished planet file, without what the patch drops.
std::unique_ptr<Database> copy_finished(const std::string& path, const PatchStart& patch) {
  std::error_code error;
  if (fs::copy_file(patch.path, path, error); !error)
    fs::permissions(path, fs::perms::owner_read | fs::perms::owner_write, fs::perm_options::add, error);
  if (error) {
    throw DatabaseError(path + ": cannot copy " + patch.path + " there: " + error.message() +
                        "; it needs as much space as that file: free some, or give another folder");
  }
  auto db = open_exclusively(path);
  db->execute(kPartialTables);
  if (!is_intact(*db)) {
    throw PlanetError(patch.path +
                      ": cannot be patched: it is damaged ('vpe verify' says where); build the planet again");
  }
  for (const char* table :
       {"node", "variant", "posts_error", "heights", "missing", "origin", "mesh", "resampling"}) {
    Statement remove(*db, std::string("DELETE FROM ") + table + " WHERE key = ?");
    for (const std::int64_t key : patch.dropped) remove.bind(1, key).step();
  }
  Statement remove_image(*db, "DELETE FROM image WHERE key = ?");
  for (const std::int64_t key : patch.dropped_images) remove_image.bind(1, key).step();
  if (has_table(*db, "image_layer")) take_layers(*db, patch);
  db->execute("DELETE FROM meta");
  return db;
}

}  // namespace

// Damage is not repaired: neither a killed build nor a sudden power loss leaves any, and a disk that changes bits
// cannot be relied on.
bool is_intact(Database& db) {
  check_schema(db);
  Statement check(db, "PRAGMA integrity_check(1)");
  if (!check.step() || check.text(0) != "ok") return false;
  for (const char* sql :
       {"SELECT key, 0, checksum, data FROM heights", "SELECT key, 0, checksum, data FROM missing",
        "SELECT key, 0, checksum, data FROM origin", "SELECT key, variant, checksum, data FROM mesh",
        "SELECT key, 0, checksum, data FROM image", "SELECT number, 0, checksum, data FROM note"}) {
    if (!rows_are_intact(db, sql)) return false;
  }
  if (has_table(db, "image_layer") && !rows_are_intact(db, "SELECT key, 0, checksum, data FROM image_layer"))
    return false;
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

PartialPlanetFile open_partial_file(const std::string& path, const std::string& fingerprint,
                                    const PatchStart* patch) {
  require_own_files(path);
  try {
    PartialPlanetFile partial;
    if (fs::exists(path)) {
      partial = continue_partial_file(path, fingerprint);
      if (partial.db) return partial;
    }
    remove_partial_file(path);
    if (patch != nullptr) {
      try {
        partial.db = copy_finished(path, *patch);
      } catch (...) {
        remove_partial_file(path);
        throw;
      }
      if (partial.start == PartialFileStart::kNew) partial.start = PartialFileStart::kPatched;
      put_fingerprint(*partial.db, fingerprint);
      return partial;
    }
    partial.db = open_exclusively(path);
    partial.db->execute("PRAGMA application_id = " + std::to_string(kApplicationId));
    partial.db->execute("PRAGMA user_version = " + std::to_string(kFormatMajor));
    partial.db->execute(kSchema);
    partial.db->execute(kPartialTables);
    put_fingerprint(*partial.db, fingerprint);
    return partial;
  } catch (const DatabaseError& e) {
    if (e.busy()) {
      throw DatabaseError(path + ": another build is writing it; wait for it, or give another output name",
                          e.code());
    }
    // Nothing was committed: an empty file would seem to be work that can be continued.
    std::error_code error;
    if (fs::file_size(path, error) == 0 && !error) remove_partial_file(path);
    throw;
  }
}

void remove_partial_file(const std::string& path) {
  std::error_code ignored;
  // Only older versions left the last two.
  for (const char* suffix : {"", "-journal", "-wal", "-shm"}) fs::remove(path + suffix, ignored);
}

}  // namespace paging
