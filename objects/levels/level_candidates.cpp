#include "objects/levels/level_candidates.h"

#include <algorithm>
#include <array>
#include <utility>

#include "objects/levels/clustering.h"
#include "objects/levels/decimation.h"
#include "objects/levels/mesh_parts.h"
#include "objects/model/normals.h"

namespace objects {

namespace {

// Parts are left out within distances from this part of the radius on, each so many times the last one.
constexpr double kLeastNearness = 1.0 / 1024;
constexpr double kNearnessStep = 2;
constexpr double kMostOfWanted = 1.25;
// Sides of cells, in distances of the best candidate without clusters.
constexpr std::array kCellSizes{0.5, 1.0, 2.0};
// Triangles of each mesh by which candidates are compared.
constexpr std::size_t kMostCompared = 1'000;

// Returns where the distance of triangles is looked at: the largest one is not always at a corner.
std::array<glm::dvec3, 7> compared_places(const Mesh& mesh, const glm::uvec3& t) {
  const glm::dvec3 a(mesh.positions_m[t.x]);
  const glm::dvec3 b(mesh.positions_m[t.y]);
  const glm::dvec3 c(mesh.positions_m[t.z]);
  return {a, b, c, (a + b + c) / 3.0, 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)};
}

}  // namespace

LevelCandidates::LevelCandidates(const Mesh& finest, const DistanceTree& surface, double radius_m)
    : surface_(surface), near_m_(kLeastNearness * radius_m), radius_m_(radius_m) {
  const std::size_t step = finest.triangles.size() / kMostCompared + 1;
  for (std::size_t n = 0; n < finest.triangles.size(); n += step) {
    if (area_normal(finest, n) == glm::dvec3(0.0)) continue;
    const auto places = compared_places(finest, finest.triangles[n]);
    compared_m_.insert(compared_m_.end(), places.begin(), places.end());
  }
}

std::vector<LevelCandidate> LevelCandidates::after(const Mesh& finer, std::optional<Mesh> decimated,
                                                   std::size_t wanted) {
  found_.clear();
  most_ = static_cast<std::size_t>(kWorthwhileRatio * static_cast<double>(finer.triangles.size()));
  wanted_ = wanted;
  if (decimated) offer(std::move(*decimated));
  std::size_t last_count = finer.triangles.size();
  for (double near_m = near_m_; near_m < radius_m_; near_m *= kNearnessStep) {
    // What is left out from now on is farther away than that.
    if (is_enough() && near_m / kNearnessStep > found_.front().about_m) break;
    Mesh fewer = without_near_parts(finer, near_m);
    if (fewer.triangles.size() == last_count) continue;
    last_count = fewer.triangles.size();
    if (offer(reduced(std::move(fewer)))) near_m_ = near_m;
  }
  const double cell_m = is_enough() ? found_.front().about_m : radius_m_;
  for (const double size : kCellSizes) offer(reduced(cluster(finer, size * cell_m)));
  return std::exchange(found_, {});
}

bool LevelCandidates::is_few(const Mesh& mesh) const {
  return static_cast<double>(mesh.triangles.size()) <= kMostOfWanted * static_cast<double>(wanted_);
}

Mesh LevelCandidates::reduced(Mesh mesh) const {
  if (mesh.triangles.size() <= wanted_) return mesh;
  Decimation decimation(mesh);
  decimation.reduce_to(wanted_);
  return decimation.mesh();
}

// Returns whether a mesh is the best one so far.
bool LevelCandidates::offer(Mesh mesh) {
  if (mesh.triangles.empty() || mesh.triangles.size() > most_) return false;
  LevelCandidate candidate{std::move(mesh), 0};
  candidate.about_m = distance_about_m(candidate.mesh);
  const auto rank = [&](const LevelCandidate& c) { return std::make_pair(!is_few(c.mesh), c.about_m); };
  const auto place =
      std::upper_bound(found_.begin(), found_.end(), candidate,
                       [&](const LevelCandidate& a, const LevelCandidate& b) { return rank(a) < rank(b); });
  const bool is_best = place == found_.begin();
  found_.insert(place, std::move(candidate));
  return is_best;
}

double LevelCandidates::distance_about_m(const Mesh& mesh) const {
  double farthest_m = 0;
  std::uint32_t hint = 0;
  const auto add = [&](const DistanceTree& tree, const glm::dvec3& at_m) {
    const DistanceTree::Nearest nearest = tree.nearest(at_m, hint);
    hint = nearest.triangle;
    farthest_m = std::max(farthest_m, nearest.distance_m);
  };
  const DistanceTree tree(mesh);
  for (const glm::dvec3& at_m : compared_m_) add(tree, at_m);
  hint = 0;
  const std::size_t step = mesh.triangles.size() / kMostCompared + 1;
  for (std::size_t n = 0; n < mesh.triangles.size(); n += step)
    for (const glm::dvec3& at_m : compared_places(mesh, mesh.triangles[n])) add(surface_, at_m);
  return farthest_m;
}

}  // namespace objects
