// NAME.vpe.part: an incomplete planet file that a later build can resume.
//
// Besides the tables of a planet file it has two of its own. Their names in the file differ from the names in
// the code: the table `recipe` holds the build fingerprint, and each row of the table `note` is a checkpoint,
// a result of an intermediate step with its number.
#pragma once

#include <memory>
#include <string>

#include "paging/build/patch_start.h"
#include "paging/planet/sqlite.h"

namespace paging {

// States what became of a partial file that existed.
enum class PartialFileStart {
  kNew,        // none existed, or nothing of it had been committed
  kContinued,  // its fingerprint is the same: its tiles are kept
  kReplaced,   // its fingerprint is another, or it was damaged: removed
  kPatched,    // it begins with the tiles of a finished planet file
};

struct PartialPlanetFile {
  std::unique_ptr<Database> db;  // in an open transaction that excludes all other writers
  PartialFileStart start = PartialFileStart::kNew;
  bool holds_tiles = false;
};

// Opens the partial file at `path` to continue it, or makes a new one with the tables of a planet file, the
// fingerprint and the table of checkpoints. Continues only a file with the same fingerprint that is undamaged;
// the check reads the whole of it. Replaces one that is damaged or has another fingerprint. Throws
// DatabaseError and leaves the file as it is in all other cases: it cannot be read or written, the disk is
// full, or a file of another program has this name or that of a journal beside it; busy() is true while another
// build writes the file.
//
// With `patch`, a new one begins as a copy of that finished planet file without the tiles that the patch drops; nothing
// of it is committed yet. Throws PlanetError if the finished file is damaged.
PartialPlanetFile open_partial_file(const std::string& path, const std::string& fingerprint,
                                    const PatchStart* patch = nullptr);

// Returns whether every row of a partial file or shard is as it was written, and every tile has all of its rows.
// Throws PlanetError, DatabaseError.
bool is_intact(Database& db);

// Removes the file and what SQLite keeps beside it. They must be this program's.
void remove_partial_file(const std::string& path);

// SQL that lets a connection write files of up to 35 TB; SQLite's own limit is a quarter of that.
extern const char* const kRaisePageLimit;
// SQL that leaves only what a finished planet file has.
extern const char* const kDropPartialTables;
// SQL that leaves what a shard has besides: the fingerprint, and checkpoints with numbers below 0.
extern const char* const kKeepShardTables;

}  // namespace paging
