// An image that shows ground from 0.1 m to 10^8 m away, from the top of a mountain on a planet of 10^8 m.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/stability/terrains.h"
#include "vpe/core/view.h"

namespace test_support {

inline constexpr double kDeepRadius_m = 1e8;

inline StrangeGround deep_ground() {
  const glm::dvec3 top =
      mars::chart_direction(mars::Face::kPlusX, mars::face_line(40, 6), mars::face_line(24, 6));
  return {"mountain", [top](const glm::dvec3& d) {
            // A spike with ridges around it, so that near ground hides far ground.
            const double away = glm::length(d - top);
            const Post post = post_at(d);
            return away < 1e-9 ? 0.35 : (away < 0.4 && ((post.i ^ post.j) & 3) == 0) ? 0.08 : 0.0;
          }};
}

// Returns a view from 0.1 m over the top, down its side.
inline vpe::core::View deep_view(const paging::Surface& surface, double yaw_deg) {
  const glm::dvec3 top =
      mars::chart_direction(mars::Face::kPlusX, mars::face_line(40, 6), mars::face_line(24, 6));
  const mars::LonLat at = mars::lon_lat(top);
  vpe::core::View view;
  view.camera = mars::to_camera({at.lon_deg, at.lat_deg, surface.at(top).height_m + 0.1, yaw_deg, -55, 10},
                                kDeepRadius_m);
  view.width = 160;
  view.height = 120;
  view.fov_deg = 110;
  return view;
}

// Counts pixels whose range is wrong.
struct DepthOrder {
  double nearest_m = INFINITY;
  double farthest_m = 0;
  double pixels = 0;
  double wrong = 0;  // show ground more than 1 % nearer or farther than all that lies within a pixel
};

inline DepthOrder check_depth_order(const paging::Surface& surface, const vpe::core::View& view,
                                    const std::vector<float>& range_m) {
  DepthOrder order;
  for (int y = 0; y < view.height; ++y) {
    for (int x = 0; x < view.width; ++x) {
      const auto seen = static_cast<double>(range_m[static_cast<std::size_t>(y * view.width + x)]);
      double low = INFINITY;
      double high = 0;
      for (int n = 0; n < 9; ++n) {
        const glm::dvec2 at(x + 0.5 * (n % 3), y + 0.5 * (n / 3));
        const double exact = surface.cast(view.camera.position_m, vpe::core::pixel_ray(view, at.x, at.y));
        low = std::min(low, exact);
        high = std::max(high, exact);
        if (n == 4 && std::isfinite(exact)) {
          order.nearest_m = std::min(order.nearest_m, exact);
          order.farthest_m = std::max(order.farthest_m, exact);
        }
      }
      order.pixels += 1;
      if (!(seen >= 0.99 * low && seen <= 1.01 * high)) order.wrong += 1;
    }
  }
  return order;
}

}  // namespace test_support
