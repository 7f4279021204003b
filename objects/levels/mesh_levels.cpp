#include "objects/levels/mesh_levels.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "objects/levels/decimation.h"
#include "objects/levels/level_candidates.h"
#include "objects/levels/mesh_parts.h"
#include "objects/model/hausdorff.h"
#include "objects/model/normals.h"

namespace objects {

namespace {

// Errors are at least this part of the radius: which of two smaller ones is the larger is a matter of rounding.
constexpr double kLeastError = 1e-6;
// With so many triangles for each part decimation alone does well.
constexpr std::size_t kManyOfPart = 48;

Mesh with_area_only(const Mesh& mesh) {
  Mesh result;
  result.positions_m = mesh.positions_m;
  for (std::size_t n = 0; n < mesh.triangles.size(); ++n)
    if (area_normal(mesh, n) != glm::dvec3(0.0)) result.triangles.push_back(mesh.triangles[n]);
  return result;
}

struct MeasuredMesh {
  Mesh mesh;
  double geometric_error_m = std::numeric_limits<double>::infinity();
};

// Returns the candidate of the least error, and has no mesh if there is none. Those of more triangles than the first one that
// is measured do not count.
MeasuredMesh best_of(std::vector<LevelCandidate> candidates, const DistanceTree& surface, double tolerance_m) {
  MeasuredMesh best;
  std::size_t most = std::numeric_limits<std::size_t>::max();
  for (LevelCandidate& c : candidates) {
    if (c.about_m >= best.geometric_error_m || c.mesh.triangles.size() > most) break;
    const double bound_m = hausdorff_bound(surface, DistanceTree(c.mesh), tolerance_m);
    if (bound_m >= best.geometric_error_m) continue;
    most = c.mesh.triangles.size();
    best = {std::move(c.mesh), bound_m};
  }
  return best;
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
  const double least_error_m = kLeastError * radius_m;
  const std::size_t parts = find_parts(finest).count;
  LevelCandidates candidates(finest, surface, radius_m);
  Decimation decimation(finest);
  Mesh finer = finest;
  finer.textures.clear();
  finer.normals.clear();
  std::size_t before = decimation.triangles();
  while (before > options.least_triangles) {
    const auto wanted = std::max(static_cast<std::size_t>(static_cast<double>(before) * options.ratio),
                                 options.least_triangles);
    decimation.reduce_to(wanted);
    std::optional<Mesh> decimated;
    if (static_cast<double>(decimation.triangles()) <= kWorthwhileRatio * static_cast<double>(before))
      decimated = decimation.mesh();
    const bool is_enough = decimated && (parts == 1 || wanted > kManyOfPart * parts);
    std::vector<LevelCandidate> found;
    if (is_enough) {
      found.push_back({std::move(*decimated), 0});
    } else {
      found = candidates.after(finer, std::move(decimated), wanted);
    }
    MeasuredMesh coarse = best_of(std::move(found), surface, least_error_m);
    if (coarse.mesh.triangles.empty()) break;
    while (true) {
      // Not farther from the finer level either, so that a change between the two shows no more than the error.
      const MeshLevel& last = levels.back();
      if (levels.size() > 1)
        coarse.geometric_error_m =
            std::max(coarse.geometric_error_m, hausdorff_bound(last.mesh, coarse.mesh, least_error_m));
      coarse.geometric_error_m = std::max(coarse.geometric_error_m, least_error_m);
      if (levels.size() == 1 || last.geometric_error_m < coarse.geometric_error_m) break;
      levels.pop_back();
    }
    if (!(coarse.geometric_error_m <= radius_m)) break;
    before = coarse.mesh.triangles.size();
    finer = coarse.mesh;
    if (!finest.normals.empty()) add_normals(coarse.mesh);
    TriangleTree tree(coarse.mesh);
    levels.push_back({std::move(coarse.mesh), std::move(tree), coarse.geometric_error_m});
  }
  return levels;
}

}  // namespace objects
