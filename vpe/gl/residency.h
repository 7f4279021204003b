// GPU objects of tiles, and how long they stay resident.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

#include "lod/occluder_profile.h"
#include "lod/tree/tile_key.h"
#include "paging/shading/terrain_shader.h"
#include "vpe/gl/objects.h"
#include "vpe/gl/tile_geometry.h"

namespace vpe::gl {

using paging::ShadedTile;
using paging::ShadingParams;

struct GpuMesh {
  Buffer positions;
  Buffer charts;   // none: no textures
  Buffer normals;  // none: no light of vertices
  Buffer indices;
  bool short_indices = false;  // 16 bits
  glm::dvec3 centre_m{0, 0, 0};
  std::uint32_t first_foot = 0;  // vertices from here on are feet of skirts
  IndexRanges ranges;
  PieceFrame frame;               // as of TileGeometry
  std::vector<MeshPiece> pieces;  // likewise
  double quantisation_m = 0;
  double longest_edge_m = 0;
  std::shared_ptr<const lod::OccluderProfile> occluders;  // null: not made
  std::size_t bytes = 0;
};
// Uploads geometry to buffers of its own. Throws std::runtime_error.
GpuMesh upload(const TileGeometry& geometry);

// Facets lie in rows of kFacetRow texels.
inline constexpr int kFacetRow = 256;

struct GpuTexture {
  Texture2D texture;
  int intervals = 0;          // 0: facets
  bool light = false;         // one channel: ShadedTile::channels
  double brightest = 1;       // light of the value 255
  bool nodata = false;        // ShadedTile::nodata
  bool nodata_image = false;  // ShadedTile::nodata_image
  std::size_t bytes = 0;
};
// Uploads colours or light to a texture of its own. Throws std::runtime_error.
GpuTexture upload(const ShadedTile& tile);

// Identifies one of a tile's meshes.
struct MeshDetail {
  int variant = 0;
  int origin = kTileCentre;  // what positions are relative to (make_geometry)
  bool charts = true;
  bool normals = false;
  bool operator==(const MeshDetail&) const = default;
};
// Identifies one of a tile's textures.
struct TextureDetail {
  int texture = 0;  // TileNeed::texture
  std::shared_ptr<const ShadingParams> shading;
  bool operator==(const TextureDetail&) const = default;
};

// Holds the resident objects of tiles, several for each tile. Values have a member `bytes`.
//
// Each use is marked with a frame, which need not be the latest: pages of later views are marked with an
// earlier one, so that they leave first. trim() drops what has the oldest marks, but nothing of the current
// frame. Pointers to values stay valid until the next trim(), drop() or clear().
//
// base::LruList and base::LruCache do not fit: they order by the time of use, where pages of later views would
// stay longer than those of this frame.
//
// Thread rule: the context's thread.
template <typename Detail, typename Value>
class Resident {
 public:
  // Returns a tile's value or null, and marks it as used in `frame`.
  Value* find(const lod::TileKey& tile, const Detail& detail, std::uint64_t frame) {
    return best(tile, frame, [&](const Detail& d) { return d == detail ? 0 : -1; });
  }
  // Returns the one of a tile's values with the largest score, or null if no score is >= 0. Marks it as used.
  template <typename Score>
  Value* best(const lod::TileKey& tile, std::uint64_t frame, const Score& score) {
    const auto at = items_.find(tile);
    if (at == items_.end()) return nullptr;
    Item* found = nullptr;
    int highest = -1;
    for (Item& item : at->second) {
      const int s = score(item.detail);
      if (s > highest) found = &item, highest = s;
    }
    if (found == nullptr) return nullptr;
    found->frame = std::max(found->frame, frame);
    return found->value.get();
  }
  // Adds a value, unless the tile has one of this detail.
  void insert(const lod::TileKey& tile, const Detail& detail, Value value, std::uint64_t frame) {
    if (find(tile, detail, frame) != nullptr) return;
    bytes_ += value.bytes;
    items_[tile].push_back({detail, std::make_unique<Value>(std::move(value)), frame});
  }
  // Returns the bytes of what was used in a frame or later.
  std::size_t bytes_since(std::uint64_t frame) const {
    std::size_t sum = 0;
    for (const auto& [tile, items] : items_) {
      for (const Item& item : items) sum += item.frame >= frame ? item.value->bytes : 0;
    }
    return sum;
  }
  // Returns the mean size of what is held, bytes; 0 if there is nothing.
  std::size_t mean_bytes() const {
    std::size_t count = 0;
    for (const auto& [tile, items] : items_) count += items.size();
    return count == 0 ? 0 : bytes_ / count;
  }
  // Drops values with the oldest marks until at most `limit` bytes are held. Returns how many were dropped.
  int trim(std::size_t limit, std::uint64_t current_frame) {
    if (bytes_ <= limit) return 0;
    struct Old {
      std::uint64_t frame;
      lod::TileKey tile;
      std::size_t bytes;
    };
    std::vector<Old> old;
    for (const auto& [tile, items] : items_) {
      for (const Item& item : items) {
        if (item.frame != current_frame) old.push_back({item.frame, tile, item.value->bytes});
      }
    }
    std::sort(old.begin(), old.end(), [](const Old& a, const Old& b) { return a.frame < b.frame; });
    int gone = 0;
    for (const Old& o : old) {
      if (bytes_ <= limit) break;
      std::vector<Item>& items = items_[o.tile];
      const auto item =
          std::find_if(items.begin(), items.end(), [&](const Item& i) { return i.frame == o.frame; });
      bytes_ -= item->value->bytes;
      items.erase(item);
      if (items.empty()) items_.erase(o.tile);
      ++gone;
    }
    return gone;
  }
  // Drops all values whose tile, detail and latest mark fulfil a condition.
  template <typename Drop>
  void drop(const Drop& drop) {
    for (auto at = items_.begin(); at != items_.end();) {
      std::erase_if(at->second, [&](const Item& item) {
        if (!drop(at->first, item.detail, item.frame)) return false;
        bytes_ -= item.value->bytes;
        return true;
      });
      at = at->second.empty() ? items_.erase(at) : std::next(at);
    }
  }
  void clear() {
    items_.clear();
    bytes_ = 0;
  }
  std::size_t bytes() const { return bytes_; }

 private:
  struct Item {
    Detail detail;
    std::unique_ptr<Value> value;
    std::uint64_t frame = 0;
  };
  std::unordered_map<lod::TileKey, std::vector<Item>, lod::TileKeyHash> items_;
  std::size_t bytes_ = 0;
};

}  // namespace vpe::gl
