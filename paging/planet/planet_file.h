// The planet file *.vpe: one SQLite database, read-only once built. docs/design/planet-file.md describes its
// tables.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lod/tree/tree.h"
#include "paging/planet/codec.h"
#include "paging/planet/planet_meta.h"
#include "paging/planet/sqlite.h"
#include "paging/planet/tile_sources.h"
#include "paging/planet/tile_version.h"
#include "vpe/base/object_pool.h"
#include "vpe/core/appearance/image_layers.h"

namespace paging {

class PlanetOverlay;
struct PatchTile;
struct TilePatch;

// Holds what a planet file stores of a tile, except its meshes.
struct TileHeights {
  lod::Posts posts;                // borders constrained to coarser neighbours
  int coarser_neighbour_mask = 0;  // as NodeRow::coarser_neighbour_mask
  std::vector<bool> nodata;        // true where no source has data; empty when every post has data
  std::vector<int> source;         // indices into PlanetMeta::sources that the tile draws on
};

// Moves the posts on borders with coarser neighbours onto the edges of these neighbours as they are
// exaggerated, so that the reference surface stays watertight: the height of an edge grows with the
// exaggeration, its sagitta does not. Does nothing where coarser_neighbour_mask is 0.
void put_on_coarser_edges(TileHeights& heights, double radius_m, double exaggeration);

struct ImageTile {
  std::vector<vpe::base::Rgb> texels;  // 257 * 257, row 0 at the south border (v0), column 0 at the west border
};

// Reads a planet file. Every const member may be called from any thread; each call uses one of a pool of
// connections to the database. All of them read the planet that open() found: if another file has taken the
// path, or the file was written to, members that would need it throw PlanetError.
//
// Typical usage:
//   const std::shared_ptr<const PlanetFile> planet = PlanetFile::open("mars.vpe");
//   const lod::TileInfo& tile = planet->tree().deepest(lod::tile_at(mars::chart_point(direction), 8));
//   const TileHeights heights = planet->heights(tile.key);
class PlanetFile : public std::enable_shared_from_this<PlanetFile> {
 public:
  // Opens the file and reads meta and the tile index. Throws PlanetError for a file that does not exist, is of
  // another kind or of a newer major format, or is incomplete or damaged.
  // `before_read` is called on the reading thread before the heights, a mesh or an image of a tile are read. It
  // may wait, and may throw PlanetError in their place: for tests of slow and broken storage.
  using BeforeRead = std::function<void(const lod::TileKey& tile)>;
  static std::shared_ptr<const PlanetFile> open(const std::string& path, BeforeRead before_read = {});
  ~PlanetFile();

  // Returns the planet with a patch (tile_patch.h): it has the patch's tiles from memory and all others from this
  // planet's connections, and its tree, meta and identity are those of the whole. This planet stays as it is; a
  // patched planet can be patched again. Takes memory for the patch and for an index of all tiles. Throws PlanetError
  // with what is wrong with the patch: a tile twice, a missing or a stray child, an inner tile made a finest one,
  // payloads that are no tile's, errors that do not nest, a meta of other tiles or of another planet. Like an opened
  // file it may still have borders that do not meet, which verify() finds.
  //
  // `former` is the planet that was shown before, patched over the same file; null: this planet. Tiles and image tiles with
  // the same content in both keep their numbers (version()), so that pages of theirs serve on: for animations, whose patches
  // have most tiles in common. Planets over other files, or compared with another planet, share no numbers.
  std::shared_ptr<const PlanetFile> with(std::shared_ptr<const TilePatch> patch,
                                         const std::shared_ptr<const PlanetFile>& former = nullptr) const;
  bool is_patched() const { return overlay_ != nullptr; }
  // Returns whether a patch has changed what a page of the tile is made of, at any time.
  bool is_patched(const lod::TileKey& key, MadeOf made_of) const {
    return overlay_ != nullptr && overlay_version(key, made_of) != file_->version_;
  }

  // Returns this planet with another one of the same body, radius, shape and datum, which colour=difference subtracts.
  // Pages are the same, and so are the connections; an index of all tiles takes memory. Planets that with() returns keep
  // the other one. Throws PlanetError with what differs.
  std::shared_ptr<const PlanetFile> compared_with(std::shared_ptr<const PlanetFile> earlier) const;
  // Returns the other planet; null for none.
  const std::shared_ptr<const PlanetFile>& earlier() const { return earlier_; }
  // Returns the number of the planet that compared_with() returned, 0 for none: differences of one tile and one number
  // of both are equal.
  std::uint64_t compared_version() const { return compared_version_; }

  // Returns this planet with imagery composed of some of the file's layers (PlanetMeta::image_layers), the lowest first, in
  // place of the imagery as it was built; an empty list: with that imagery. image_key() and image() follow. Coarser layers
  // are interpolated between their texels. Ground that no layer covers is grey, as where imagery has no data. Heights and
  // meshes are the same, and so are the connections. Patches that change images do not change layers.
  //
  // `former` is the planet that was shown before; null: this planet. If it shows the same layers of the same file, image
  // tiles keep their numbers (version()). Throws PlanetError, which names the layers that there are, for one that the file
  // does not have.
  std::shared_ptr<const PlanetFile> with_images(
      std::vector<vpe::core::ImageLayerLook> layers,
      const std::shared_ptr<const PlanetFile>& former = nullptr) const;
  // Returns the layers that the imagery is composed of; empty: it is that of the build.
  const std::vector<vpe::core::ImageLayerLook>& shown_layers() const { return shown_layers_; }
  // Returns true if both read the same opened file, whatever lies over it.
  bool is_same_file(const PlanetFile& other) const { return &file() == &other.file(); }

