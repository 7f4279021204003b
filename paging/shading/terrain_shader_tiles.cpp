#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "paging/shading/terrain_grid.h"
#include "paging/shading/terrain_shader.h"
#include "paging/shading/texel_block.h"
#include "vpe/core/appearance/shading.h"

namespace paging {

namespace {

bool needs_vertical(ColourSource s) { return s == ColourSource::kSlope || s == ColourSource::kAspect; }

}  // namespace

void TerrainShader::shade_block(const TexelBlock& block, int x0, int y0, int side, const ShadingParams& params,
                                ShadedTile& out) const {
  const int n = planet_->meta().tile.intervals();
  const lod::TileKey& tile = block.tile;
  const lod::TileKey stored = deepest(tile);
  const std::shared_ptr<const NormalTile> ground = normals(stored, params);
  const ImageBlock image_block = this->image_block(block.image, params);
  // Where this block lies inside what is stored, in steps of the block's own texels.
  const auto offset = [&](std::int32_t index, int first, const lod::TileKey& outer) {
    const int levels = tile.level - outer.level;
    return (index - ((index >> levels) << levels)) * n + first;
  };
  const int ground_steps = n << (tile.level - stored.level);
  const int gx = offset(tile.i, block.first_x, stored);
  const int gy = offset(tile.j, block.first_y, stored);
  const int image_steps = image_block.tile ? n << (tile.level - image_block.key.level) : 1;
  const int px = image_block.tile ? offset(tile.i, block.first_x, image_block.key) : 0;
  const int py = image_block.tile ? offset(tile.j, block.first_y, image_block.key) : 0;
  const bool direct = stored == tile;
  const bool needs_up = needs_vertical(params.colour_source) || needs_vertical(params.hue);
  const lod::GridLines lines = needs_up ? lod::grid_lines(tile, n) : lod::GridLines{};

  const auto ground_side = static_cast<std::size_t>(ground->side);
  const auto channels = static_cast<std::size_t>(out.channels);
  // The same in all rows.
  std::vector<GridPosition> ground_columns;
  std::vector<GridPosition> image_columns;
  for (int x = 0; x <= block.intervals; ++x) {
    ground_columns.push_back(grid_position(gx, x, ground_steps, ground->side - 1));
    if (image_block.tile) image_columns.push_back(grid_position(px, x, image_steps, kImageIntervals));
  }
  Ground at;
  for (int y = 0; y <= block.intervals; ++y) {
    const GridPosition gyp = grid_position(gy, y, ground_steps, ground->side - 1);
    const GridPosition pyp = grid_position(py, y, image_steps, kImageIntervals);
    std::uint8_t* texel =
        &out.texels[channels * (static_cast<std::size_t>(y0 + y) * static_cast<std::size_t>(side) +
                                static_cast<std::size_t>(x0))];
    for (int x = 0; x <= block.intervals; ++x, texel += channels) {
      const GridPosition& gxp = ground_columns[static_cast<std::size_t>(x)];
      at.height_m =
          bilinear<float>(gxp, gyp, ground_side, [&](std::size_t k) { return ground->posts[k].height_m; });
      at.normal =
          direct
              ? ground->posts[static_cast<std::size_t>(gy + y) * ground_side + static_cast<std::size_t>(gx + x)]
                    .normal
              : bilinear<glm::vec3>(gxp, gyp, ground_side,
                                    [&](std::size_t k) { return ground->posts[k].normal; });
      if (!ground->sees_sun.empty())
        at.sun = bilinear<float>(gxp, gyp, ground_side,
                                 [&](std::size_t k) { return static_cast<float>(ground->sees_sun[k]); });
      if (needs_up)
        at.up = mars::chart_direction(tile.face, lines.u[static_cast<std::size_t>(block.first_x + x)],
                                      lines.v[static_cast<std::size_t>(block.first_y + y)]);
      if (image_block.tile) {
        const GridPosition& pxp = image_columns[static_cast<std::size_t>(x)];
        at.image = bilinear<glm::vec3>(pxp, pyp, kImageSide,
                                       [&](std::size_t k) { return rgb(image_block.tile->texels[k]); });
      }
      if (channels == 1) {
        texel[0] = to_byte(
            static_cast<float>(255.0 / out.brightest *
                               vpe::core::light(params.ambient, params.diffuse,
                                                at.sun * glm::dot(glm::normalize(at.normal), params.sun))));
        continue;
      }
      const bool has_data = !block.shows_nodata || !is_nodata(ground->nodata, gxp, gyp, ground_side);
      const glm::vec3 c(has_data || !out.nodata_image ? colour(at, params) : at.image);
      texel[0] = to_byte(c.x);
      texel[1] = to_byte(c.y);
      texel[2] = to_byte(c.z);
      texel[3] = has_data ? 255 : 0;
      out.nodata = out.nodata || !has_data;
    }
  }
}

ShadedTile TerrainShader::shade_facets(const lod::TileKey& key, const lod::TileMesh& mesh,
                                       std::span<const double> height_m, const ShadingParams& params) const {
  const double radius = planet_->radius_m();
  const lod::GridLines lines = lod::grid_lines(key, mesh.intervals);
  const double spacing_m = lod::nominal_side_m(key.level, radius) / mesh.intervals;
  const ImageBlock image_block = this->image_block(key, params);
  ShadingParams of_values = params;
  of_values.lit = false;
  const auto values = shows_difference(params) ? normals(deepest(key), of_values) : nullptr;
  const auto posts = !values && planet_->has_nodata(key) ? heights(deepest(key)) : nullptr;
  const std::vector<bool>* const nodata = values ? &values->nodata : posts ? &posts->nodata : nullptr;
  const bool may_be_nodata = nodata != nullptr && !nodata->empty();
  const int n = planet_->meta().tile.intervals();
  std::vector<glm::dvec3> places;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    places.push_back(mars::chart_direction(key.face, lines.u[mesh.vertices[v].i], lines.v[mesh.vertices[v].j]) *
                     (radius + params.exaggeration * height_m[v]));
  }
  ShadedTile out;
  out.nodata_image = shows_image(params.colour_source);
  Ground at;
  for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) {
    const std::array<std::uint32_t, 3> v{mesh.triangles[t], mesh.triangles[t + 1], mesh.triangles[t + 2]};
    at.normal = glm::normalize(glm::cross(places[v[1]] - places[v[0]], places[v[2]] - places[v[0]]));
    const glm::dvec3 middle = (places[v[0]] + places[v[1]] + places[v[2]]) / 3.0;
    at.up = glm::normalize(middle);
    if (glm::dot(at.normal, at.up) < 0.0) at.normal = -at.normal;
    at.height_m = (height_m[v[0]] + height_m[v[1]] + height_m[v[2]]) / 3.0;
    if (values) {
      const mars::ChartPoint place = mars::chart_on(key.face, middle);
      at.height_m = static_cast<double>(bilinear<float>(
          between_lines(place.u, values->key.level, values->key.i, n),
          between_lines(place.v, values->key.level, values->key.j, n), static_cast<std::size_t>(values->side),
          [&](std::size_t k) { return values->posts[k].height_m; }));
    }
    at.sun = 1.0;
    if (params.lit && params.shadows && glm::dot(at.normal, params.sun) > 0.0)
      at.sun = sees_sun(middle, spacing_m, params) ? 1.0 : 0.0;
    if (image_block.tile) {
      const mars::ChartPoint place = mars::chart_on(key.face, middle);
      at.image =
          bilinear<glm::vec3>(between_lines(place.u, image_block.key.level, image_block.key.i, kImageIntervals),
                              between_lines(place.v, image_block.key.level, image_block.key.j, kImageIntervals),
                              kImageSide, [&](std::size_t k) { return rgb(image_block.tile->texels[k]); });
    }
    bool corner_is_nodata = false;
    for (const std::uint32_t corner : v) {
      if (!may_be_nodata) break;
      // A parent's mesh is over the posts of its children.
      const int finer = mesh.intervals / n;
      const auto side = static_cast<std::size_t>(n) + 1;
      const auto post = [&](int of_mesh) { return static_cast<std::size_t>((of_mesh + finer / 2) / finer); };
      corner_is_nodata =
          corner_is_nodata || (*nodata)[post(mesh.vertices[corner].j) * side + post(mesh.vertices[corner].i)];
    }
    out.nodata = out.nodata || corner_is_nodata;
    const glm::vec3 c(corner_is_nodata && out.nodata_image ? at.image : colour(at, params));
    for (const std::uint8_t byte :
         {to_byte(c.x), to_byte(c.y), to_byte(c.z), std::uint8_t(corner_is_nodata ? 0 : 255)})
      out.texels.push_back(byte);
  }
  return out;
}

}  // namespace paging
