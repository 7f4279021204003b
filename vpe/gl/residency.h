// GPU objects of tiles: what is resident, what a frame still needs, what may leave.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "lod/tile_key.h"
#include "vpe/gl/objects.h"
#include "vpe/gl/shade.h"
#include "vpe/gl/tile_geometry.h"

namespace vpe::gl {

struct GpuMesh {
  Buffer vertices;
  Buffer indices;
  bool short_indices = false;
  glm::dvec3 centre_m{0, 0, 0};
  std::uint32_t first_foot = 0;
  IndexRanges ranges;
  double quantisation_m = 0;
  double longest_edge_m = 0;
  std::size_t bytes = 0;
};
GpuMesh upload(const TileGeometry& geometry);

struct GpuTexture {
  Texture2D texture;
  int intervals = 0;
  bool gaps = false;  // ShadedTile::gaps
  std::size_t bytes = 0;
};
GpuTexture upload(const ShadedTile& tile);

struct MeshKey {
  lod::TileKey tile;
  int variant = 0;
  int origin = kTileCentre;  // what positions are relative to (make_geometry)
  bool operator==(const MeshKey&) const = default;
};
struct TextureKey {
  lod::TileKey tile;
  int intervals = 0;
  bool operator==(const TextureKey&) const = default;
};

// Least recently drawn objects leave when the budget is passed; what the current frame uses never does. Used on
// the context's thread only.
template <typename Key, typename Value>
class Resident {
 public:
  // The value if resident; marks it as used by the current frame.
  Value* find(const Key& key, std::uint64_t frame) {
    const auto at = items_.find(key);
    if (at == items_.end()) return nullptr;
    at->second.frame = frame;
    return &at->second.value;
  }
  void insert(const Key& key, Value value, std::uint64_t frame) {
    bytes_ += value.bytes;
    items_.emplace(key, Item{std::move(value), frame});
  }
  // Frees what was drawn longest ago until at most `limit` bytes are held.
  void trim(std::size_t limit, std::uint64_t current_frame) {
    while (bytes_ > limit) {
      auto oldest = items_.end();
      for (auto at = items_.begin(); at != items_.end(); ++at) {
        if (at->second.frame != current_frame &&
            (oldest == items_.end() || at->second.frame < oldest->second.frame)) {
          oldest = at;
        }
      }
      if (oldest == items_.end()) return;
      bytes_ -= oldest->second.value.bytes;
      items_.erase(oldest);
    }
  }
  void clear() {
    items_.clear();
    bytes_ = 0;
  }
  std::size_t bytes() const { return bytes_; }

 private:
  struct Item {
    Value value;
    std::uint64_t frame = 0;
  };
  struct Hash {
    std::size_t operator()(const MeshKey& k) const {
      return lod::TileKeyHash()(k.tile) * 31 + static_cast<std::size_t>(k.variant) +
             1009 * static_cast<std::size_t>(k.origin + 1);
    }
    std::size_t operator()(const TextureKey& k) const {
      return lod::TileKeyHash()(k.tile) * 31 + static_cast<std::size_t>(k.intervals);
    }
  };
  std::unordered_map<Key, Item, Hash> items_;
  std::size_t bytes_ = 0;
};

}  // namespace vpe::gl
