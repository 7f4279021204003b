#include "vpe/gl/tile_needs.h"

#include <algorithm>
#include <glm/geometric.hpp>

#include "paging/shading/texel_block.h"
#include "vpe/base/mutation.h"

namespace vpe::gl {

namespace {

constexpr int kLargestTexture = 1024;

// The tile's centre, unless rounding relative to it would be visible: then the post nearest to the camera.
int origin(const lod::SelectedTile& tile, const core::View& view, const paging::PlanetFile& planet) {
  constexpr double kShows_px = 0.01;
  if (base::mutated(base::Guard::kNearOrigin)) return kTileCentre;
  const double side_m = lod::nominal_side_m(tile.key.level, planet.radius_m());
  if (side_m * core::focal_px(view) < kShows_px * (1 << 24) * tile.min_distance_m) return kTileCentre;
  if (glm::dot(mars::face_axes(tile.key.face).out, view.camera.position_m) <= 0.0) return kTileCentre;
  const int intervals = planet.meta().tile.intervals();
  const lod::GridLines lines = lod::grid_lines(tile.key, intervals);
  const mars::ChartPoint camera = mars::chart_on(tile.key.face, view.camera.position_m);
  const auto nearest = [](const std::vector<double>& line, double x) {
    auto at = std::lower_bound(line.begin(), line.end(), x);
    if (at == line.end() || (at != line.begin() && x - *(at - 1) < *at - x)) --at;
    return static_cast<int>(at - line.begin());
  };
  return nearest(lines.v, camera.v) * (intervals + 1) + nearest(lines.u, camera.u);
}

// Returns the intervals of the texture of a tile that is coloured at posts. Finer than posts it has three quarters of a texel a
// pixel at the tile's nearest point; coarser it has a texel a pixel, as colours of rays have (TerrainShader::colour_at()).
int grid_intervals(const lod::SelectedTile& tile, double focal, const paging::PlanetFile& planet,
                   const TerrainShader& terrain_shader, const TileMaterial& material) {
  const double side_m = lod::nominal_side_m(tile.key.level, planet.radius_m());
  const double side_px = side_m * focal / std::max(tile.min_distance_m, 1e-3 * side_m);
  const paging::ColourSource source = material.shading.colour_source;
  const int most = std::min(kLargestTexture, terrain_shader.useful_intervals(tile.key, source));
  const int posts = planet.meta().tile.intervals();
  int intervals = std::max(kSmallestTexture, posts);
  // Colours of posts are not made finer than posts.
  if (source == paging::ColourSource::kImageAtPosts) intervals = std::min(intervals, most);
  while (intervals < 0.75 * side_px && intervals < most) intervals *= 2;
  // Nodata is shown as finely as posts are.
  if (planet.has_nodata(tile.key) || paging::shows_difference(material.shading)) return intervals;
  const int least = paging::least_intervals(tile.key, posts);
  const double coarsest = tile.key.level < paging::kFirstEvenTexture ? 2 * side_px : side_px;
  while (intervals / 2 >= coarsest && intervals > least) intervals /= 2;
  return intervals;
}

// Takes the light out of the parameters of textures. What is not used has its default.
VertexLight take_light(ShadingParams& shading) {
  const VertexLight light{shading.sun, shading.ambient, shading.diffuse, shading.shadows};
  const ShadingParams defaults;
  shading.lit = false;
  shading.sun = defaults.sun;
  shading.ambient = defaults.ambient;
  shading.diffuse = defaults.diffuse;
  shading.shadows = defaults.shadows;
  return light;
}

}  // namespace

TileMaterial material(const core::Appearance& a, const glm::dvec3& sun, bool has_image,
                      std::shared_ptr<const core::ColourScale> scale) {
  TileMaterial out;
  out.shows_nodata = a.mode != core::Mode::kWireframe && a.mode != core::Mode::kMarkers;
  out.shading = paging::shading_params(a, sun, has_image, std::move(scale));
  if (a.shading == core::Shading::kVertex && out.shading.lit) out.light = take_light(out.shading);
  const ShadingParams& shading = out.shading;
  out.method = shading.lit                                             ? PaintMethod::kTexture
               : shading.colour_source == paging::ColourSource::kPlain ? PaintMethod::kColour
               : shading.colour_source == paging::ColourSource::kElevation && !shading.flat
                   ? PaintMethod::kPalette
                   : PaintMethod::kTexture;
  if (out.method == PaintMethod::kPalette && shading.scale)
    out.palette_error_m = std::abs(shading.scale->high() - shading.scale->low()) / 256;
  return out;
}

std::optional<glm::dvec3> shadow_sun(const TileMaterial& material) {
  if (!material.light || !material.light->shadows) return std::nullopt;
  return material.light->sun;
}

bool is_textured(const lod::TileKey& tile, const paging::PlanetFile& planet, const TileMaterial& material) {
  if (material.method == PaintMethod::kTexture || (material.shows_nodata && planet.has_nodata(tile)))
    return true;
  if (material.method != PaintMethod::kPalette) return false;
  const lod::TileInfo* info = planet.tree().find(tile);
  return info != nullptr && info->variants.front().terms.height_error_m > material.palette_error_m;
}

bool needs_charts(const lod::TileKey& tile, const paging::PlanetFile& planet, const TileMaterial& material) {
  if (!is_textured(tile, planet, material)) return false;
  // Programs compute texture coordinates of coarse tiles from positions (TileFeatures::placed): texels are
  // wide.
  return (material.method != PaintMethod::kPalette && !material.shading.flat) || planet.has_nodata(tile) ||
         paging::shows_difference(material.shading);  // the other planet may have nodata
}

std::vector<TileNeed> tile_needs(std::span<const lod::SelectedTile> tiles, const core::View& view,
                                 const paging::PlanetFile& planet, const TerrainShader& terrain_shader,
                                 const NeedOptions& options) {
  const double focal = core::focal_px(view);
  std::vector<TileNeed> needs;
  needs.reserve(tiles.size());
  for (const lod::SelectedTile& tile : tiles) {
    TileNeed need{{tile.variant, origin(tile, view, planet), needs_charts(tile.key, planet, options.material),
                   options.material.light.has_value()},
                  0};
    if (!is_textured(tile.key, planet, options.material)) {
    } else if (options.material.shading.flat) {
      need.texture = facet_texture(tile.variant);
    } else {
      need.texture = grid_intervals(tile, focal, planet, terrain_shader, options.material);
    }
    needs.push_back(need);
  }
  for (int cap = kLargestTexture; cap > kSmallestTexture; cap /= 2) {
    std::size_t bytes = 0;
    for (const TileNeed& need : needs) {
      if (need.texture <= 0) continue;
      const auto side = static_cast<std::size_t>(need.texture) + 1;
      bytes += 4 * side * side;
    }
    if (bytes <= options.texture_bytes) break;
    for (TileNeed& need : needs) need.texture = std::min(need.texture, cap / 2);
  }
  return needs;
}

}  // namespace vpe::gl
