// Light that is interpolated over drawn triangles, by a rasteriser of its own: in double, on the CPU, from the planet's posts
// and meshes. Shares nothing with the renderers but the selection of tiles.
#pragma once

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "lod/options.h"
#include "lod/select.h"
#include "paging/surface/surface.h"
#include "vpe/core/view.h"

namespace test_support {

struct LitTriangle {
  std::array<glm::dvec3, 3> corners;  // body-fixed
  std::array<double, 3> light{};      // NaN: not known
};

// Computes the light of the vertices of drawn meshes from its definition (docs/design/appearance.md).
class VertexLightReference {
 public:
  VertexLightReference(const paging::Surface& surface, const vpe::core::DrawRequest& request)
      : surface_(surface), planet_(surface.planet()), request_(request) {}

  // Returns the triangles that a complete image without occlusion draws.
  std::vector<LitTriangle> drawn() const {
    lod::SelectScratch scratch;
    lod::Selection selection;
    lod::select(lod::select_options(request_, planet_.radius_m(), std::int64_t{1} << 40), planet_.tree(),
                lod::select_view(request_.view), scratch, selection);
    std::vector<LitTriangle> all;
    for (const lod::SelectedTile& tile : selection.tiles) add(tile, all);
    return all;
  }

 private:
  double exaggeration() const { return request_.settings.exaggeration; }

  void add(const lod::SelectedTile& tile, std::vector<LitTriangle>& all) const {
    lod::TileMesh mesh;
    std::vector<double> height_m;
    if (lod::is_full_grid(planet_.tree()[tile.index], tile.variant)) {
      mesh = lod::mesh_full(planet_.meta().tile.intervals());
      height_m = planet_.heights(tile.key, exaggeration()).posts.height_m;
    } else {
      paging::PackedMesh packed = planet_.mesh(tile.key, tile.variant);
      for (const std::int32_t q : packed.height_q) height_m.push_back(q * planet_.meta().quantum_m);
      mesh = std::move(packed.mesh);
    }
    const lod::GridLines lines = lod::grid_lines(tile.key, mesh.intervals);
    std::vector<glm::dvec3> places;
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
      places.push_back(
          mars::chart_direction(tile.key.face, lines.u[mesh.vertices[v].i], lines.v[mesh.vertices[v].j]) *
          (planet_.radius_m() + exaggeration() * height_m[v]));
    }
    std::vector<double> light;
    for (std::size_t v = 0; v < places.size(); ++v) light.push_back(light_of(tile.key, mesh, places, v));
    for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) {
      LitTriangle& triangle = all.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) {
        triangle.corners[k] = places[mesh.triangles[t + k]];
        triangle.light[k] = light[mesh.triangles[t + k]];
      }
    }
  }

  double light_of(const lod::TileKey& key, const lod::TileMesh& mesh, const std::vector<glm::dvec3>& places,
                  std::size_t v) const {
    const int i = mesh.vertices[v].i, j = mesh.vertices[v].j;
    const bool on_border = i == 0 || j == 0 || i == mesh.intervals || j == mesh.intervals;
    const std::optional<glm::dvec3> normal =
        on_border ? normal_of_posts(key, i, j, mesh.intervals) : mean_normal(mesh, places, v);
    if (!normal) return std::numeric_limits<double>::quiet_NaN();
    double incidence = std::max(0.0, glm::dot(*normal, request_.sun));
    if (request_.settings.shadows && incidence > 0 && !sees_sun(key, mesh.intervals, places[v])) incidence = 0;
    return std::sqrt(request_.settings.sun_ambient + request_.settings.sun_diffuse * incidence);
  }

  // Returns the mean of the normals of the triangles round a vertex, weighted by area.
  static std::optional<glm::dvec3> mean_normal(const lod::TileMesh& mesh, const std::vector<glm::dvec3>& places,
                                               std::size_t v) {
    glm::dvec3 sum(0);
    for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) {
      if (mesh.triangles[t] != v && mesh.triangles[t + 1] != v && mesh.triangles[t + 2] != v) continue;
      const glm::dvec3 &a = places[mesh.triangles[t]], &b = places[mesh.triangles[t + 1]],
                       &c = places[mesh.triangles[t + 2]];
      const glm::dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
      const double area = 0.5 * glm::length(glm::cross(b - a, c - b));
      sum += area * (glm::dot(normal, a) < 0 ? -normal : normal);
    }
    return glm::normalize(sum);
  }

  // Returns the normal of the posts of a tile at place i, j of a grid that may be finer than they are; nullopt at the edge of
  // a face and beside coarser tiles.
  std::optional<glm::dvec3> normal_of_posts(const lod::TileKey& key, int i, int j, int intervals) const {
    const int n = planet_.meta().tile.intervals();
    const int step = intervals / n;  // between posts
    glm::dvec3 sum(0);
    for (const int di : {i - i % step, i - i % step + (i % step == 0 ? 0 : step)}) {
      for (const int dj : {j - j % step, j - j % step + (j % step == 0 ? 0 : step)}) {
        const auto post = [&](int a, int b) { return this->post(key, di / step + a, dj / step + b); };
        const auto east = post(1, 0), west = post(-1, 0), north = post(0, 1), south = post(0, -1);
        if (!east || !west || !north || !south) return std::nullopt;
        const double x = step == 1 || i % step == 0 ? 0.5 : weight(i, di, step);
        const double y = step == 1 || j % step == 0 ? 0.5 : weight(j, dj, step);
        sum += x * y * glm::normalize(glm::cross(*east - *west, *north - *south));
      }
    }
    return glm::normalize(sum);
  }
  static double weight(int at, int post, int step) { return 1.0 - std::abs(at - post) / double(step); }

  // Returns the place of a post, which may lie in the tile across a border.
  std::optional<glm::dvec3> post(const lod::TileKey& key, int i, int j) const {
    const int n = planet_.meta().tile.intervals();
    const std::int64_t all = std::int64_t{n} << key.level;
    const std::int64_t x = std::int64_t{key.i} * n + i, y = std::int64_t{key.j} * n + j;
    if (x < 1 || y < 1 || x >= all || y >= all) return std::nullopt;
    const int grid_level = key.level + planet_.meta().tile.k;
    const glm::dvec3 direction =
        mars::chart_direction(key.face, mars::face_line(x, grid_level), mars::face_line(y, grid_level));
    const paging::SurfacePoint found = surface_.at(direction);
    if (found.tile.level < key.level) return std::nullopt;
    return direction * (planet_.radius_m() + exaggeration() * found.height_m);
  }

  // The facets at the place itself would stop the ray.
  bool sees_sun(const lod::TileKey& key, int intervals, const glm::dvec3& place) const {
    const double lift_m = 1e-3 * lod::nominal_side_m(key.level, planet_.radius_m()) / intervals;
    return std::isinf(surface_.cast(place + lift_m * glm::normalize(place), request_.sun, exaggeration()));
  }

  const paging::Surface& surface_;
  const paging::PlanetFile& planet_;
  const vpe::core::DrawRequest& request_;
};

