// The start of a build from a finished planet file whose sources have changed in places.
#pragma once

#include <compare>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "paging/plan/build_plan.h"
#include "paging/plan/kept_tiles.h"
#include "paging/planet/planet_meta.h"

namespace paging {

// Names a tile of an image layer: number of the layer in PlanetMeta::image_layers, and packed key.
struct LayerTileKey {
  std::int64_t layer = 0;
  std::int64_t key = 0;
  auto operator<=>(const LayerTileKey&) const = default;
};

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
  std::set<LayerTileKey> layer_tiles;  // of image layers
};

// Holds the tiles of the imagery of a planet to be built.
struct PlannedImages {
  const std::vector<lod::TileKey>& composed;
  const std::vector<std::vector<lod::TileKey>>& layers;  // by layer of the planet to be built
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
  std::vector<LayerTileKey> dropped_layer_tiles = {};  // with numbers of layers of the file
  std::vector<int> layer_numbers =
      {};  // number in the new planet of each layer of the file, ascending; empty: none is kept
};

// Compares a finished planet file with the planet to be built. Layers are the same if they have the same name. Throws
// PlanetError when the file does not tell how it was built (format 1.3 and older), is a shard, or was
// built by another version, with other options or from other sources than the planet's, of which there may be more.
PatchStart plan_patch(const FinishedPlanet& finished, const PatchedPlanet& patched, const PlanetMeta& meta,
                      const BuildPlan& plan, const PlannedImages& images);

}  // namespace paging
