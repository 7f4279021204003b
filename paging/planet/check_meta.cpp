#include "paging/planet/check_meta.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "vpe/base/number.h"

namespace paging {

namespace {

constexpr double kRounding = 1e-12;  // of a radius

struct RadiusBounds {
  double lowest_m = 0;
  double highest_m = 0;
};

RadiusBounds radius_bounds(const PlanetMeta& meta, std::span<const lod::TileInfo> tiles) {
  RadiusBounds bounds{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const lod::TileInfo& tile : tiles) {
    if (tile.has_children) continue;
    const double spacing_m = lod::post_spacing_m(tile.key.level, meta.tile.intervals(), meta.radius_m);
    bounds.lowest_m = std::min(bounds.lowest_m,
                               meta.radius_m + tile.min_height_m - facet_sagitta_m(spacing_m, meta.radius_m));
    bounds.highest_m = std::max(bounds.highest_m, meta.radius_m + tile.max_height_m);
  }
  return bounds;
}

std::string differs(const std::string& key, double stated, double found) {
  return "meta '" + key + "' is " + vpe::base::format_number(stated) + ", but the tiles give " +
         vpe::base::format_number(found);
}

// Holds the counts of one level.
struct LevelCounts {
  std::int64_t tiles = 0;
  std::int64_t leaf_tiles = 0;
  std::int64_t image_tiles = 0;

  bool operator==(const LevelCounts&) const = default;
};
using CountsByLevel = std::array<LevelCounts, lod::kMaxLevel + 1>;

CountsByLevel count_levels(std::span<const lod::TileInfo> tiles, std::span<const std::int64_t> image_keys) {
  CountsByLevel counts{};
  for (const lod::TileInfo& tile : tiles) {
    LevelCounts& level = counts[static_cast<std::size_t>(tile.key.level)];
    ++level.tiles;
    level.leaf_tiles += tile.has_children ? 0 : 1;
  }
  for (const std::int64_t row : image_keys) {
    if (const auto key = lod::unpack(row)) ++counts[static_cast<std::size_t>(key->level)].image_tiles;
  }
  return counts;
}

// Returns the highest level for which `has` is true, or -1.
template <class Has>
int finest(const CountsByLevel& counts, const Has& has) {
  int level = lod::kMaxLevel;
  while (level >= 0 && !has(counts[static_cast<std::size_t>(level)])) --level;
  return level;
}

bool are_counts_of(const std::vector<LevelSummary>& levels, const CountsByLevel& counts) {
  CountsByLevel stated{};
  int last = -1;
  for (const LevelSummary& level : levels) {
    if (level.level <= last || level.level > lod::kMaxLevel) return false;
    last = level.level;
    stated[static_cast<std::size_t>(last)] = {level.tiles, level.leaf_tiles, level.image_tiles};
  }
  return stated == counts;
}

bool is_sane(const ResamplingError& error) {
  return error.posts >= 0 && std::isfinite(error.max_m) && error.rms_m >= 0 &&
         error.rms_m <= error.max_m * (1 + 1e-6) + 1e-6;
}

}  // namespace

std::string unsafe_meta(const PlanetMeta& meta, std::span<const lod::TileInfo> tiles,
                        std::span<const std::int64_t> image_keys) {
  const RadiusBounds bounds = radius_bounds(meta, tiles);
  const double slack_m = kRounding * meta.radius_m;
  if (!(meta.lowest_radius_m <= bounds.lowest_m + slack_m))
    return differs("lowest_radius_m", meta.lowest_radius_m, bounds.lowest_m);
  if (!(meta.highest_radius_m >= bounds.highest_m - slack_m))
    return differs("highest_radius_m", meta.highest_radius_m, bounds.highest_m);
  for (const std::int64_t row : image_keys) {
    if (!lod::unpack(row)) return "an image for a tile that does not exist";
  }
  const CountsByLevel counts = count_levels(tiles, image_keys);
  const int finest_level = finest(counts, [](const LevelCounts& c) { return c.tiles > 0; });
  if (meta.finest_level != finest_level) return differs("finest_level", meta.finest_level, finest_level);
  const int finest_image_level = finest(counts, [](const LevelCounts& c) { return c.image_tiles > 0; });
  if (meta.finest_image_level != finest_image_level)
    return differs("finest_image_level", meta.finest_image_level, finest_image_level);
  std::int64_t leaf_tiles = 0;
  for (const LevelCounts& level : counts) leaf_tiles += level.leaf_tiles;
  if (meta.leaf_tiles != leaf_tiles)
    return differs("leaf_tiles", static_cast<double>(meta.leaf_tiles), static_cast<double>(leaf_tiles));
  if (!meta.levels.empty() && !are_counts_of(meta.levels, counts))
    return "meta 'levels' does not have the counts of the tiles";
  return {};
}

std::vector<std::string> wrong_meta(const PlanetMeta& meta, std::span<const lod::TileInfo> tiles,
                                    std::vector<LevelSummary> levels) {
  std::vector<std::string> wrong;
  const RadiusBounds bounds = radius_bounds(meta, tiles);
  const double slack_m = kRounding * meta.radius_m;
  if (!(std::abs(meta.lowest_radius_m - bounds.lowest_m) <= slack_m))
    wrong.push_back(differs("lowest_radius_m", meta.lowest_radius_m, bounds.lowest_m));
  if (!(std::abs(meta.highest_radius_m - bounds.highest_m) <= slack_m))
    wrong.push_back(differs("highest_radius_m", meta.highest_radius_m, bounds.highest_m));
  if (!is_sane(meta.resampling)) wrong.push_back("meta 'resampling_max_m' and its companions cannot be true");
  if (meta.levels.empty()) return wrong;  // a file of format 1.0
  ResamplingError all;
  double squares_m2 = 0;
  bool sane = true;
  for (std::size_t n = 0; n < meta.levels.size(); ++n) {
    const ResamplingError& own = meta.levels[n].resampling;
    sane = sane && is_sane(own);
    all.max_m = std::max(all.max_m, own.max_m);
    all.posts += own.posts;
    squares_m2 += own.rms_m * own.rms_m * static_cast<double>(own.posts);
    if (n < levels.size()) {  // cannot be computed without the sources
      levels[n].resampling = own;
      levels[n].resampling_by_source = meta.levels[n].resampling_by_source;
    }
  }
  all.rms_m = all.posts > 0 ? std::sqrt(squares_m2 / static_cast<double>(all.posts)) : 0.0;
  if (!sane || all.max_m != meta.resampling.max_m || all.posts != meta.resampling.posts ||
      std::abs(all.rms_m - meta.resampling.rms_m) > 1e-6 * all.rms_m)
    wrong.push_back("meta 'levels' and 'resampling_max_m', 'resampling_rms_m', 'resampling_posts' differ");
  if (levels != meta.levels) wrong.push_back("meta 'levels' differs from what the tables hold");
  return wrong;
}

}  // namespace paging
