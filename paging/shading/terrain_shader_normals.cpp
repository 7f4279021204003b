#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "paging/shading/terrain_shader.h"
#include "paging/surface/height_difference.h"

namespace paging {

namespace {

glm::dvec3 position(mars::Face face, double u, double v, double radius) {
  const glm::dvec3 p = mars::cube_point(face, u, v);
  return p * (radius / mars::cube_length(p));
}

double bilinear_height(const lod::Posts& posts, const lod::GridLines& lines, double u, double v) {
  const auto find = [](const std::vector<double>& line, double x) {
    const auto above = std::upper_bound(line.begin() + 1, line.end() - 1, x);
    const auto i = static_cast<std::size_t>(above - line.begin()) - 1;
    return std::pair(static_cast<int>(i), std::clamp((x - line[i]) / (line[i + 1] - line[i]), 0.0, 1.0));
  };
  const auto [i, s] = find(lines.u, u);
  const auto [j, t] = find(lines.v, v);
  return (posts.at(i, j) * (1 - s) + posts.at(i + 1, j) * s) * (1 - t) +
         (posts.at(i, j + 1) * (1 - s) + posts.at(i + 1, j + 1) * s) * t;
}

}  // namespace

std::size_t NormalTile::bytes() const {
  return sizeof(NormalTile) + posts.capacity() * sizeof(Post) + sees_sun.capacity() * sizeof(std::uint8_t) +
         nodata.capacity() / 8;
}

std::vector<double> TerrainShader::heights_across(const lod::TileKey& key, lod::Edge edge,
                                                  std::vector<glm::dvec3>& points) const {
  const int n = planet_->meta().tile.intervals();
  const lod::Neighbour across = lod::neighbour(key, edge);
  const lod::GridLines lines = lod::grid_lines(across.key, n);
  const lod::TileKey stored = deepest(across.key);
  const auto posts = heights(stored);
  const lod::GridLines stored_lines = lod::grid_lines(stored, n);
  std::vector<double> out(static_cast<std::size_t>(n) + 1);
  points.resize(out.size());
  for (int a = 0; a <= n; ++a) {
    const int along = across.reversed ? n - a : a;
    int i = along;
    int j = along;
    switch (across.edge) {
      case lod::Edge::kWest: i = 1; break;
      case lod::Edge::kEast: i = n - 1; break;
      case lod::Edge::kSouth: j = 1; break;
      case lod::Edge::kNorth: j = n - 1; break;
    }
    const double u = lines.u[static_cast<std::size_t>(i)];
    const double v = lines.v[static_cast<std::size_t>(j)];
    out[static_cast<std::size_t>(a)] =
        stored == across.key ? posts->posts.at(i, j) : bilinear_height(posts->posts, stored_lines, u, v);
    points[static_cast<std::size_t>(a)] = mars::cube_point(across.key.face, u, v);
  }
  return out;
}

NormalTile TerrainShader::make_normals(const lod::TileKey& key, const ShadingParams& params) const {
  const double exaggeration = params.exaggeration;
  auto source = heights(key);
  if (exaggeration != 1.0 && source->coarser_neighbour_mask != 0) {
    auto drawn = std::make_shared<TileHeights>(*source);
    put_on_coarser_edges(*drawn, planet_->radius_m(), exaggeration);
    source = std::move(drawn);
  }
  const lod::Posts& posts = source->posts;
  const int n = posts.intervals;
  const auto side = static_cast<std::size_t>(n) + 1;
  const auto wide = side + 2;  // with one row of neighbours on each side; the four corners are not used
  const double radius = planet_->radius_m();
  const lod::GridLines lines = lod::grid_lines(key, n);
  const mars::ChartRect rect = lod::chart_rect(key);
  const glm::dvec3 origin = position(key.face, 0.5 * (rect.u0 + rect.u1), 0.5 * (rect.v0 + rect.v1), radius);
  const auto place = [&](const glm::dvec3& p, double h) {
    return glm::vec3(p * ((radius + exaggeration * h) / mars::cube_length(p)) - origin);
  };

  std::vector<glm::vec3> points(wide * wide);
  for (std::size_t j = 0; j < side; ++j) {
    for (std::size_t i = 0; i < side; ++i) {
      points[(j + 1) * wide + i + 1] =
          place(mars::cube_point(key.face, lines.u[i], lines.v[j]), posts.height_m[j * side + i]);
    }
  }
  std::vector<glm::dvec3> across;
  for (const lod::Edge edge : lod::kEdges) {
    const std::vector<double> heights = heights_across(key, edge, across);
    for (std::size_t a = 0; a < side; ++a) {
      std::size_t at = 0;
      switch (edge) {
        case lod::Edge::kWest: at = (a + 1) * wide; break;
        case lod::Edge::kEast: at = (a + 1) * wide + wide - 1; break;
        case lod::Edge::kSouth: at = a + 1; break;
        case lod::Edge::kNorth: at = (wide - 1) * wide + a + 1; break;
      }
      points[at] = place(across[a], heights[a]);
    }
  }

  NormalTile out{key, static_cast<int>(side), {}, {}, source->nodata};
  out.posts.reserve(side * side);
  for (std::size_t j = 1; j <= side; ++j) {
    const glm::vec3* row = &points[j * wide];
    for (std::size_t i = 1; i <= side; ++i) {
      out.posts.push_back({glm::normalize(glm::cross(row[i + 1] - row[i - 1], row[i + wide] - row[i - wide])),
                           static_cast<float>(posts.height_m[out.posts.size()])});
    }
  }
  if (shows_difference(params)) subtract_earlier(out);
  if (!params.lit || !params.shadows) return out;
  const double spacing_m = lod::nominal_side_m(key.level, radius) / n;
  out.sees_sun.reserve(side * side);
  for (std::size_t j = 0; j < side; ++j) {
    for (std::size_t i = 0; i < side; ++i) {
      const glm::dvec3 post = glm::dvec3(points[(j + 1) * wide + i + 1]) + origin;
      const bool faces = glm::dot(glm::dvec3(out.posts[j * side + i].normal), params.sun) > 0.0;
      out.sees_sun.push_back(faces && sees_sun(post, spacing_m, params) ? 1 : 0);
    }
  }
  return out;
}

void TerrainShader::subtract_earlier(NormalTile& tile) const {
  if (!earlier_) {
    throw PlanetError(
        planet_->path() +
        ": there is no earlier planet to subtract; colour=difference needs --compare EARLIER, of 'vpe "
        "render' or 'vpe explore'");
  }
  const std::vector<double>& later_m = heights(tile.key)->posts.height_m;
  const PostHeights earlier = heights_at_posts(*earlier_, tile.key, tile.side - 1);
  for (std::size_t n = 0; n < tile.posts.size(); ++n)
    tile.posts[n].height_m = static_cast<float>(later_m[n] - earlier.height_m[n]);
  if (earlier.nodata.empty()) return;
  tile.nodata.resize(tile.posts.size());
  for (std::size_t n = 0; n < tile.posts.size(); ++n) tile.nodata[n] = tile.nodata[n] || earlier.nodata[n];
}

// Casts from slightly above the surface, because the facets at the place itself would stop the ray.
bool TerrainShader::sees_sun(const glm::dvec3& place_m, double spacing_m, const ShadingParams& params) const {
  constexpr double kLift = 1e-3;
  const double radius = glm::length(place_m);
  const glm::dvec3 camera = place_m * ((radius + kLift * spacing_m) / radius);
  return std::isinf(surface_.cast(camera, params.sun, params.exaggeration));
}

}  // namespace paging
