// Lit images of one colour, for tests of the sun and its shadows.
#pragma once

#include <algorithm>

#include "tests/gl/gl_fixture.h"
#include "vpe/core/appearance/shading.h"

namespace test_support {

// Returns the red value of plain ground in an amount of light.
inline double plain_byte(double light) { return std::min(255.0, vpe::core::kPlainGround.r * light); }

// Returns a request for lit ground of one colour on black, drawn from the finest tiles.
inline vpe::core::DrawRequest lit_request(const mars::Pose& pose, int width, int height, double fov_deg) {
  vpe::core::DrawRequest out = request_for(pose, mars::kMarsRadius_m, width, height, fov_deg);
  out.settings.mode = vpe::core::Mode::kLit;
  out.settings.background = vpe::core::Background::kBlack;
  out.settings.smooth_edges = false;
  out.settings.lod_tolerance_px = 0;
  return out;
}

// Returns the red value of a pixel.
inline int red(const vpe::core::DrawResult& result, int x, int y) {
  return result.frame.colour[static_cast<std::size_t>(y * result.frame.width + x)].r;
}

}  // namespace test_support
