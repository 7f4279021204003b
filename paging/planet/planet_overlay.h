// Tiles that lie over those of a planet file. Included by the files that implement PlanetFile alone.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <unordered_map>
#include <vector>

#include "lod/tree/tile_key.h"
#include "paging/planet/tile_patch.h"

namespace paging {

// Holds the patched tiles of a planet, those of patches under it included. Immutable once it is shared: any thread may
// read it.
class PlanetOverlay {
 public:
  // Holds a tile with the patch that owns it.
  struct Tile {
    std::shared_ptr<const TilePatch> patch;
    const PatchTile* tile = nullptr;
    std::uint64_t version = 0;
    std::vector<int> source_numbers = {};  // by number in the tile's row; empty: the same
  };
  struct Image {
    std::shared_ptr<const TilePatch> patch;
    const PatchImage* image = nullptr;
    std::uint64_t version = 0;
  };
  // Holds where the patch of a version changed the reference surface.
  struct Change {
    std::uint64_t version = 0;
    mars::Cap cap;
  };

  // Lays a patch over what is there. Expects checked keys.
  void add(const std::shared_ptr<const TilePatch>& patch, std::uint64_t version);
  // Takes the versions of another overlay of the same file for all that is the same there, and `version` for all that is
  // not, whatever was there before: pages change from that overlay to this one, not from the planet under this one.
  void follow(const PlanetOverlay& former, std::uint64_t version);
  // Includes bounds of the radius of one of the planets that lie over each other.
  void include_radius(double lowest_m, double highest_m) {
    lowest_radius_m_ = std::min(lowest_radius_m_, lowest_m);
    highest_radius_m_ = std::max(highest_radius_m_, highest_m);
  }

  // Return the patched tile of a packed key, or null.
  const Tile* tile(std::int64_t row) const { return find(tiles_, row); }
  const Image* image(std::int64_t row) const { return find(images_, row); }
  // Returns the numbers in the planet's meta of the sources that a tile names, by the number that is stored of it.
  // Empty: the same numbers.
  const std::vector<int>& source_numbers(std::int64_t row) const {
    const Tile* patched = tile(row);
    return patched != nullptr ? patched->source_numbers : source_numbers_;
  }
  // Return the version with which the tile or image tile of a packed key changed last, also back to that of the file; 0: it
  // never did.
  std::uint64_t tile_version(std::int64_t row) const { return version_of(tiles_, returned_tiles_, row); }
  std::uint64_t image_version(std::int64_t row) const { return version_of(images_, returned_images_, row); }
  // Return the version of the last patch with tiles, or image tiles, of this key or below it; 0: none.
  std::uint64_t tiles_below(std::int64_t row) const { return version_of(tiles_below_, row); }
  std::uint64_t images_below(std::int64_t row) const { return version_of(images_below_, row); }
  // Returns the same of tiles that touch one of the key's edges.
  std::uint64_t tiles_along(std::int64_t row, lod::Edge edge) const {
    const EdgeVersions* found = find(tiles_along_, row);
    return found == nullptr ? 0 : (*found)[static_cast<std::size_t>(edge)];
  }
  // Returns true if some image tiles have become those of the file again.
  bool has_returned_images() const { return !returned_images_.empty(); }
  // Returns the version of the last patch that changed ground from which, or to which, a place in a cap may be
  // seen; 0: none. `lift_m`: height of places above the ground.
  std::uint64_t seen_from(const mars::Cap& cap, double lift_m) const;

 private:
  using Versions = std::unordered_map<std::int64_t, std::uint64_t>;
  using EdgeVersions = std::array<std::uint64_t, 4>;  // by lod::Edge
  template <class Map>
  static const typename Map::mapped_type* find(const Map& map, std::int64_t row) {
    const auto at = map.find(row);
    return at == map.end() ? nullptr : &at->second;
  }
  static std::uint64_t version_of(const Versions& versions, std::int64_t row) {
    const std::uint64_t* found = find(versions, row);
    return found == nullptr ? 0 : *found;
  }
  template <class Map>
  static std::uint64_t version_of(const Map& map, const Versions& returned, std::int64_t row) {
    const auto* found = find(map, row);
    return found == nullptr ? version_of(returned, row) : found->version;
  }
  // Marks a tile of the patch as changed, for all above it.
  void mark_tile(std::int64_t row, std::uint64_t version);
  void add_change(std::uint64_t version, const mars::Cap& cap);

  std::unordered_map<std::int64_t, Tile> tiles_;
  std::unordered_map<std::int64_t, Image> images_;
  // Hold the versions of what is the file's again.
  Versions returned_tiles_;
  Versions returned_images_;
  Versions tiles_below_;
  Versions images_below_;
  std::unordered_map<std::int64_t, EdgeVersions> tiles_along_;
  std::vector<Change> changes_;      // oldest first
  std::vector<int> source_numbers_;  // of tiles of the file
  double lowest_radius_m_ = std::numeric_limits<double>::infinity();
  double highest_radius_m_ = 0;
};

}  // namespace paging
