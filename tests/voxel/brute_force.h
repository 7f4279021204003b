// Intersects rays with the reference surface by trying triangles, in double. Shares nothing with the casters
// (charts, tile trees, pyramids), so it judges all of them.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <vector>

#include "paging/planet/planet_file.h"

namespace test_support {

// Any thread may call any const member. Takes about 80 bytes for each triangle.
class BruteForce {
 public:
  // Reads all finest tiles. Throws paging::PlanetError.
  explicit BruteForce(const paging::PlanetFile& planet);

  // Returns the distances t >= 0, ascending, at which the ray from `camera_m` (metres from the planet's centre)
  // along unit `direction` crosses the reference surface S. Tries every triangle whose bounding ball the ray
  // meets (Moeller & Trumbore 1997), with edges widened by the rounding of that test, so that no ray gets
  // through between neighbours. A crossing through an edge may appear twice. The error of t is about 1e-15
  // (|camera| + |S|) / sin(incidence).
  std::vector<double> crossings(const glm::dvec3& camera_m, const glm::dvec3& direction) const;
  // Returns the first crossing, or infinity.
  double cast(const glm::dvec3& camera_m, const glm::dvec3& direction) const;

  // Returns the radius of the reference surface along a direction of any length but 0, metres.
  double radius_m(const glm::dvec3& direction) const;

  // Returns how far below the reference surface, along the vertical, the ray gets at most between two
  // distances; negative if it stays above. Samples between crossings, within a few percent.
  double deepest_m(const glm::dvec3& camera_m, const glm::dvec3& direction, double from, double to) const;

  std::size_t triangles() const { return triangles_.size(); }

 private:
  struct Triangle {
    glm::dvec3 corner, edge1, edge2;
    double longest_m = 0;
  };
  struct Ball {
    glm::dvec3 centre{0};
    double radius_m = 0;
    std::size_t begin = 0, end = 0;  // range in blocks_ or triangles_
  };

  template <typename Visit>
  void each_crossing(const glm::dvec3& camera_m, const glm::dvec3& direction, Visit&& visit) const;
  void add_tile(const paging::TileHeights& tile, double radius_m);

  std::vector<Ball> tiles_;
  std::vector<Ball> blocks_;
  std::vector<Triangle> triangles_;
};

// Classifies a caster's result for a ray.
enum class Verdict {
  kSame,     // within kSameRange of the brute force, or both none
  kTie,      // differs, but the ray is within the tie's limits of the surface where they differ
  kMissed,   // the caster went through ground
  kPhantom,  // the caster hit air
};
inline constexpr double kSameRange = 1e-9;

// Limits a tie: the distance that a ray may sink below the surface, or end above it, is a share of the range
// plus metres.
struct Tie {
  double share = 1e-6;
  double metres = 0;
};
// Compares a caster's range with brute force.
Verdict judge(const BruteForce& truth, const glm::dvec3& camera_m, const glm::dvec3& direction,
              double claimed_m, const Tie& tie = {});

}  // namespace test_support
