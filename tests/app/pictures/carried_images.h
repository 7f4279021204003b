// Pairs of eyes over a bumpy planet, and how far carried pixels are off.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "tests/gl/gl_fixture.h"
#include "vpe/core/stereo.h"

namespace carried_images {

namespace core = vpe::core;

inline constexpr int kWidth = 96;
inline constexpr int kHeight = 64;

struct Eyes {
  core::DrawRequest left;
  core::DrawRequest right;
};

// Returns the requests of two eyes `base_m` apart.
inline Eyes eyes_at(const mars::Pose& pose, double radius_m, double base_m) {
  core::DrawRequest request = test_support::request_for(pose, radius_m, kWidth, kHeight);
  request.settings.mode = core::Mode::kLit;
  request.want_range = true;
  Eyes eyes{request, request};
  eyes.left.view = core::eye_view(request.view, -0.5 * base_m, std::nullopt);
  eyes.right.view = core::eye_view(request.view, 0.5 * base_m, std::nullopt);
  return eyes;
}

inline std::shared_ptr<const paging::PlanetFile> bumpy_planet() {
  static const test_support::TempDir folder;
  static const auto planet = test_support::build_fake(
      folder / "bumpy.vpe", test_support::FakeElevation(test_support::bumpy_height), 20'000);
  return planet;
}

inline constexpr int kAround_px = 2;

// Returns by how much a carried pixel is off, as a difference of parallax, from the best that the full image has within two
// pixels: silhouettes are those of the first image's pixels. `full` may have kAround_px more pixels on each side.
inline double off_px(const core::DrawRequest& eye, double base_m, const core::Frame& is,
                     const core::Frame& full, int x, int y) {
  const int margin_px = (full.width - kWidth) / 2;
  const auto parallax_px = [&](const core::Frame& frame, int u, int v, int beside_px) {
    const auto at = static_cast<std::size_t>((v + beside_px) * frame.width + u + beside_px);
    const double depth_m = static_cast<double>(frame.range_m[at]) *
                           glm::dot(core::pixel_ray(eye.view, u + 0.5, v + 0.5), eye.view.camera.axes.forward);
    return base_m * core::focal_px(eye.view) / depth_m;
  };
  const double carried_px = parallax_px(is, x, y, 0);
  double best_px = std::numeric_limits<double>::infinity();
  const auto last = [&](int size, int at) { return std::min(at + kAround_px, size - 1 + margin_px); };
  for (int v = std::max(y - kAround_px, -margin_px); v <= last(kHeight, y); ++v)
    for (int u = std::max(x - kAround_px, -margin_px); u <= last(kWidth, x); ++u)
      best_px = std::min(best_px, std::abs(carried_px - parallax_px(full, u, v, margin_px)));
  return best_px;
}

}  // namespace carried_images
