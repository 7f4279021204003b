#include "lod/occlusion.h"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>

#include "lod/front_to_back.h"

namespace lod {

void OcclusionPass::begin(const glm::dvec3& eye_m, bool eye_is_above_ground, double margin_rad) {
  above_ = eye_is_above_ground;
  if (above_) horizon_.begin(cull::make_eye(eye_m), margin_rad);
}

bool OcclusionPass::hidden(const cull::Shell& shell) const { return above_ && horizon_.hidden(shell); }

void OcclusionPass::add(const TileKey& key, const TileWalls& walls, double radius_m) {
  if (!above_) return;
  const mars::ChartRect rect = chart_rect(key);
  // Pieces much narrower than a bin are joined, and with them strips.
  const double bins = horizon_.bins_spanned(rect);
  constexpr double kPieceBins = 0.5;
  if (bins < kPieceBins) return;
  std::size_t joined = 1;
  while (joined < kWallPieces && bins * static_cast<double>(joined) < kPieceBins * kWallPieces) joined *= 2;
  const std::size_t pieces = kWallPieces / joined;
  const std::size_t step = std::max<std::size_t>(1, joined * kWallStrips / kWallPieces);
  const GridLines lines = grid_lines(key, kWallPieces);
  std::array<double, kWallPieces + 1> ends;
  std::array<double, kWallPieces> radius;
  const auto add_family = [&](bool column, const auto& wall, const std::vector<double>& across,
                              const std::vector<double>& along) {
    for (std::size_t n = 0; n <= pieces; ++n) ends[n] = along[n * joined];
    for (std::size_t line = 0; line <= kWallStrips; line += step) {
      for (std::size_t n = 0; n < pieces; ++n) {
        const auto from = wall[line].begin() + static_cast<std::ptrdiff_t>(n * joined);
        radius[n] =
            radius_m + static_cast<double>(*std::min_element(from, from + static_cast<std::ptrdiff_t>(joined)));
      }
      horizon_.add({key.face, column, across[line * kWallPieces / kWallStrips],
                    std::span(ends).first(pieces + 1), std::span(radius).first(pieces)});
    }
  };
  add_family(true, walls.columns, lines.u, lines.v);
  add_family(false, walls.rows, lines.v, lines.u);
}

void occlude(std::span<const OccludingTile> tiles, const glm::dvec3& eye_m, bool eye_is_above_ground,
             double margin_rad, double radius_m, OcclusionPass& pass, std::vector<std::uint8_t>& hidden) {
  hidden.assign(tiles.size(), 0);
  if (!eye_is_above_ground) return;
  std::vector<TileKey> keys;
  keys.reserve(tiles.size());
  for (const OccludingTile& tile : tiles) keys.push_back(tile.key);
  std::vector<std::uint32_t> order;
  front_to_back(keys, cull::make_eye(eye_m).direction, order);
  pass.begin(eye_m, eye_is_above_ground, margin_rad);
  for (const std::uint32_t n : order) {
    const OccludingTile& tile = tiles[n];
    if (pass.hidden(tile.shell)) {
      hidden[n] = 1;
    } else if (tile.walls != nullptr) {
      pass.add(tile.key, *tile.walls, radius_m);
    }
  }
}

}  // namespace lod
