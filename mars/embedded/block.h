// A handful of nearby directions that are worked on together, and what is found out about them.
//
// Arrays are filled up to a multiple of kLanes with copies of the last direction, so that loops need no tail.
// Every field is a function of its own direction alone; bounds serve only to skip what contributes exactly 0.
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>

namespace mars::embedded {

inline constexpr std::size_t kBlock = 272;
inline constexpr std::size_t kLanes = 16;
static_assert(kBlock % kLanes == 0);

template <typename T>
using Lane = std::array<T, kBlock>;

enum class Simd { kPlain, kAvx2, kAvx512 };
// The best that this processor has. All give equal bits.
Simd best_simd();
bool has_simd(Simd simd);

struct Block {
  std::size_t count = 0;       // directions asked for
  std::size_t padded = 0;      // rounded up to kLanes
  glm::dvec3 centre{1, 0, 0};  // some point (not unit); all directions are within `reach` of it
  double reach = 0;            // chord on the unit sphere
  Simd simd = Simd::kPlain;
  alignas(64) Lane<double> x, y, z;

  glm::dvec3 at(std::size_t i) const { return {x[i], y[i], z[i]}; }

  // Fills up and finds the bounds; requires 1 <= count <= kBlock and unit x, y, z.
  void finish();

  // True when some direction may lie within `chord` (unit sphere) of the point.
  bool near(const glm::dvec3& point, double chord) const {
    const double dx = centre.x - point.x;
    const double dy = centre.y - point.y;
    const double dz = centre.z - point.z;
    const double limit = reach + chord;
    return dx * dx + dy * dy + dz * dz <= limit * limit;
  }
};

// The ground before craters and roughness, and what kind of ground it is. Factors are 0..1 unless said.
struct Terrain {
  alignas(64) Lane<double> height_m;
  alignas(64) Lane<float> cratered;  // density of craters, relative to the southern highlands
  alignas(64) Lane<float> rugged;    // amplitude of relief longer than some kilometres
  alignas(64) Lane<float> rough;     // amplitude of relief from some kilometres down to tens of metres
  alignas(64) Lane<float> lowland;   // northern plains
  alignas(64) Lane<float> volcanic;  // lava of Tharsis, Elysium and the shields
  alignas(64) Lane<float> wall;      // walls of troughs and scarps: rock
  alignas(64) Lane<float> trough;    // floors of troughs
  alignas(64) Lane<float> mound;     // layered mounds in troughs
  alignas(64) Lane<float> ice;       // polar caps
};

}  // namespace mars::embedded
