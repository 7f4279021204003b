#include "lod/occlusion.h"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>

#include "lod/front_to_back.h"

namespace lod {

void OcclusionPass::begin(const glm::dvec3& camera_m, bool camera_is_above_ground, double margin_rad) {
  above_ = camera_is_above_ground;
  if (above_) horizon_.begin(cull::make_camera(camera_m), margin_rad);
}

bool OcclusionPass::hidden(const cull::BoundingRegion& region) const {
  return above_ && horizon_.hidden(region);
}

void OcclusionPass::add(const TileKey& key, const OccluderProfile& occluders, double radius_m) {
  if (!above_) return;
  const mars::ChartRect rect = chart_rect(key);
  // Joins pieces that are much narrower than a bin, and strips with them.
  const double bins = horizon_.bins_spanned(rect);
  constexpr double kPieceBins = 0.5;
  if (bins < kPieceBins) return;
  std::size_t joined = 1;
  while (joined < kOccluderPieces && bins * static_cast<double>(joined) < kPieceBins * kOccluderPieces)
    joined *= 2;
  const std::size_t pieces = kOccluderPieces / joined;
  const std::size_t step = std::max<std::size_t>(1, joined * kOccluderStrips / kOccluderPieces);
  const GridLines lines = grid_lines(key, kOccluderPieces);
  std::array<double, kOccluderPieces + 1> ends;
  std::array<double, kOccluderPieces> radius;
  const auto add_family = [&](bool column, const auto& occluder, const std::vector<double>& across,
                              const std::vector<double>& along) {
    for (std::size_t n = 0; n <= pieces; ++n) ends[n] = along[n * joined];
    for (std::size_t line = 0; line <= kOccluderStrips; line += step) {
      for (std::size_t n = 0; n < pieces; ++n) {
        const auto from = occluder[line].begin() + static_cast<std::ptrdiff_t>(n * joined);
        radius[n] =
            radius_m + static_cast<double>(*std::min_element(from, from + static_cast<std::ptrdiff_t>(joined)));
      }
      horizon_.add({key.face, column, across[line * kOccluderPieces / kOccluderStrips],
                    std::span(ends).first(pieces + 1), std::span(radius).first(pieces)});
    }
  };
  add_family(true, occluders.columns, lines.u, lines.v);
  add_family(false, occluders.rows, lines.v, lines.u);
}

void occlude(std::span<const OccludingTile> tiles, const glm::dvec3& camera_m, bool camera_is_above_ground,
             double margin_rad, double radius_m, OcclusionPass& pass, std::vector<std::uint8_t>& hidden) {
  hidden.assign(tiles.size(), 0);
  if (!camera_is_above_ground) return;
  std::vector<TileKey> keys;
  keys.reserve(tiles.size());
  for (const OccludingTile& tile : tiles) keys.push_back(tile.key);
  std::vector<std::uint32_t> order;
  front_to_back(keys, cull::make_camera(camera_m).direction, order);
  pass.begin(camera_m, camera_is_above_ground, margin_rad);
  for (const std::uint32_t n : order) {
    const OccludingTile& tile = tiles[n];
    if (pass.hidden(tile.region)) {
      hidden[n] = 1;
    } else if (tile.occluders != nullptr) {
      pass.add(tile.key, *tile.occluders, radius_m);
    }
  }
}

}  // namespace lod
