#include "mars/embedded/block.h"

#include <algorithm>
#include <cmath>

namespace mars::embedded {

bool has_simd(Simd simd) {
#if defined(__x86_64__) && defined(__GNUC__)
  switch (simd) {
    case Simd::kAvx512:
      return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
             __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
    case Simd::kAvx2: return __builtin_cpu_supports("avx2");
    case Simd::kPlain: return true;
  }
#endif
  return simd == Simd::kPlain;
}

Simd best_simd() {
  if (has_simd(Simd::kAvx512)) return Simd::kAvx512;
  return has_simd(Simd::kAvx2) ? Simd::kAvx2 : Simd::kPlain;
}

void Block::finish() {
  padded = (count + kLanes - 1) / kLanes * kLanes;
  for (std::size_t i = count; i < padded; ++i) {
    x[i] = x[count - 1];
    y[i] = y[count - 1];
    z[i] = z[count - 1];
  }
  glm::dvec3 low = at(0);
  glm::dvec3 high = at(0);
  for (std::size_t i = 1; i < count; ++i) {
    low = {std::min(low.x, x[i]), std::min(low.y, y[i]), std::min(low.z, z[i])};
    high = {std::max(high.x, x[i]), std::max(high.y, y[i]), std::max(high.z, z[i])};
  }
  centre = (low + high) * 0.5;
  double farthest = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec3 d = at(i) - centre;
    farthest = std::max(farthest, d.x * d.x + d.y * d.y + d.z * d.z);
  }
  reach = std::sqrt(farthest) * (1.0 + 1e-12) + 1e-15;
}

}  // namespace mars::embedded
