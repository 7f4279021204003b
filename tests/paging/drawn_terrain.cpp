#include "tests/paging/drawn_terrain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <set>

namespace test_support {

const DrawnMesh& MeshStore::mesh(const lod::SelectedTile& tile, double exaggeration) {
  if (exaggeration != exaggeration_) meshes_.clear();
  exaggeration_ = exaggeration;
  const auto [at, made] = meshes_.try_emplace({tile.index, tile.variant});
  DrawnMesh& out = at->second;
  if (!made) return out;
  lod::TileMesh mesh;
  std::vector<double> heights;
  if (lod::is_full_grid(planet_->tree()[tile.index], tile.variant)) {
    const paging::TileHeights posts = planet_->heights(tile.key, exaggeration);
    mesh = lod::mesh_full(posts.posts.intervals);
    heights = posts.posts.height_m;
  } else {
    const paging::PackedMesh packed = planet_->mesh(tile.key, tile.variant);
    mesh = packed.mesh;
    for (const std::int32_t q : packed.height_q) heights.push_back(q * planet_->meta().quantum_m);
  }
  out.occluders = lod::make_occluder_profile(tile.key, mesh, heights, exaggeration, planet_->radius_m());
  const lod::GridLines lines = lod::grid_lines(tile.key, mesh.intervals);
  for (std::size_t n = 0; n < heights.size(); ++n) {
    out.vertices.push_back(
        mars::chart_direction(tile.key.face, lines.u[mesh.vertices[n].i], lines.v[mesh.vertices[n].j]) *
        (planet_->radius_m() + exaggeration * heights[n]));
  }
  for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.triangles[t + k];
      const std::uint32_t b = mesh.triangles[t + (k + 1) % 3];
      out.edges.emplace_back(std::min(a, b), std::max(a, b));
    }
  }
  std::sort(out.edges.begin(), out.edges.end());
  out.edges.erase(std::unique(out.edges.begin(), out.edges.end()), out.edges.end());
  out.triangles = mesh.triangles;
  return out;
}

DrawnTerrain::DrawnTerrain(MeshStore& store, const lod::Selection& selection, const glm::dvec3& camera_m)
    : camera_m_(camera_m), up_(glm::normalize(camera_m)) {
  for (const lod::SelectedTile& tile : selection.tiles) {
    const mars::ChartRect r = lod::chart_rect(tile.key);
    tiles_.push_back({r,
                      {mars::chart_direction(r.face, r.u0, r.v0), mars::chart_direction(r.face, r.u1, r.v0),
                       mars::chart_direction(r.face, r.u0, r.v1), mars::chart_direction(r.face, r.u1, r.v1)},
                      &store.mesh(tile, selection.exaggeration)});
  }
}

std::optional<bool> DrawnTerrain::camera_is_above() const {
  for (const Tile& tile : tiles_) {
    if (glm::dot(mars::face_axes(tile.rect.face).out, up_) <= 0.0) continue;
    const mars::ChartPoint p = mars::chart_on(tile.rect.face, up_);
    if (p.u < tile.rect.u0 || p.u > tile.rect.u1 || p.v < tile.rect.v0 || p.v > tile.rect.v1) continue;
    const DrawnMesh& mesh = *tile.mesh;
    for (std::size_t t = 0; t + 2 < mesh.triangles.size(); t += 3) {
      // Relative to a corner, so that a triangle of metres loses no digits to the planet's radius.
      const glm::dvec3& a = mesh.vertices[mesh.triangles[t]];
      const glm::dvec3 ab = mesh.vertices[mesh.triangles[t + 1]] - a;
      const glm::dvec3 ac = mesh.vertices[mesh.triangles[t + 2]] - a;
      const glm::dvec3 along = glm::cross(up_, ac);
      const double whole = glm::dot(ab, along);
      const double s = glm::dot(-a, along) / whole;
      const double r = glm::dot(up_, glm::cross(-a, ab)) / whole;
      if (s < -1e-9 || r < -1e-9 || s + r > 1.0 + 1e-9) continue;
      return glm::length(a + s * ab + r * ac) < glm::length(camera_m_);
    }
  }
  return std::nullopt;
}

bool DrawnTerrain::blocked(const glm::dvec3& point) const {
  const glm::dvec3 to = point - camera_m_;
  glm::dvec3 side = glm::normalize(glm::cross(up_, to));
  side = glm::normalize(side - glm::dot(side, up_) * up_);
  const glm::dvec3 ahead = glm::cross(side, up_);
  const double reach = glm::length(camera_m_);
  const double slope = glm::dot(to, up_) / glm::dot(to, ahead);
  const double angle = glm::dot(point, ahead) / glm::dot(point, up_);  // its tangent
  for (const Tile& tile : tiles_) {
    double low = 1.0, high = -1.0, far = -1.0;
    for (const glm::dvec3& corner : tile.corners) {
      low = std::min(low, glm::dot(corner, side));
      high = std::max(high, glm::dot(corner, side));
      far = std::max(far, glm::dot(corner, ahead));
    }
    if (low > 1e-12 || high < -1e-12 || far < 0.0) continue;
    const DrawnMesh& mesh = *tile.mesh;
    for (const auto& [a, b] : mesh.edges) {
      const glm::dvec3& p = mesh.vertices[a];
      const glm::dvec3& q = mesh.vertices[b];
      const double sp = glm::dot(p, side);
      const double sq = glm::dot(q, side);
      if ((sp > 0.0) == (sq > 0.0)) continue;
      const glm::dvec3 x = p + sp / (sp - sq) * (q - p);
      const double run = glm::dot(x, ahead);
      const double up = glm::dot(x, up_);
      if (run <= 0.0 || up <= 0.0 || run / up >= angle) continue;
      if (up - reach > slope * run) return true;
    }
  }
  return false;
}

}  // namespace test_support
