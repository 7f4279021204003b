// The planet file *.vpe: one SQLite database, read-only once built. Layout in docs/planet-file.md.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "lod/tree/tree.h"
#include "paging/planet/codec.h"
#include "paging/planet/planet_meta.h"

namespace paging {

// Everything of a finest or inner tile but its meshes.
struct TileHeights {
  lod::Posts posts;                // borders constrained to coarser neighbours
  int coarser_neighbour_mask = 0;  // bit of each Edge across which a finest tile one level coarser lies
  std::vector<bool> nodata;        // empty when no post is missing
  std::vector<int> source;         // indices into PlanetMeta::sources that the tile draws on
};

// Puts the posts that lie on a coarser neighbour's edges onto these edges as exaggerated, so that S stays
// watertight: an edge's height grows with the exaggeration, its sag does not. Does nothing where steps is 0.
void put_on_coarser_edges(TileHeights& heights, double radius_m, double exaggeration);

struct ImageTile {
  std::vector<vpe::base::Rgb> texels;  // 257 * 257, row 0 at the south border (v0), column 0 at the west border
};

// Every const member may be called from any thread; each call borrows one of a pool of read connections.
class PlanetFile {
 public:
  // Opens and reads meta and the tile index. Throws PlanetError for a missing file, another kind of file, a
  // newer major format, an incomplete or damaged one.
  static std::shared_ptr<const PlanetFile> open(const std::string& path);
  ~PlanetFile();

  const std::string& path() const { return path_; }
  const PlanetMeta& meta() const { return meta_; }
  const lod::TileTree& tree() const { return *tree_; }
  double radius_m() const { return meta_.radius_m; }

  // Throw PlanetError with the tile's key when it is missing or damaged (checksum, codec).
  // With an exaggeration (> 0): the posts of S as drawn so many times as high; see put_on_coarser_edges().
  TileHeights heights(const lod::TileKey& key, double exaggeration = 1.0) const;
  PackedMesh mesh(const lod::TileKey& key, int variant) const;

  // Whether no source has data at some post of the tile or of one below it. Known without reading the tile.
  bool has_nodata(const lod::TileKey& key) const;

  // The deepest stored image tile at or above `key`; nothing when the planet has no image.
  std::optional<lod::TileKey> image_key(const lod::TileKey& key) const;
  std::vector<lod::TileKey> image_keys() const;    // all of them
  ImageTile image(const lod::TileKey& key) const;  // key must be one that image_key() returned

 private:
  struct Connection;
  class Borrowed;
  explicit PlanetFile(const std::string& path);
  void read_index(Connection& connection);

  std::string path_;
  PlanetMeta meta_;
  std::unique_ptr<lod::TileTree> tree_;
  std::vector<std::int64_t> image_keys_;   // sorted
  std::vector<std::int64_t> nodata_keys_;  // of tiles with posts without data and of all above them, sorted
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<Connection>> idle_;
};

}  // namespace paging
