#include "vpe/app/planet/info/ground_statistics.h"

#include <algorithm>
#include <glm/geometric.hpp>

#include "lod/tree/posts.h"
#include "mars/geodesy/cube.h"
#include "vpe/app/planet/info/tile_area.h"
#include "vpe/core/appearance/slope.h"

namespace vpe::app {

namespace {

constexpr int kSlopeBins = 1 << 15;
constexpr int kElevationBins = 1 << 12;
constexpr std::size_t kTilesPerItem = 24;
constexpr double kWholePlanet = 1 - 1e-9;

Distribution slopes() { return {0, 90, kSlopeBins, Distribution::Spacing::kSquare}; }

Distribution elevations(const paging::PlanetMeta& meta) {
  const double low = meta.lowest_radius_m - meta.radius_m;
  const double high = meta.highest_radius_m - meta.radius_m;
  return {low, std::max(high, low + 1e-6), kElevationBins, Distribution::Spacing::kEven};
}

// Holds the posts of one line of a tile.
struct PostLine {
  std::vector<glm::dvec3> directions;
  std::vector<glm::dvec3> places_m;
};

PostLine post_line(const lod::Posts& posts, const lod::GridLines& lines, int j, double radius_m) {
  PostLine line;
  for (int i = 0; i < posts.side(); ++i) {
    const glm::dvec3 d = mars::chart_direction(posts.key.face, lines.u[static_cast<std::size_t>(i)],
                                               lines.v[static_cast<std::size_t>(j)]);
    line.directions.push_back(d);
    line.places_m.push_back(d * (radius_m + posts.at(i, j)));
  }
  return line;
}

void add_tile(const paging::TileHeights& tile, double radius_m, GroundStatistics& to) {
  const lod::Posts& posts = tile.posts;
  const lod::GridLines lines = lod::grid_lines(posts.key, posts.intervals);
  PostLine south = post_line(posts, lines, 0, radius_m);
  for (int j = 0; j < posts.intervals; ++j) {
    PostLine north = post_line(posts, lines, j + 1, radius_m);
    for (int i = 0; i < posts.intervals; ++i) {
      const auto west = static_cast<std::size_t>(i);
      const std::size_t east = west + 1;
      if (!tile.nodata.empty()) {
        const auto row = static_cast<std::size_t>(j) * static_cast<std::size_t>(posts.side());
        const std::size_t above = row + static_cast<std::size_t>(posts.side());
        if (tile.nodata[row + west] || tile.nodata[row + east] || tile.nodata[above + west] ||
            tile.nodata[above + east])
          continue;
      }
      const glm::dvec3 normal =
          glm::cross(north.places_m[east] - south.places_m[west], north.places_m[west] - south.places_m[east]);
      // The vertical is made as the normal is, so that level ground has no slope in skew cells either.
      const glm::dvec3 up = glm::cross(north.directions[east] - south.directions[west],
                                       north.directions[west] - south.directions[east]);
      const double area_sr = 0.5 * glm::length(up);
      to.slopes_deg.add(core::slope_deg(normal, up), area_sr);
      to.elevations_m.add(
          0.25 * (posts.at(i, j) + posts.at(i + 1, j) + posts.at(i, j + 1) + posts.at(i + 1, j + 1)), area_sr);
    }
    south = std::move(north);
  }
}

// Returns the tiles of a level that are sampled.
std::vector<lod::TileKey> sampled(const std::vector<lod::TileKey>& all) {
  if (static_cast<std::int64_t>(all.size()) <= kMostSampledTiles) return all;
  std::vector<lod::TileKey> some;
  constexpr auto kMost = static_cast<std::size_t>(kMostSampledTiles);
  for (std::size_t n = 0; n < kMost; ++n) some.push_back(all[(2 * n + 1) * all.size() / (2 * kMost)]);
  return some;
}

}  // namespace

std::vector<GroundStatistics> ground_statistics(const paging::PlanetFile& planet, base::ThreadPool& pool,
                                                const std::function<void(double)>& tell) {
  const paging::PlanetMeta& meta = planet.meta();
  std::vector<std::vector<lod::TileKey>> by_level(static_cast<std::size_t>(meta.finest_level) + 1);
  for (const lod::TileInfo& tile : planet.tree().tiles())
    by_level[static_cast<std::size_t>(tile.key.level)].push_back(tile.key);

  std::vector<GroundStatistics> out;
  for (std::size_t level = 0; level < by_level.size(); ++level) {
    if (tell) tell(static_cast<double>(level) / static_cast<double>(by_level.size()));
    const std::vector<lod::TileKey> keys = sampled(by_level[level]);
    GroundStatistics whole{static_cast<int>(level),
                           lod::post_spacing_m(static_cast<int>(level), meta.tile.intervals(), meta.radius_m),
                           static_cast<std::int64_t>(by_level[level].size()),
                           static_cast<std::int64_t>(keys.size()),
                           0,
                           slopes(),
                           elevations(meta)};
    double area_sr = 0;
    for (const lod::TileKey& key : by_level[level]) area_sr += tile_area_sr(key);
    whole.share_of_planet = std::min(1.0, area_sr / (4 * mars::kPi));
    std::vector<GroundStatistics> parts((keys.size() + kTilesPerItem - 1) / kTilesPerItem,
                                        GroundStatistics{0, 0, 0, 0, 0, slopes(), elevations(meta)});
    pool.run(parts.size(), [&](std::size_t part) {
      const std::size_t end = std::min(keys.size(), (part + 1) * kTilesPerItem);
      for (std::size_t n = part * kTilesPerItem; n < end; ++n)
        add_tile(planet.heights(keys[n]), meta.radius_m, parts[part]);
    });
    for (const GroundStatistics& part : parts) {
      whole.slopes_deg.include(part.slopes_deg);
      whole.elevations_m.include(part.elevations_m);
    }
    out.push_back(std::move(whole));
  }
  return out;
}

std::size_t finest_whole_level(const std::vector<GroundStatistics>& levels) {
  std::size_t finest = 0;
  for (std::size_t n = 0; n < levels.size(); ++n)
    if (levels[n].share_of_planet >= kWholePlanet) finest = n;
  return finest;
}

}  // namespace vpe::app
