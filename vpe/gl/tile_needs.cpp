#include "vpe/gl/tile_needs.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace vpe::gl {

namespace {

constexpr int kLargestTexture = 1024;

// The tile's centre, unless rounding relative to that would show: then the post nearest to the eye.
int origin(const lod::SelectedTile& tile, const core::View& view, const paging::PlanetFile& planet) {
  constexpr double kShows_px = 0.01;
  const double side_m = lod::nominal_side_m(tile.key.level, planet.radius_m());
  if (side_m * core::focal_px(view) < kShows_px * (1 << 24) * tile.min_distance_m) return kTileCentre;
  if (glm::dot(mars::face_axes(tile.key.face).out, view.eye.eye_m) <= 0.0) return kTileCentre;
  const int intervals = planet.meta().tile.intervals();
  const lod::GridLines lines = lod::grid_lines(tile.key, intervals);
  const mars::ChartPoint eye = mars::chart_on(tile.key.face, view.eye.eye_m);
  const auto nearest = [](const std::vector<double>& line, double x) {
    const auto at = std::lower_bound(line.begin(), line.end(), x) - line.begin();
    return static_cast<int>(std::min(at, static_cast<std::ptrdiff_t>(line.size()) - 1));
  };
  return nearest(lines.v, eye.v) * (intervals + 1) + nearest(lines.u, eye.u);
}

}  // namespace

bool is_textured(const lod::TileKey& tile, const paging::PlanetFile& planet, core::Mode mode) {
  if (mode == core::Mode::kWireframe) return false;
  return mode != core::Mode::kUnlit || planet.has_missing(tile);
}

ShadeParams shade_params(const core::DrawRequest& request, bool has_image) {
  const core::SettingsValues& s = request.settings;
  ShadeParams params;
  params.sun = request.sun;
  params.ambient = s.sun_ambient;
  params.exaggeration = s.exaggeration;
  if (s.mode == core::Mode::kUnlit) {
    params.surfacing = Surfacing::kPlain;
    params.lit = false;
  } else if (s.mode == core::Mode::kTextured && has_image) {
    params.surfacing = Surfacing::kImage;
  } else if (s.mode == core::Mode::kLit || s.colour == core::Colour::kNone) {
    params.surfacing = Surfacing::kPlain;
  }
  return params;
}

std::vector<TileNeed> tile_needs(std::span<const lod::SelectedTile> tiles, const core::View& view,
                                 const paging::PlanetFile& planet, const Shader& shader,
                                 const NeedOptions& options) {
  const double focal = core::focal_px(view);
  std::vector<TileNeed> needs;
  needs.reserve(tiles.size());
  for (const lod::SelectedTile& tile : tiles) {
    TileNeed need{{tile.variant, origin(tile, view, planet)}, 0};
    if (is_textured(tile.key, planet, options.mode)) {
      const double side = lod::nominal_side_m(tile.key.level, planet.radius_m());
      const double wanted = 0.75 * side * focal / std::max(tile.min_distance_m, 1e-3 * side);
      const int most = std::min(kLargestTexture, shader.useful_intervals(tile.key, options.surfacing));
      need.texture_intervals = kSmallestTexture;
      while (need.texture_intervals < wanted && need.texture_intervals < most) need.texture_intervals *= 2;
    }
    needs.push_back(need);
  }
  for (int cap = kLargestTexture; cap > kSmallestTexture; cap /= 2) {
    std::size_t bytes = 0;
    for (const TileNeed& need : needs) {
      const auto side = static_cast<std::size_t>(need.texture_intervals) + 1;
      bytes += 4 * side * side;
    }
    if (bytes <= options.texture_bytes) break;
    for (TileNeed& need : needs) need.texture_intervals = std::min(need.texture_intervals, cap / 2);
  }
  return needs;
}

}  // namespace vpe::gl
