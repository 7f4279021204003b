// NAME.vpe.part: a planet file on its way, which a later build can continue.
#pragma once

#include <memory>
#include <string>

#include "paging/planet/sqlite.h"

namespace paging {

// What became of a part that was there.
enum class PartialFileStart {
  kNew,        // there was none, or none of it had been committed
  kContinued,  // it had the same recipe: its tiles are kept
  kReplaced,   // it had another one, or was damaged: removed
};

struct PartialPlanetFile {
  std::unique_ptr<Database> db;  // with a transaction open that nobody else can write beside
  PartialFileStart start = PartialFileStart::kNew;
  bool holds_tiles = false;
};

// Opens the part at `path` for continuing, or makes a new one, with the tables of a planet file, `recipe` and
// `note`. Only a part with the same recipe, all of it sound, is continued; the check reads the whole of it.
// Throws DatabaseError; its busy() is true while another build is at work on the part.
PartialPlanetFile open_partial_file(const std::string& path, const std::string& fingerprint);

// Removes it and what SQLite keeps beside it.
void remove_partial_file(const std::string& path);

// SQL that leaves only what a finished planet file has.
extern const char* const kDropPartialTables;
// SQL that leaves what a file with PlanetMeta::share has besides: the recipe, and notes with numbers below 0.
extern const char* const kKeepShardTables;

}  // namespace paging
