#include "vpe/voxel/volume/cube_share.h"

#include <algorithm>
#include <cmath>

namespace vpe::voxel {

double cube_share_below(const glm::dvec3& normal, double distance) {
  constexpr double kLeast = 1e-4;
  const double a = std::max(std::abs(normal.x), kLeast);
  const double b = std::max(std::abs(normal.y), kLeast);
  const double c = std::max(std::abs(normal.z), kLeast);
  const double at = distance + 0.5 * (a + b + c);
  if (at <= 0) return 0;
  if (at >= a + b + c) return 1;
  // The corner's pyramid, without what of it lies beyond the cube's sides.
  const auto cubed = [at](double beyond) {
    const double x = std::max(at - beyond, 0.0);
    return x * x * x;
  };
  const double volume = cubed(0) - cubed(a) - cubed(b) - cubed(c) + cubed(a + b) + cubed(a + c) + cubed(b + c);
  return std::clamp(volume / (6 * a * b * c), 0.0, 1.0);
}

}  // namespace vpe::voxel
