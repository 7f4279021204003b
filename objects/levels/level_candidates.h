// Meshes of which one becomes the next level of a model of several parts. Decimation keeps each part to the last, so parts
// are left out here, or joined by clusters of vertices, and the rest is decimated.
//
// Typical usage:
//   LevelCandidates candidates(finest, surface, radius_m);
//   for (const LevelCandidate& c : candidates.after(level, decimated, 1000)) ...
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "objects/model/distance_tree.h"
#include "objects/model/mesh.h"

namespace objects {

// A level with more triangles, relative to those of the finer one, is not worth its memory.
inline constexpr double kWorthwhileRatio = 0.8;

struct LevelCandidate {
  Mesh mesh;
  double about_m = 0;  // at most its Hausdorff distance from the model: that of some points
};

// Not for several threads at once. The same on every machine.
class LevelCandidates {
 public:
  // `surface` is that of the finest mesh, and must outlive this. radius_m is that of its ball.
  LevelCandidates(const Mesh& finest, const DistanceTree& surface, double radius_m);

  // Returns meshes that may follow a level, the best one first: those of at most 1.25 times the wanted triangles, then others
  // that are worthwhile, both by distance. `decimated` is what decimation alone makes of the model, if it gets that far. The
  // levels that are asked about get coarser from call to call.
  std::vector<LevelCandidate> after(const Mesh& finer, std::optional<Mesh> decimated, std::size_t wanted);

 private:
  bool is_few(const Mesh& mesh) const;
  bool is_enough() const { return !found_.empty() && is_few(found_.front().mesh); }
  Mesh reduced(Mesh mesh) const;
  bool offer(Mesh mesh);
  double distance_about_m(const Mesh& mesh) const;

  const DistanceTree& surface_;
  std::vector<glm::dvec3> compared_m_;  // places of the finest mesh
  double near_m_;                       // within which parts were left out last
  double radius_m_;
  std::size_t wanted_ = 0;
  std::size_t most_ = 0;
  std::vector<LevelCandidate> found_;
};

}  // namespace objects
