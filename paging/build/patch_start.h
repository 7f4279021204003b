// The start of a build from a finished planet file whose sources have changed in places.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "paging/plan/build_plan.h"
#include "paging/plan/kept_tiles.h"
#include "paging/planet/planet_meta.h"

namespace paging {

// Describes a finished planet file and where the planet to be built differs from it.
struct PatchedPlanet {
  std::string path;
  ChangedIn elevation_changes;
  ChangedIn image_changes;
};

// Holds what a finished planet file says of its tiles.
struct FinishedPlanet {
  std::string path;
  PlanetMeta meta;
  std::vector<NodeRow> rows;
  std::set<std::int64_t> with_nodata;  // packed keys of tiles with nodata posts
  std::set<std::int64_t> images;       // packed keys of image tiles
};

// Reads the index of a finished planet file. Throws PlanetError when it is damaged, DatabaseError.
FinishedPlanet read_finished(const std::string& path);

// Holds what becomes of the tiles of a finished planet file when a build begins with them.
struct PatchStart {
  std::string path;      // of the finished planet file
  std::string identity;  // of its content
  std::set<lod::TileKey> kept;
  std::vector<std::int64_t> dropped;         // packed keys of tiles that are made again, or no more
  std::vector<std::int64_t> dropped_images;  // the same of image tiles
  std::vector<int> source_numbers;           // number in the new planet of each elevation source of the file
};

// Compares a finished planet file with the planet to be built. `images` are the planned image tiles. Throws
// PlanetError when the file does not tell how it was built (format 1.3 and older), is a shard, or was
// built by another version, with other options or from other sources than the planet's, of which there may be more.
PatchStart plan_patch(const FinishedPlanet& finished, const PatchedPlanet& patched, const PlanetMeta& meta,
                      const BuildPlan& plan, const std::vector<lod::TileKey>& images);

}  // namespace paging
