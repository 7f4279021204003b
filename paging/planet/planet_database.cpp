#include "paging/planet/planet_database.h"

#include <array>
#include <cstring>
#include <fstream>

#include "paging/planet/planet_meta.h"

namespace paging {

namespace {

constexpr std::size_t kMaxMetaRows = 10'000;

constexpr const char* kNamesOfTheFormat =
    "('meta', 'node', 'variant', 'posts_error', 'heights', 'missing', 'origin', 'resampling', 'mesh', 'image', "
    "'image_layer', 'recipe', 'note')";

[[noreturn]] void refuse_schema(const Database& db, const std::string& what) {
  throw PlanetError(db.path() + ": damaged or forged: " + what + "; build the planet file again");
}

}  // namespace

Database open_planet_database(const std::string& path) {
  Database db(path, Database::Mode::kReadOnly);
  if (db.integer("PRAGMA application_id") != kApplicationId) {
    throw PlanetError(path + ": an SQLite database, but not a planet file of vpe");
  }
  check_schema(db);
  return db;
}

void check_schema(const Database& db) {
  const std::string names = kNamesOfTheFormat;
  Statement objects(db, "SELECT type, name FROM sqlite_schema WHERE type = 'trigger' OR (lower(name) IN " +
                            names + " AND (type <> 'table' OR coalesce(rootpage, 0) <= 0)) LIMIT 1");
  if (objects.step()) {
    refuse_schema(db, "'" + objects.text(1) + "' is a " +
                          (objects.text(0) == "table" ? "virtual table" : objects.text(0)) +
                          " where planet files have a table");
  }
  Statement columns(db,
                    "SELECT t.name, c.name FROM sqlite_schema AS t, pragma_table_xinfo(t.name) AS c "
                    "WHERE t.type = 'table' AND c.hidden <> 0 AND lower(t.name) IN " +
                        names + " LIMIT 1");
  if (columns.step()) {
    refuse_schema(db, "the column '" + columns.text(1) + "' of the table '" + columns.text(0) +
                          "' is computed where planet files store it");
  }
}

bool has_table(const Database& db, std::string_view name) {
  Statement known(db, "SELECT 1 FROM sqlite_schema WHERE type = 'table' AND name = ?");
  return known.bind(1, name).step();
}

std::map<std::string, std::string> read_meta_rows(const Database& db) {
  std::map<std::string, std::string> rows;
  Statement all(db, "SELECT key, value FROM meta");
  while (all.step()) {
    if (rows.size() == kMaxMetaRows) refuse_schema(db, "the table meta has too many rows");
    rows[all.text(0)] = all.text(1);
  }
  return rows;
}

bool is_planet_database(const std::string& path) {
  constexpr std::size_t kIdAt = 68;  // SQLite, "Database file format", 1.3: four bytes, the highest first
  std::array<unsigned char, kIdAt + 4> head{};
  std::ifstream file(path, std::ios::binary);
  if (!file.read(reinterpret_cast<char*>(head.data()), head.size())) return false;
  std::int64_t id = 0;
  for (std::size_t n = 0; n < 4; ++n) id = id << 8 | head[kIdAt + n];
  return std::memcmp(head.data(), "SQLite format 3", 16) == 0 && id == kApplicationId;
}

}  // namespace paging
