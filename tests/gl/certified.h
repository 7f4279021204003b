// Checks what a certificate promises on one image, against exact casts of the reference surface.
#pragma once

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/gl/gl_fixture.h"
#include "tests/support/worst.h"

namespace test_support {

// Returns the error of the range image itself (vpe::gl::kRangeError), which moves points along their rays, in
// pixels. No certificate states it.
inline double range_error_px(const vpe::core::View& view, const std::vector<float>& range_m) {
  float nearest = vpe::core::kSkyRange;
  float farthest = 0;
  for (const float range : range_m) {
    nearest = std::min(nearest, range);
    if (std::isfinite(range)) farthest = std::max(farthest, range);
  }
  return vpe::gl::kRangeError * (1.0 + farthest / nearest) * vpe::core::focal_px(view);
}

// Expects an image to be within its certificate; with `range_share` 1 also by the error of its range image.
inline void expect_certified(vpe::core::Renderer& renderer, const paging::Surface& surface,
                             const vpe::core::DrawRequest& request, const std::string& name,
                             double range_share = 0) {
  const vpe::core::DrawResult result = renderer.draw(request);
  const std::vector<float> reference = reference_ranges(surface, request.view);
  const vpe::core::ImageErrors errors = vpe::core::compare_to_reference(request.view, result.frame.range_m,
                                                                        reference, radius_of(surface), {4, 2});
  SCOPED_TRACE(name + " " + vpe::core::to_json(errors) + " " + vpe::core::to_json(result.certificate).dump(2));
  EXPECT_EQ(errors.sky_for_ground, 0);
  EXPECT_EQ(errors.false_surface, 0);
  EXPECT_EQ(errors.invalid, 0);
  ASSERT_TRUE(result.certificate.image_bound_px.has_value());
  const double range_px = range_share * range_error_px(request.view, result.frame.range_m);
  record_worst("polygons: forward shift",
               errors.forward.max_px / (*result.certificate.image_bound_px + range_px), 1,
               "of the certificate");
  EXPECT_LE(*result.certificate.image_bound_px, result.certificate.shift_bound_px);
  EXPECT_LE(errors.forward.p999_px, 1.0);
  record_worst("polygons: backward shift, 99.9 % of the pixels", errors.backward.p999_px, 1.5, "px");
  const paging::PlanetMeta& meta = surface.planet().meta();
  const auto horizon = vpe::core::check_horizon(request.view, result.frame.range_m,
                                                meta.lowest_radius_m - result.certificate.geometric_error_m,
                                                meta.highest_radius_m);
  EXPECT_EQ(horizon.sky_below, 0);
  EXPECT_EQ(horizon.surface_above, 0);
  EXPECT_EQ(result.certificate.tiles_missing, 0);
}

}  // namespace test_support