// Holds the light of an image's pixels.
struct LightImage {
  std::vector<double> light;    // NaN: not known, sky, or within a third of a pixel of an edge
  std::vector<double> range_m;  // infinite: sky
};

// Rasterises triangles: nine rays a pixel, a third of a pixel apart. A pixel counts where all nine meet one triangle; its
// light is that of the ray in the middle, linear on the triangle in space.
inline LightImage rasterise(const vpe::core::View& view, const std::vector<LitTriangle>& triangles) {
  const int width = 3 * view.width, height = 3 * view.height;
  constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  struct Sample {
    double range_m = std::numeric_limits<double>::infinity();
    std::size_t triangle = kNone;
    double light = std::numeric_limits<double>::quiet_NaN();
  };
  std::vector<Sample> samples(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  std::vector<glm::dvec3> rays;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) rays.push_back(vpe::core::pixel_ray(view, (x + 0.5) / 3, (y + 0.5) / 3));
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    int x0 = width, x1 = -1, y0 = height, y1 = -1, behind = 0;
    for (const glm::dvec3& corner : triangles[t].corners) {
      const vpe::core::Projected at = vpe::core::project(view, corner);
      behind += at.behind ? 1 : 0;
      if (at.behind) continue;
      const glm::dvec2 xy = glm::clamp(3.0 * at.xy, -10.0, 1e5);
      x0 = std::min(x0, static_cast<int>(xy.x) - 2);
      x1 = std::max(x1, static_cast<int>(xy.x) + 2);
      y0 = std::min(y0, static_cast<int>(xy.y) - 2);
      y1 = std::max(y1, static_cast<int>(xy.y) + 2);
    }
    if (behind == 3) continue;
    if (behind > 0) x0 = y0 = 0, x1 = width, y1 = height;
    const glm::dvec3 a = triangles[t].corners[0] - view.camera.position_m;
    const glm::dvec3 e1 = triangles[t].corners[1] - triangles[t].corners[0];
    const glm::dvec3 e2 = triangles[t].corners[2] - triangles[t].corners[0];
    for (int y = std::max(0, y0); y <= std::min(height - 1, y1); ++y) {
      for (int x = std::max(0, x0); x <= std::min(width - 1, x1); ++x) {
        const auto at = static_cast<std::size_t>(y * width + x);
        const glm::dvec3 p = glm::cross(rays[at], e2);
        const double scale = 1 / glm::dot(e1, p);
        const double u = -glm::dot(a, p) * scale;
        const glm::dvec3 q = glm::cross(-a, e1);
        const double v = glm::dot(rays[at], q) * scale;
        const double range_m = glm::dot(e2, q) * scale;
        if (!(u >= 0 && v >= 0 && u + v <= 1 && range_m > 0 && range_m < samples[at].range_m)) continue;
        const std::array<double, 3>& light = triangles[t].light;
        samples[at] = {range_m, t, light[0] + u * (light[1] - light[0]) + v * (light[2] - light[0])};
      }
    }
  }
  LightImage image;
  for (int y = 0; y < view.height; ++y) {
    for (int x = 0; x < view.width; ++x) {
      const auto sample = [&](int dx, int dy) -> const Sample& {
        return samples[static_cast<std::size_t>((3 * y + dy) * width + 3 * x + dx)];
      };
      const Sample& middle = sample(1, 1);
      bool is_one = middle.triangle != kNone;
      for (int k = 0; k < 9; ++k) is_one = is_one && sample(k % 3, k / 3).triangle == middle.triangle;
      image.light.push_back(is_one ? middle.light : std::numeric_limits<double>::quiet_NaN());
      image.range_m.push_back(middle.range_m);
    }
  }
  return image;
}

}  // namespace test_support
