#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "paging/shading/terrain_grid.h"
#include "paging/shading/terrain_shader.h"

namespace paging {

namespace {

// The level from which on posts, `intervals` a tile, are no farther apart.
int level_for(double footprint_m, int intervals, double radius_m) {
  const double root_m = lod::nominal_side_m(0, radius_m) / intervals;
  return std::clamp(static_cast<int>(std::ceil(std::log2(root_m / footprint_m))), 0, lod::kMaxLevel);
}

}  // namespace

glm::dvec3 TerrainShader::image_at(const glm::dvec3& direction, double footprint_m, Cursor& cursor) const {
  const mars::ChartPoint place = mars::chart_point(direction);
  const int level = level_for(footprint_m, kImageIntervals, planet_->radius_m());
  const auto key = planet_->image_key(lod::tile_at(place, level));
  if (!key) throw PlanetError(planet_->path() + ": has no image; use --set mode=coloured");
  if (!cursor.image || cursor.image_key != *key) {
    cursor.image = image(*key);
    cursor.image_key = *key;
  }
  return bilinear<glm::vec3>(between_lines(place.u, key->level, key->i, kImageIntervals),
                             between_lines(place.v, key->level, key->j, kImageIntervals), kImageSide,
                             [&](std::size_t k) { return rgb(cursor.image->texels[k]); });
}

std::optional<glm::dvec3> TerrainShader::colour_at(const glm::dvec3& direction, double footprint_m,
                                                   const ShadingParams& params, Cursor& cursor) const {
  const int n = planet_->meta().tile.intervals();
  const double radius = planet_->radius_m();
  const mars::ChartPoint place = mars::chart_point(direction);
  const int level = params.flat ? lod::kMaxLevel : level_for(footprint_m, n, radius);
  const lod::TileKey key = deepest(lod::tile_at(place, level));
  if (!cursor.ground || cursor.ground_key != key) {
    cursor.ground = normals(key, params);
    cursor.ground_key = key;
  }
  const NormalTile& ground = *cursor.ground;
  const auto side = static_cast<std::size_t>(ground.side);
  const GridPosition x = between_lines(place.u, key.level, key.i, n);
  const GridPosition y = between_lines(place.v, key.level, key.j, n);
  if (!ground.nodata.empty() && ground.nodata[nearest(y) * side + nearest(x)]) return std::nullopt;
  Ground at;
  at.up = direction;
  const int grid_level = key.level + planet_->meta().tile.k;
  const auto post = [&](std::size_t a, std::size_t b) {
    const auto line = [&](std::int32_t tile, std::size_t k) {
      return mars::face_line(std::int64_t{tile} * n + static_cast<std::int64_t>(k), grid_level);
    };
    return mars::chart_direction(key.face, line(key.i, x.index + a), line(key.j, y.index + b));
  };
  if (params.flat) {
    const bool lower = x.rest >= y.rest;
    std::array<glm::dvec3, 3> corners;
    at.height_m = 0;
    const std::array<std::array<std::size_t, 2>, 3> posts{
        {{0, 0}, {lower ? std::size_t{1} : std::size_t{0}, lower ? std::size_t{0} : std::size_t{1}}, {1, 1}}};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [a, b] = posts[k];
      const double height = static_cast<double>(ground.posts[(y.index + b) * side + x.index + a].height_m);
      corners[k] = post(a, b) * (radius + params.exaggeration * height);
      at.height_m += height / 3;
    }
    const glm::dvec3 middle = (corners[0] + corners[1] + corners[2]) / 3.0;
    at.up = glm::normalize(middle);
    at.normal = glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
    if (glm::dot(at.normal, at.up) < 0.0) at.normal = -at.normal;
    if (params.lit && params.shadows && glm::dot(at.normal, params.sun) > 0.0)
      at.sun = sees_sun(middle, lod::nominal_side_m(key.level, radius) / n, params) ? 1.0 : 0.0;
    if (shows_image(params.colour_source)) at.image = image_at(at.up, footprint_m, cursor);
    return colour(at, params);
  }
  at.height_m = bilinear<float>(x, y, side, [&](std::size_t k) { return ground.posts[k].height_m; });
  at.normal = bilinear<glm::vec3>(x, y, side, [&](std::size_t k) { return ground.posts[k].normal; });
  if (!ground.sees_sun.empty())
    at.sun = bilinear<float>(x, y, side, [&](std::size_t k) { return static_cast<float>(ground.sees_sun[k]); });
  if (params.colour_source == ColourSource::kImage) at.image = image_at(direction, footprint_m, cursor);
  if (params.colour_source == ColourSource::kImageAtPosts) {
    for (std::size_t b = 0; b < 2; ++b) {
      for (std::size_t a = 0; a < 2; ++a) {
        const float share = (a == 1 ? x.rest : 1.0F - x.rest) * (b == 1 ? y.rest : 1.0F - y.rest);
        at.image += static_cast<double>(share) * image_at(post(a, b), footprint_m, cursor);
      }
    }
  }
  return colour(at, params);
}

}  // namespace paging
