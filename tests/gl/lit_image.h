// Images of one colour, lit: what tests of the sun and its shadows share.
#pragma once

#include <algorithm>

#include "tests/gl/gl_fixture.h"
#include "vpe/core/appearance/shading.h"

namespace test_support {

// Of plain ground in so much light, red.
inline double plain_byte(double light) { return std::min(255.0, vpe::core::kPlainGround.r * light); }

inline vpe::core::DrawRequest lit_request(const mars::Pose& pose, int width, int height, double fov_deg) {
  vpe::core::DrawRequest out = request_for(pose, mars::kMarsRadius_m, width, height, fov_deg);
  out.settings.mode = vpe::core::Mode::kLit;
  out.settings.background = vpe::core::Background::kBlack;
  out.settings.smooth_edges = false;
  out.settings.lod_tolerance_px = 0;
  return out;
}

inline int red(const vpe::core::DrawResult& result, int x, int y) {
  return result.frame.colour[static_cast<std::size_t>(y * result.frame.width + x)].r;
}

}  // namespace test_support
