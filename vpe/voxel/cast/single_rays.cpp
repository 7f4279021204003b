#include "vpe/voxel/cast/single_rays.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vpe::voxel {

std::optional<double> SingleRays::cast(const glm::dvec3& camera_m, const glm::dvec3& ray,
                                       const paging::Surface::RaySegment& segment) const {
  if (fallbacks_ == nullptr) return surface_.cast(camera_m, ray, exaggeration_, segment);
  return surface_.cast_over([this](const lod::TileKey& key) { return fallbacks_->surface_tile(surface_, key); },
                            camera_m, ray, exaggeration_, segment);
}

std::optional<double> SingleRays::cast_from(const glm::dvec3& camera_m, const glm::dvec3& ray,
                                            double begin_m) const {
  if (begin_m > 0) {
    const std::optional<double> range = cast(camera_m, ray, {begin_m, std::numeric_limits<double>::infinity()});
    if (!range || *range != begin_m) return range;
  }
  return cast(camera_m, ray);
}

std::optional<double> SingleRays::cast_near(const glm::dvec3& camera_m, const glm::dvec3& ray, float a_m,
                                            float b_m) const {
  const auto near = static_cast<double>(std::min(a_m, b_m));
  const auto far = static_cast<double>(std::max(a_m, b_m));
  if (!std::isfinite(near)) return cast(camera_m, ray);
  const double begin = (1.0 - kAroundRange) * near;
  const double end = (1.0 + kAroundRange) * near;
  std::optional<double> range = cast(camera_m, ray, {begin, end});
  if (!range || (std::isfinite(*range) && *range != begin)) return range;
  if (*range != begin && std::isfinite(far)) {
    const double beyond = std::max((1.0 - kAroundRange) * far, end);
    range = cast(camera_m, ray, {beyond, std::numeric_limits<double>::infinity()});
    if (!range || *range != beyond) return range;
  }
  return cast(camera_m, ray);
}

}  // namespace vpe::voxel
