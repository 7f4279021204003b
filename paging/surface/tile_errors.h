// Errors of drawn tiles by block of their ground.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "lod/mesh/block_errors.h"
#include "lod/select.h"
#include "paging/planet/planet_file.h"
#include "vpe/base/lru_cache.h"

namespace paging {

// Measures meshes against the posts below them, when first asked, and keeps the results by last use.
//
// Of a finest tile the posts are the reference surface. Of a tile above finest tiles those of its children are. Higher up the
// errors of the children's posts are added, where the planet file states them.
//
// Thread rule: any thread may call any member.
class TileErrors {
 public:
  static constexpr std::size_t kUsualBytes = std::size_t{12} << 20;  // some 800 tiles

  // Keeps within the budget, a third for each of three kinds, except for the newest of each kind.
  explicit TileErrors(std::shared_ptr<const PlanetFile> planet, std::size_t budget_bytes = kUsualBytes)
      : planet_(std::move(planet)),
        posts_(std::make_shared<PostsCache>(budget_bytes / 3)),
        of_meshes_(std::make_shared<Cache>(budget_bytes / 3)),
        kept_(std::make_shared<Cache>(budget_bytes / 3)) {}
  // Shares what is kept with those of another version of the planet: tiles that are equal in both are measured once.
  TileErrors(std::shared_ptr<const PlanetFile> planet, const TileErrors& former)
      : planet_(std::move(planet)), posts_(former.posts_), of_meshes_(former.of_meshes_), kept_(former.kept_) {}

  using Pointer = std::shared_ptr<const lod::BlockErrors>;

  // Returns bounds of the geometric error of a tile's mesh. Null for full grids, whose error is 0, and where no posts say more
  // than the tile's own bound: at another exaggeration than 1 of tiles with children, or where tiles could not be read.
  Pointer find(const lod::SelectedTile& tile, double exaggeration);
  // Returns the same without reading anything, or nullopt if find() would have to.
  std::optional<Pointer> find_measured(const lod::SelectedTile& tile, double exaggeration);

  // Returns the bytes of all that is kept.
  std::size_t bytes() const { return posts_->bytes() + of_meshes_->bytes() + kept_->bytes(); }

 private:
  struct Key {
    lod::TileKey tile;
    int variant = 0;
    double exaggeration = 1;
    std::array<std::uint64_t, 5> versions{};  // of the tile and its children
    double below_m = 0;                       // of kept_
    double most_m = 0;                        // likewise: the tile's own bound
    bool operator==(const Key&) const = default;
  };
  struct KeyHash {
    std::size_t operator()(const Key& k) const {
      return lod::TileKeyHash()(k.tile) * 31 + static_cast<std::size_t>(k.variant);
    }
  };
  using Cache = vpe::base::LruCache<Key, lod::BlockErrors, KeyHash>;
  using PostsCache = vpe::base::LruCache<TileVersion, lod::Posts, TileVersionHash>;
  Key key_of(const lod::SelectedTile& tile, double exaggeration) const;
  bool says_more(const lod::SelectedTile& tile, double exaggeration) const;
  double below_m(const lod::SelectedTile& tile, double exaggeration) const;
  std::shared_ptr<const lod::Posts> posts_of(const lod::TileKey& key) const;
  lod::Posts children_posts(const lod::TileKey& key) const;
  lod::BlockErrors measure(const lod::SelectedTile& tile, double exaggeration) const;
  Pointer find_mesh(const lod::SelectedTile& tile, double exaggeration);

  std::shared_ptr<const PlanetFile> planet_;
  std::shared_ptr<PostsCache> posts_;  // of children, for a patch of one of four
  // Against the posts, without what is below them; without blocks where tiles could not be read.
  std::shared_ptr<Cache> of_meshes_;
  std::shared_ptr<Cache> kept_;
};

}  // namespace paging
