// The nearest hit of a ray with S by trying triangles, in double: nothing of the ray backends' ways (charts,
// tile trees, pyramids) is in it, so it judges all of them.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <vector>

#include "paging/planet/planet_file.h"

namespace test_support {

// Any thread may call any const member. Memory: about 80 bytes a triangle of S.
class BruteForce {
 public:
  // Reads all finest tiles. Throws paging::PlanetError.
  explicit BruteForce(const paging::PlanetFile& planet);

  // Where the ray from `camera_m` (metres from the planet's centre) along unit `direction` crosses S, t >= 0,
  // ascending. Every triangle whose bounding ball the ray meets is tried (Moeller & Trumbore 1997), with its
  // edges widened by the rounding of that test, so no ray gets through between neighbours; a ray through an
  // edge may be told twice. Error of t about 1e-15 (|camera| + |S|) / sin(incidence).
  std::vector<double> crossings(const glm::dvec3& camera_m, const glm::dvec3& direction) const;
  // The first of them; infinity when there is none.
  double cast(const glm::dvec3& camera_m, const glm::dvec3& direction) const;

  // Radius of S along a direction of any length but 0, metres.
  double radius_m(const glm::dvec3& direction) const;

  // How far below S, along the vertical, the ray gets at most between two distances; negative when it stays
  // above. Sampled between crossings, and good to a few percent there.
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
    std::size_t begin = 0, end = 0;  // what it holds: blocks_ or triangles_
  };

  template <typename Visit>
  void each_crossing(const glm::dvec3& camera_m, const glm::dvec3& direction, Visit&& visit) const;
  void add_tile(const paging::TileHeights& tile, double radius_m);

  std::vector<Ball> tiles_;
  std::vector<Ball> blocks_;
  std::vector<Triangle> triangles_;
};

// What a caster's answer for a ray is worth.
enum class Verdict {
  kSame,     // within kSameRange of the brute force, or both none
  kTie,      // differs, but the ray is that near to S where they differ
  kMissed,   // the caster went through ground
  kPhantom,  // the caster hit air
};
inline constexpr double kSameRange = 1e-9;

// How far below S a ray may sink, or above it be stopped, in a tie: share of the range + metres.
struct Tie {
  double share = 1e-6;
  double metres = 0;
};
Verdict judge(const BruteForce& truth, const glm::dvec3& camera_m, const glm::dvec3& direction,
              double claimed_m, const Tie& tie = {});

}  // namespace test_support
