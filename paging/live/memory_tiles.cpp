#include "paging/live/memory_tiles.h"

#include <algorithm>

#include "paging/build/build_grid.h"

namespace paging {

void MemoryTiles::put_tile(const NodeRow& row, const TilePayload& payload) {
  const std::lock_guard lock(mutex_);
  tiles_[row.key] = {row, payload, {}};
}

void MemoryTiles::replace_row(const NodeRow& row) {
  const std::lock_guard lock(mutex_);
  tiles_.at(row.key).row = row;
}

const TilePayload* MemoryTiles::find(const lod::TileKey& key) {
  const std::lock_guard lock(mutex_);
  const auto at = tiles_.find(lod::pack(key));
  return at == tiles_.end() ? nullptr : &at->second.payload;
}

Bytes MemoryTiles::heights(const lod::TileKey& key) {
  if (const TilePayload* own = find(key)) return own->heights;
  const lod::Posts posts = planet_.heights(key).posts;
  return encode_heights(to_quanta(posts.height_m, planet_.meta().quantum_m), posts.side());
}

Bytes MemoryTiles::nodata(const lod::TileKey& key) {
  if (const TilePayload* own = find(key)) return own->nodata;
  const std::vector<bool> mask = planet_.heights(key).nodata;
  return mask.empty() ? Bytes() : encode_mask(mask);
}

Bytes MemoryTiles::mesh(const lod::TileKey& key, int variant) {
  if (const TilePayload* own = find(key)) return own->meshes.at(static_cast<std::size_t>(variant));
  return encode_mesh(planet_.mesh(key, variant));
}

std::vector<PatchTile> MemoryTiles::take() {
  const std::lock_guard lock(mutex_);
  std::vector<PatchTile> out;
  out.reserve(tiles_.size());
  for (auto& [key, tile] : tiles_) out.push_back(std::move(tile));
  tiles_.clear();
  std::sort(out.begin(), out.end(),
            [](const PatchTile& a, const PatchTile& b) { return a.row.key < b.row.key; });
  return out;
}

}  // namespace paging
