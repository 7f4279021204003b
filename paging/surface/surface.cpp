#include "paging/surface/surface.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "lod/tree/facet_mask.h"
#include "paging/planet/planet_user.h"
#include "paging/surface/tile_place.h"

namespace paging {

std::size_t SurfaceTile::bytes() const {
  std::size_t total = sizeof(SurfaceTile) + data.posts.height_m.capacity() * sizeof(double) +
                      data.nodata.capacity() / 8 + (lines.u.capacity() + lines.v.capacity()) * sizeof(double);
  for (const auto& block : block_max) total += block.capacity() * sizeof(float);
  return total;
}

SurfaceTile prepare_tile(TileHeights heights) {
  SurfaceTile tile;
  tile.data = std::move(heights);
  const lod::Posts& posts = tile.data.posts;
  tile.lines = lod::grid_lines(posts.key, posts.intervals);
  const auto [low, high] = std::minmax_element(posts.height_m.begin(), posts.height_m.end());
  tile.min_height_m = *low;
  tile.max_height_m = *high;
  // Rounded up to float so that a block's maximum is never below its posts.
  const auto up = [](double h) {
    return std::nextafter(static_cast<float>(h), std::numeric_limits<float>::infinity());
  };
  int side = posts.intervals / 2;
  std::vector<float> level(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
  for (int j = 0; j < side; ++j) {
    for (int i = 0; i < side; ++i) {
      double largest = -std::numeric_limits<double>::infinity();
      for (int y = 2 * j; y <= 2 * j + 2; ++y) {
        for (int x = 2 * i; x <= 2 * i + 2; ++x) largest = std::max(largest, posts.at(x, y));
      }
      level[static_cast<std::size_t>(j * side + i)] = up(largest);
    }
  }
  tile.block_max.push_back(std::move(level));
  while (side > 1) {
    const std::vector<float>& fine = tile.block_max.back();
    const int half = side / 2;
    std::vector<float> coarse(static_cast<std::size_t>(half) * static_cast<std::size_t>(half));
    for (int j = 0; j < half; ++j) {
      for (int i = 0; i < half; ++i) {
        const auto at = [&](int x, int y) { return fine[static_cast<std::size_t>(y * side + x)]; };
        coarse[static_cast<std::size_t>(j * half + i)] =
            std::max({at(2 * i, 2 * j), at(2 * i + 1, 2 * j), at(2 * i, 2 * j + 1), at(2 * i + 1, 2 * j + 1)});
      }
    }
    tile.block_max.push_back(std::move(coarse));
    side = half;
  }
  return tile;
}

namespace {

// Small, because few tiles lie beside coarser ones.
constexpr double kExaggeratedShare = 0.1;
// Small, because a tile's sources take a quarter of the bytes of its heights at most, and only query() asks.
constexpr double kSourcesShare = 0.02;

std::size_t share_of(std::size_t bytes, double share) {
  return static_cast<std::size_t>(share * static_cast<double>(bytes));
}

}  // namespace

Surface::Surface(std::shared_ptr<const PlanetFile> planet, std::size_t budget_bytes)
    : planet_(std::move(planet)),
      cache_(share_of(budget_bytes, 1 - kExaggeratedShare - kSourcesShare)),
      sources_(share_of(budget_bytes, kSourcesShare)),
      exaggerated_(share_of(budget_bytes, kExaggeratedShare)) {
  constexpr int kTableLevels = 11;
  for (int level = 0; level < kTableLevels; ++level) {
    std::vector<double>& lines = middles_.emplace_back();
    for (std::int32_t k = 0; k < 1 << level; ++k)
      lines.push_back(mars::face_line(2 * std::int64_t{k} + 1, level + 1));
  }
}

double Surface::middle_line(int level, std::int32_t index) const {
  const auto at = static_cast<std::size_t>(level);
  return at < middles_.size() ? middles_[at][static_cast<std::size_t>(index)]
                              : mars::face_line(2 * std::int64_t{index} + 1, level + 1);
}

void Surface::change_planet(std::shared_ptr<const PlanetFile> planet) {
  require_same_grid(*planet_, *planet);
  planet_ = std::move(planet);
  sources_.clear();  // the patch may number sources anew
}

std::shared_ptr<const SurfaceTile> Surface::tile(const lod::TileKey& key, double exaggeration) const {
  const TileVersion version = this->version(key);
  auto tile = cache_.get(version, [&] {
    TileHeights heights = planet_->heights(key);
    heights.source.clear();  // numbers of the planet that is read, and not of its patches; sources() has them
    auto made = std::make_shared<const SurfaceTile>(prepare_tile(std::move(heights)));
    const std::size_t bytes = made->bytes();
    return std::pair(std::move(made), bytes);
  });
  return exaggerated(version, std::move(tile), exaggeration);
}

std::shared_ptr<const SurfaceTile> Surface::held_tile(const lod::TileKey& key, double exaggeration) const {
  const TileVersion version = this->version(key);
  auto tile = cache_.find(version);
  return tile ? exaggerated(version, std::move(tile), exaggeration) : nullptr;
}

std::shared_ptr<const SurfaceTile> Surface::exaggerated(const TileVersion& version,
                                                        std::shared_ptr<const SurfaceTile> tile,
                                                        double exaggeration) const {
  if (exaggeration == 1.0 || tile->data.coarser_neighbour_mask == 0) return tile;
  return exaggerated_.get({version, exaggeration}, [&] {
    TileHeights heights = tile->data;
    put_on_coarser_edges(heights, planet_radius_m(), exaggeration);
    auto made = std::make_shared<const SurfaceTile>(prepare_tile(std::move(heights)));
    const std::size_t bytes = made->bytes();
    return std::pair(std::move(made), bytes);
  });
}

std::shared_ptr<const TileSources> Surface::sources(const lod::TileKey& key) const {
  return sources_.get(version(key), [&] {
    auto made = std::make_shared<const TileSources>(planet_->sources(key));
    const std::size_t bytes = made->bytes();
    return std::pair(std::move(made), bytes);
  });
}

std::size_t nearest_post(const SurfaceTile& tile, const mars::ChartPoint& point) {
  const auto nearest = [](const PlaceBetweenLines& at) { return at.interval + (at.fraction > 0.5 ? 1 : 0); };
  return nearest(place_between(tile.lines.v, point.v)) * static_cast<std::size_t>(tile.data.posts.side()) +
         nearest(place_between(tile.lines.u, point.u));
}

bool is_nodata(const SurfaceTile& tile, const mars::ChartPoint& point) {
  if (tile.data.nodata.empty()) return false;
  const auto [i, x] = place_between(tile.lines.u, point.u);
  const auto [j, y] = place_between(tile.lines.v, point.v);
  const auto side = static_cast<std::size_t>(tile.data.posts.side());
  return lod::is_flagged(tile.data.nodata, j * side + i, side, x, y);
}

SurfacePoint point_in(const SurfaceTile& tile, const mars::ChartPoint& point, double planet_radius_m,
                      double exaggeration) {
  SurfacePoint out;
  out.tile = tile.data.posts.key;
  out.height_m = lod::surface_height(tile.data.posts, tile.lines, point.u, point.v, planet_radius_m,
                                     &out.normal, exaggeration);
  out.radius_m = planet_radius_m + out.height_m;
  out.nodata = is_nodata(tile, point);
  return out;
}

SurfacePoint Surface::at(const glm::dvec3& direction, double exaggeration) const {
  const mars::ChartPoint point = mars::chart_point(direction);
  const auto tile = this->tile(finest_tile(planet_->tree(), point), exaggeration);
  return point_in(*tile, point, planet_radius_m(), exaggeration);
}

double Surface::readable_radius_m(const glm::dvec3& direction, double exaggeration) const {
  const mars::ChartPoint point = mars::chart_point(direction);
  for (lod::TileKey key = finest_tile(planet_->tree(), point);; key = lod::ancestor(key, key.level - 1)) {
    try {
      const auto tile = this->tile(key, exaggeration);
      return planet_radius_m() + lod::surface_height(tile->data.posts, tile->lines, point.u, point.v,
                                                     planet_radius_m(), nullptr, exaggeration);
    } catch (const PlanetError&) {
      if (key.level == 0) throw;
    }
  }
}

bool Surface::is_below(const glm::dvec3& place_m, double exaggeration) const {
  const double distance_m = glm::length(place_m);
  if (!(distance_m > 0)) return true;
  const lod::TileKey key = finest_tile(planet_->tree(), mars::chart_point(place_m));
  if (distance_m > planet_radius_m() + exaggeration * planet_->tree().find(key)->max_height_m) return false;
  return distance_m < at(place_m / distance_m, exaggeration).radius_m;
}

void Surface::radius(std::span<const glm::dvec3> directions, std::span<double> radius_m,
                     double exaggeration) const {
  std::shared_ptr<const SurfaceTile> held;
  for (std::size_t n = 0; n < directions.size(); ++n) {
    const mars::ChartPoint point = mars::chart_point(directions[n]);
    const bool same = held && held->data.posts.key.face == point.face &&
                      lod::tile_at(point, held->data.posts.key.level) == held->data.posts.key;
    if (!same) held = tile(finest_tile(planet_->tree(), point), exaggeration);
    radius_m[n] = planet_radius_m() + lod::surface_height(held->data.posts, held->lines, point.u, point.v,
                                                          planet_radius_m(), nullptr, exaggeration);
  }
}

}  // namespace paging
