#include "vpe/voxel/downsampled_view.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/ext/scalar_constants.hpp>

namespace vpe::voxel {

core::View downsampled_view(const core::View& view, int factor) {
  const auto fewer = [&](int pixels) { return (pixels + factor - 1) / factor; };
  core::View out = view;
  out.width = fewer(view.width);
  out.height = fewer(view.height);
  // The principal point stays at its place in the image, and a pixel keeps its angle times the factor.
  const glm::dvec2 principal = glm::dvec2(view.width, view.height) * 0.5 + view.principal_offset_px;
  out.principal_offset_px = principal / static_cast<double>(factor) - 0.5 * glm::dvec2(out.width, out.height);
  if (view.projection == core::Projection::kEquirectangular) {
    out.fov_deg = std::min(180.0, view.fov_deg * out.height * factor / view.height);
  } else {
    const double half = std::tan(view.fov_deg * glm::pi<double>() / 360.0);
    out.fov_deg = std::min(core::ViewLimits::kMaxFov_deg,
                           std::atan(half * out.height * factor / view.height) * 360.0 / glm::pi<double>());
  }
  if (view.part.width > 0) {
    out.part.x = view.part.x / factor;
    out.part.y = view.part.y / factor;
    out.part.width = std::min(fewer(view.part.x + view.part.width), out.width) - out.part.x;
    out.part.height = std::min(fewer(view.part.y + view.part.height), out.height) - out.part.y;
  }
  return out;
}

bool same_view(const core::View& a, const core::View& b) {
  const auto numbers = [](const core::View& v) {
    const mars::CameraPose& e = v.camera;
    std::array<double, 15> all{};
    std::size_t n = 0;
    for (const glm::dvec3& x : {e.position_m, e.axes.right, e.axes.up, e.axes.forward}) {
      for (int k = 0; k < 3; ++k) all[n++] = x[k];
    }
    all[n++] = v.fov_deg;
    all[n++] = v.principal_offset_px.x;
    all[n++] = v.principal_offset_px.y;
    return std::bit_cast<std::array<std::uint64_t, 15>>(all);
  };
  const auto whole = [](const core::View& v) {
    return std::array<int, 7>{
        static_cast<int>(v.projection), v.width, v.height, v.part.x, v.part.y, v.part.width, v.part.height};
  };
  return whole(a) == whole(b) && numbers(a) == numbers(b);
}

}  // namespace vpe::voxel
