// Blocks of nearby directions that are processed together, and loops for several instruction sets.
//
// Arrays are padded to a multiple of kLanes with copies of the last direction, so that loops need no tail.
// Every value is a function of its own direction alone; bounds only serve to skip what contributes exactly 0.
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

// Instruction sets. All give equal bits.
enum class Simd { kPlain, kAvx2, kAvx512 };

// Returns the fastest instruction set of this processor.
Simd best_simd();

// Returns true if this processor has the instruction set.
bool has_simd(Simd simd);

struct Block {
  std::size_t count = 0;       // number of directions
  std::size_t padded = 0;      // rounded up to kLanes
  glm::dvec3 centre{1, 0, 0};  // some point (not unit); all directions are within `reach` of it
  double reach = 0;            // chord on the unit sphere
  Simd simd = Simd::kPlain;
  alignas(64) Lane<double> x, y, z;

  glm::dvec3 at(std::size_t i) const { return {x[i], y[i], z[i]}; }

  // Pads the arrays and computes the bounds. Requires 1 <= count <= kBlock and unit x, y, z.
  void finish();

  // Returns true if some direction may lie within `chord` (unit sphere) of the point.
  bool near(const glm::dvec3& point, double chord) const {
    const double dx = centre.x - point.x;
    const double dy = centre.y - point.y;
    const double dz = centre.z - point.z;
    const double limit = reach + chord;
    return dx * dx + dy * dy + dz * dz <= limit * limit;
  }
};

#if defined(__x86_64__) && defined(__GNUC__)

// "flatten" inlines the work and all that it calls into a function compiled for the wider registers. Without
// contraction and reassociation each lane performs the operations of the plain code.
template <class Work>
[[gnu::noinline, gnu::flatten, gnu::target("avx2")]] void run_with_avx2(const Work& work) {
  work();
}
template <class Work>
[[gnu::noinline, gnu::flatten, gnu::target("avx512f,avx512bw,avx512dq,avx512vl")]] void run_with_avx512(
    const Work& work) {
  work();
}

// Runs work(), a function object of loops over lanes, compiled for `simd`. All choices give equal bits.
template <class Work>
void with_simd(Simd simd, const Work& work) {
  switch (simd) {
    case Simd::kAvx512: return run_with_avx512(work);
    case Simd::kAvx2: return run_with_avx2(work);
    case Simd::kPlain: return work();
  }
}

#else

template <class Work>
void with_simd(Simd, const Work& work) {
  work();
}

#endif

}  // namespace mars::embedded
