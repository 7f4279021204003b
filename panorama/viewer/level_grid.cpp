#include "panorama/viewer/level_grid.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace panorama {

std::int64_t LevelGrid::wrapped(std::int64_t x) const {
  if (turn > 0 && x < left) x += turn;
  if (turn > 0 && x > right) x -= turn;
  return std::clamp(x, left, right);
}

std::vector<LevelGrid> level_grids(const std::vector<ImageLevel>& levels, const PanoramaMap& map,
                                   const ImageOrigin& origin) {
  const ImageLevel& full = levels.front();
  const auto width_px = static_cast<double>(map.width_px);
  const auto height_px = static_cast<double>(map.height_px);
  const bool is_closed = width_px > map.turn_px - 1.0;
  std::vector<LevelGrid> grids;
  for (const ImageLevel& size : levels) {
    LevelGrid grid;
    grid.size = size;
    grid.origin_px = {static_cast<double>(origin.x_px), static_cast<double>(origin.y_px)};
    grid.scale = {static_cast<double>(size.width_px) / static_cast<double>(full.width_px),
                  static_cast<double>(size.height_px) / static_cast<double>(full.height_px)};
    grid.reduction = 1.0 / std::min(grid.scale.x, grid.scale.y);
    grid.turn = is_closed ? std::llround(map.turn_px * grid.scale.x) : 0;
    const auto last = [](double end) { return static_cast<std::int64_t>(std::ceil(end - 1e-6)) - 1; };
    grid.left = static_cast<std::int64_t>(grid.origin_px.x * grid.scale.x);
    grid.top = static_cast<std::int64_t>(grid.origin_px.y * grid.scale.y);
    grid.right = std::clamp(last((grid.origin_px.x + width_px) * grid.scale.x), grid.left, size.width_px - 1);
    grid.bottom = std::clamp(last((grid.origin_px.y + height_px) * grid.scale.y), grid.top, size.height_px - 1);
    grids.push_back(grid);
  }
  return grids;
}

int level_of_footprint(std::span<const LevelGrid> grids, double footprint_px) {
  int level = 0;
  const int coarsest = static_cast<int>(grids.size()) - 1;
  while (level < coarsest && grids[static_cast<std::size_t>(level) + 1].reduction <= footprint_px) ++level;
  return level;
}

Footprint footprint_of(const glm::dvec2& across, const glm::dvec2& down) {
  Footprint footprint;
  footprint.longest_px = std::max(glm::length(across), glm::length(down));
  // A sheared footprint is thinner than its shorter side.
  const double area_px = std::abs(across.x * down.y - across.y * down.x);
  footprint.thin_px = std::max({footprint.longest_px > 0.0 ? area_px / footprint.longest_px : 0.0,
                                footprint.longest_px / kMostSamples, 1.0});
  footprint.samples = static_cast<int>(
      std::clamp(std::ceil(footprint.longest_px / footprint.thin_px - 1e-6), 1.0, kMostSamples));
  return footprint;
}

}  // namespace panorama
