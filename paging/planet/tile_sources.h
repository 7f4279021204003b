// The source of the height of each post of a finest tile, and how far the tile is from the posts of its sources.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "paging/planet/codec.h"
#include "paging/planet/planet_summary.h"

namespace paging {

class Database;
class PlanetFile;

// Holds what a planet file knows of the sources of a finest tile.
struct TileSources {
  std::vector<int> of_tile;  // indices into PlanetMeta::sources, ascending
  // For each post 0 where no source has data, else n for of_tile[n - 1]. Empty when all posts with data have the
  // only source of the tile, and in files before format 1.3, where it is not known.
  std::vector<std::uint16_t> of_post;
  std::vector<SourceResampling> resampling;  // over the source posts in the tile

  // Returns the source of a post that has data, or nullopt if the file does not tell.
  std::optional<int> at(std::size_t post) const;
  std::size_t bytes() const;
};

// Packs the sources of a tile's posts, given as indices into PlanetMeta::sources with -1 for nodata. Returns no
// bytes if all posts with data have one source. `of_tile` must hold all indices, ascending.
Bytes encode_origin(std::span<const int> source_of_post, const std::vector<int>& of_tile);

// Holds one row of the table `resampling`: the error over the posts of a source in a finest tile.
struct TileResampling {
  std::int64_t key = 0;
  SourceResampling of;
};

// Returns the checksum of a row's canonical bytes.
std::int64_t checksum(const TileResampling& row);

// Reads the rows of a planet file or shard, in order of key and source; none before format 1.3. Throws
// PlanetError for a damaged row, DatabaseError.
std::vector<TileResampling> read_resampling(const Database& db);

// Returns what is wrong with the table `resampling` of a planet file, or an empty text. Throws as
// read_resampling() does.
std::string wrong_resampling(const PlanetFile& planet, const Database& db);

}  // namespace paging
