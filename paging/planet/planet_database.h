// Planet files and shards as databases. Anybody may have written them, so what SQLite would run while their
// tables are read is checked first.
//
// Typical usage:
//   Database db = open_planet_database("mars.vpe");
//   const std::map<std::string, std::string> rows = read_meta_rows(db);
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "paging/planet/sqlite.h"

namespace paging {

// Opens a planet file or a shard for reading. Throws PlanetError if the database is not one of vpe, or if it
// fails check_schema(); DatabaseError if SQLite cannot read it.
Database open_planet_database(const std::string& path);

// Throws PlanetError if a name of the format belongs to anything but an ordinary table: a view or a virtual
// table may never end, as may a computed column. Triggers are refused too. Throws DatabaseError.
void check_schema(const Database& db);

// Returns whether the database has a table. Files of older minor formats do not have all of them. Throws
// DatabaseError.
bool has_table(const Database& db, std::string_view name);

// Returns the rows of the table `meta`. Throws PlanetError if there are more than any writer makes;
// DatabaseError.
std::map<std::string, std::string> read_meta_rows(const Database& db);

// Returns true if the file begins as a planet file or a shard does: SQLite's header with vpe's application_id.
// Returns false for a file that cannot be read.
bool is_planet_database(const std::string& path);

}  // namespace paging