  // Returns a number that no other planet of this process has, and that is larger than that of the planet under it.
  std::uint64_t version() const { return version_; }
  // Returns the number of the last planet with which a page of the tile changed, among this one and those before it: its
  // `former`, or else the planet under it, and so on. Pages of one tile and one number are equal. For kImage, `key` must be
  // that of an image tile.
  std::uint64_t version(const lod::TileKey& key, MadeOf made_of = MadeOf::kTile) const {
    const std::uint64_t made = overlay_ == nullptr ? ground_version_ : overlay_version(key, made_of);
    const bool shows_images = made_of == MadeOf::kImage || made_of == MadeOf::kArea;
    return shows_images ? std::max(made, images_version_) : made;
  }
  // Returns the number of the last planet whose patch may have changed which of the tile's posts the sun shines on,
  // wherever the sun is: ground hides the sun from posts as far away as both can rise above the horizon. With another
  // exaggeration than 1, any patch counts.
  std::uint64_t shadow_version(const lod::TileKey& key, double exaggeration) const {
    return overlay_ == nullptr ? ground_version_ : overlay_shadow_version(key, exaggeration);
  }

  // Opens a connection of the caller's own to the same planet. Throws PlanetError if the path belongs to another
  // planet now, and for a patched planet, which is in no file; DatabaseError.
  Database connect() const;

  // Returns the file's path; for a patched planet that of the file under it.
  const std::string& path() const { return path_; }
  const PlanetMeta& meta() const { return meta_; }
  const lod::TileTree& tree() const { return *tree_; }
  double radius_m() const { return meta_.radius_m; }

  // Reads the heights of a tile. Throws PlanetError with the tile's key when it is not in the file or is
  // damaged (checksum, codec). With an exaggeration (> 0), the posts are those of the reference surface drawn
  // with it; see put_on_coarser_edges().
  TileHeights heights(const lod::TileKey& key, double exaggeration = 1.0) const;
  // Reads which sources the posts of a finest tile have. Throws as heights() does.
  TileSources sources(const lod::TileKey& key) const;
  // Reads one mesh of a tile. Throws as heights() does.
  PackedMesh mesh(const lod::TileKey& key, int variant) const;

  // Returns whether the tile, or one below it, has a nodata post. Does not read the tile.
  bool has_nodata(const lod::TileKey& key) const;

  // Returns the deepest stored image tile at or above `key`, or nullopt when the planet has no image.
  std::optional<lod::TileKey> image_key(const lod::TileKey& key) const;
  // Returns the keys of all image tiles.
  std::vector<lod::TileKey> image_keys() const;
  // Reads an image tile; `key` must be one that image_key() returned. Throws as heights() does.
  ImageTile image(const lod::TileKey& key) const;

 private:
  struct Connection;
  PlanetFile(const std::string& path, BeforeRead before_read);
  PlanetFile(const PlanetFile& base, std::shared_ptr<const TilePatch> patch, const PlanetFile* former);
  PlanetFile(const PlanetFile& base, std::shared_ptr<const PlanetFile> earlier);
  PlanetFile(const PlanetFile& base, std::vector<vpe::core::ImageLayerLook> layers, const PlanetFile& former);
  const PlanetFile& file() const { return file_ ? *file_ : *this; }
  const std::vector<std::int64_t>& shown_image_keys() const {
    return composed_keys_ ? *composed_keys_ : image_keys_;
  }
  void read_layer_keys(const Database& db);
  ImageTile composed_image(const lod::TileKey& key) const;
  static std::uint64_t next_version();
  void read_index(const Database& db);
  void set_nodata();  // from mask_keys_
  std::uint64_t overlay_version(const lod::TileKey& key, MadeOf made_of) const;
  std::uint64_t overlay_shadow_version(const lod::TileKey& key, double exaggeration) const;
  const PatchTile* patched_tile(std::int64_t row) const;  // null: none
  // Returns what fetch(connection) returns, if the file was not written to until then.
  template <class Read>
  auto read(const Read& fetch) const;

  std::string path_;
  BeforeRead before_read_;
  PlanetMeta meta_;
  std::string meta_checksum_;  // differs between planets
  std::shared_ptr<const lod::TileTree> tree_;
  std::vector<std::int64_t> image_keys_;   // of the imagery as it was built, sorted
  std::vector<std::int64_t> mask_keys_;    // of tiles with nodata posts, sorted
  std::vector<std::int64_t> nodata_keys_;  // of these and of all above them, sorted
  std::uint64_t version_ = 0;
  // Hold the planet that has the connections, if it is another one, and what lies over it, if the planet is a patched
  // one. Else null.
  std::shared_ptr<const PlanetFile> file_;
  std::shared_ptr<const PlanetOverlay> overlay_;
  mutable vpe::base::ObjectPool<Connection> connections_;  // unused where file_ is set
  std::shared_ptr<const PlanetFile> earlier_;
  std::uint64_t compared_version_ = 0;
  // Holds the keys of the tiles of each layer of the file, sorted; null without layers.
  std::shared_ptr<const std::vector<std::vector<std::int64_t>>> layer_keys_;
  std::vector<vpe::core::ImageLayerLook> shown_layers_;
  std::shared_ptr<const std::vector<std::int64_t>> composed_keys_;  // of shown_layers_, sorted; null without
  std::uint64_t ground_version_ = 0;                                // of all pages without a patch
  std::uint64_t images_version_ = 0;  // of image tiles since layers were chosen or left last; 0: never
};

}  // namespace paging
