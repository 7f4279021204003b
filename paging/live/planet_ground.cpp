#include "paging/live/planet_ground.h"

#include <algorithm>
#include <limits>

#include "lod/tree/facet_mask.h"
#include "paging/build/build_grid.h"
#include "paging/planet/tile_sources.h"

namespace paging {

namespace {

// The rest holds grids.
constexpr std::size_t kSurfaceDivisor = 4;

// Holds a finest tile of the planet while places in it are asked for.
struct HeldTile {
  std::shared_ptr<const SurfaceTile> tile;
  std::shared_ptr<const TileSources> sources;  // null: not wanted
};

// Returns the interval of ascending lines that holds x, which may lie a little outside.
std::size_t interval_of(const std::vector<double>& lines, double x) {
  return static_cast<std::size_t>(std::upper_bound(lines.begin() + 1, lines.end() - 1, x) - lines.begin() - 1);
}

bool is_nodata(const SurfaceTile& tile, const mars::ChartPoint& point) {
  if (tile.data.nodata.empty()) return false;
  const auto fraction = [](const std::vector<double>& lines, std::size_t n, double x) {
    return std::clamp((x - lines[n]) / (lines[n + 1] - lines[n]), 0.0, 1.0);
  };
  const std::size_t i = interval_of(tile.lines.u, point.u);
  const std::size_t j = interval_of(tile.lines.v, point.v);
  const auto side = static_cast<std::size_t>(tile.data.posts.side());
  return lod::is_flagged(tile.data.nodata, j * side + i, side, fraction(tile.lines.u, i, point.u),
                         fraction(tile.lines.v, j, point.v));
}

// Returns the source of the nearest post. Files before format 1.3 do not tell it in tiles of several.
int source_of(const HeldTile& held, const mars::ChartPoint& point) {
  const auto found = held.sources->at(nearest_post(*held.tile, point));
  if (found) return *found;
  return held.sources->of_tile.empty() ? 0 : held.sources->of_tile.front();
}

}  // namespace

std::size_t GroundGrid::bytes() const {
  return sizeof(GroundGrid) + (lines.u.capacity() + lines.v.capacity() + height_m.capacity()) * sizeof(double) +
         directions.capacity() * sizeof(glm::dvec3) + nodata.capacity() / 8 + source.capacity() * sizeof(int);
}

PlanetGround::PlanetGround(std::shared_ptr<const PlanetFile> planet, std::size_t budget_bytes)
    : surface_(std::move(planet), budget_bytes / kSurfaceDivisor),
      grids_(budget_bytes - budget_bytes / kSurfaceDivisor) {}

double PlanetGround::height_m(const glm::dvec3& direction) const {
  const mars::ChartPoint point = mars::chart_point(direction);
  const auto tile = surface_.tile(planet().tree().deepest(lod::tile_at(point, lod::kMaxLevel)).key);
  if (is_nodata(*tile, point)) return std::numeric_limits<double>::quiet_NaN();
  return lod::surface_height(tile->data.posts, tile->lines, point.u, point.v, planet().radius_m());
}

std::shared_ptr<const GroundGrid> PlanetGround::grid(const lod::TileKey& key) const {
  return grids_.get(key, [&] {
    auto made = std::make_shared<const GroundGrid>(sample(key));
    const std::size_t bytes = made->bytes();
    return std::pair(std::move(made), bytes);
  });
}

GroundGrid PlanetGround::sample(const lod::TileKey& key) const {
  const PlanetFile& planet = this->planet();
  const int n = planet.meta().tile.intervals();
  const bool has_sources = planet.meta().sources.size() > 1;
  GroundGrid grid;
  grid.lines = lod::grid_lines(key, n);
  grid.directions = post_directions(key, grid.lines);
  const std::size_t posts = grid.directions.size();
  grid.height_m.resize(posts);
  if (has_sources) grid.source.resize(posts);
  HeldTile held;
  for (std::size_t p = 0; p < posts; ++p) {
    const mars::ChartPoint point = mars::chart_point(grid.directions[p]);
    const lod::TileKey place = lod::tile_at(point, lod::kMaxLevel);
    if (!held.tile || !lod::contains(held.tile->data.posts.key, place)) {
      const lod::TileKey finest = planet.tree().deepest(place).key;
      held.tile = surface_.tile(finest);
      if (has_sources) held.sources = surface_.sources(finest);
    }
    const SurfaceTile& tile = *held.tile;
    grid.height_m[p] = lod::surface_height(tile.data.posts, tile.lines, point.u, point.v, planet.radius_m());
    const bool none = is_nodata(tile, point);
    if (none && grid.nodata.empty()) grid.nodata.resize(posts);
    if (none) grid.nodata[p] = true;
    if (has_sources) grid.source[p] = none ? -1 : source_of(held, point);
  }
  return grid;
}

}  // namespace paging
