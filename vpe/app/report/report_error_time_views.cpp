#include "vpe/app/report/report_error_time_views.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "lod/tree/tile_key.h"
#include "mars/geodesy/sphere.h"
#include "vpe/base/number.h"

namespace vpe::app {

namespace {

struct Place {
  const char* name;
  const char* about;
  double lon_deg, lat_deg, height_m, yaw_deg, pitch_deg;
  bool panorama;
};

constexpr Place kEmbedded[] = {
    {"orbit", "400 km above Valles Marineris", -65, -12, 400000, 20, -70, false},
    {"high oblique", "25 km above the plain south of Coprates Chasma", -66, -14.5, 25000, 330, -30, false},
    {"canyon floor", "200 m above the floor of Coprates Chasma", -64.2, -12.9, 200, 281, 2, true},
    {"rim", "800 m above the wall of Coprates Chasma", -59.2, -13.7, 800, 90, -8, true},
    {"crater", "3 km above the rim of Gale, towards its mound", 137.4, -4, 3000, 180, -10, true},
    {"plain", "1.5 km above the plateau south of Coprates Chasma, away from it", -61, -16.2, 1500, 150, -6,
     true},
    {"grazing", "300 m above a slope of Coprates Chasma, level", -64.5, -13, 300, 110, 0, false},
    {"polar", "1500 km above the north pole", 0, 89.9995, 1.5e6, 40, -80, false},
};

struct GroundPoint {
  mars::LonLat place;
  double height_m = 0;
};

GroundPoint ground_at(const paging::Surface& surface, const mars::ChartRect& rect, double u, double v) {
  const glm::dvec3 direction =
      mars::chart_direction(rect.face, std::lerp(rect.u0, rect.u1, u), std::lerp(rect.v0, rect.v1, v));
  return {mars::lon_lat(direction), surface.at(direction).height_m};
}

// The extremes of a finest tile of the deepest level.
struct Landmarks {
  GroundPoint lowest, highest, middle;
};

Landmarks landmarks(const paging::Surface& surface, const lod::TileKey& key) {
  constexpr int kSteps = 32;
  const mars::ChartRect rect = lod::chart_rect(key);
  Landmarks found;
  found.lowest = found.highest = found.middle = ground_at(surface, rect, 0.5, 0.5);
  for (int j = 1; j < kSteps; ++j) {
    for (int i = 1; i < kSteps; ++i) {
      const GroundPoint ground =
          ground_at(surface, rect, static_cast<double>(i) / kSteps, static_cast<double>(j) / kSteps);
      if (ground.height_m < found.lowest.height_m) found.lowest = ground;
      if (ground.height_m > found.highest.height_m) found.highest = ground;
    }
  }
  return found;
}

// Returns the deepest tile with the largest or smallest range of heights among those with data in their middle.
lod::TileKey deepest_tile(const paging::Surface& surface, bool roughest) {
  std::vector<lod::TileInfo> tiles;
  for (const lod::TileInfo& tile : surface.planet().tree().tiles()) {
    if (tile.key.level == surface.planet().meta().finest_level) tiles.push_back(tile);
  }
  std::stable_sort(tiles.begin(), tiles.end(), [&](const lod::TileInfo& a, const lod::TileInfo& b) {
    const double range_a_m = a.max_height_m - a.min_height_m;
    const double range_b_m = b.max_height_m - b.min_height_m;
    return roughest ? range_a_m > range_b_m : range_a_m < range_b_m;
  });
  for (const lod::TileInfo& tile : tiles) {
    const mars::ChartRect rect = lod::chart_rect(tile.key);
    const glm::dvec3 middle =
        mars::chart_direction(rect.face, std::midpoint(rect.u0, rect.u1), std::midpoint(rect.v0, rect.v1));
    if (!surface.at(middle).nodata) return tile.key;
  }
  return tiles.front().key;
}

}  // namespace

std::vector<NamedView> embedded_views(const paging::Surface& surface) {
  std::vector<NamedView> views;
  for (const Place& p : kEmbedded) {
    const double ground_m = surface.at(mars::direction({p.lon_deg, p.lat_deg})).height_m;
    views.push_back({p.name, p.about,
                     mars::Pose{p.lon_deg, p.lat_deg, ground_m + p.height_m, p.yaw_deg, p.pitch_deg, 0},
                     p.panorama});
  }
  return views;
}

std::vector<NamedView> views_of(const paging::Surface& surface) {
  const paging::PlanetMeta& meta = surface.planet().meta();
  const double spacing_m = lod::post_spacing_m(meta.finest_level, meta.tile.intervals(), meta.radius_m);
  const double tile_m = spacing_m * meta.tile.intervals();
  const Landmarks rough = landmarks(surface, deepest_tile(surface, true));
  const Landmarks smooth = landmarks(surface, deepest_tile(surface, false));
  const GroundPoint pole{{0, 89.9995}, surface.at(mars::direction({0, 89.9995})).height_m};
  std::vector<NamedView> views;
  const auto add = [&](const char* name, const GroundPoint& from, double height_m, double yaw_deg,
                       double pitch_deg, bool panorama) {
    const std::string about = base::format_rounded(height_m, 0) + " m above the ground at " +
                              base::format_rounded(from.place.lon_deg, 3) + ", " +
                              base::format_rounded(from.place.lat_deg, 3);
    views.push_back(
        {name, about,
         mars::Pose{from.place.lon_deg, from.place.lat_deg, from.height_m + height_m, yaw_deg, pitch_deg, 0},
         panorama});
  };
  const double up_deg = mars::initial_bearing_deg(rough.lowest.place, rough.highest.place);
  const double down_deg = mars::initial_bearing_deg(rough.highest.place, rough.lowest.place);
  add("orbit", rough.middle, 0.12 * meta.radius_m, 20, -70, false);
  add("high oblique", rough.lowest, tile_m, down_deg, -30, false);
  add("canyon floor", rough.lowest, 2 * spacing_m, up_deg, 2, true);
  add("rim", rough.highest, 2 * spacing_m, down_deg, -8, true);
  add("crater", rough.middle, 8 * spacing_m, up_deg, -10, true);
  add("plain", smooth.middle, 8 * spacing_m, 120, -6, true);
  add("grazing", rough.middle, spacing_m, down_deg, 0, false);
  add("polar", pole, 0.01 * meta.radius_m, 40, -25, false);
  return views;
}

}  // namespace vpe::app
