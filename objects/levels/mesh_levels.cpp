#include "objects/levels/mesh_levels.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "objects/levels/decimation.h"
#include "objects/model/hausdorff.h"
#include "objects/model/normals.h"

namespace objects {

namespace {

// A level with more triangles, relative to those of the finer one, is not worth its memory.
constexpr double kWorthwhileRatio = 0.8;
// Errors are at least this part of the radius: which of two smaller ones is the larger is a matter of rounding.
constexpr double kLeastError = 1e-6;

Mesh with_area_only(const Mesh& mesh) {
  Mesh result;
  result.positions_m = mesh.positions_m;
  for (std::size_t n = 0; n < mesh.triangles.size(); ++n)
    if (area_normal(mesh, n) != glm::dvec3(0.0)) result.triangles.push_back(mesh.triangles[n]);
  return result;
}

}  // namespace

std::vector<MeshLevel> make_levels(Mesh mesh, const LevelOptions& options) {
  if (!(options.ratio > 0 && options.ratio < 1))
    throw std::invalid_argument("the ratio of levels must be in (0, 1)");
  std::vector<MeshLevel> levels;
  TriangleTree finest_tree(mesh);
  levels.push_back({std::move(mesh), std::move(finest_tree), 0});
  const Mesh finest = levels.front().mesh;
  const DistanceTree surface(with_area_only(finest));
  if (surface.size() == 0) return levels;
  const auto radius_m = static_cast<double>(bounding_ball(finest).radius_m);
  Decimation decimation(finest);
  std::size_t before = decimation.triangles();
  while (before > options.least_triangles) {
    const auto wanted = static_cast<std::size_t>(static_cast<double>(before) * options.ratio);
    decimation.reduce_to(std::max(wanted, options.least_triangles));
    const std::size_t left = decimation.triangles();
    if (static_cast<double>(left) > kWorthwhileRatio * static_cast<double>(before)) break;
    before = left;
    Mesh coarse = decimation.mesh();
    if (coarse.triangles.empty()) break;
    const double geometric_error_m = std::max(
        hausdorff_bound(surface, DistanceTree(coarse), kLeastError * radius_m), kLeastError * radius_m);
    if (!(geometric_error_m <= radius_m)) break;
    if (!finest.normals.empty()) add_normals(coarse);
    while (levels.size() > 1 && levels.back().geometric_error_m >= geometric_error_m) levels.pop_back();
    TriangleTree tree(coarse);
    levels.push_back({std::move(coarse), std::move(tree), geometric_error_m});
  }
  return levels;
}

}  // namespace objects
