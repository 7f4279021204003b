// The polygon backend while the camera moves by millimetres, and over nine orders of magnitude in one image.
#include <gtest/gtest.h>

#include "tests/gl/gl_fixture.h"
#include "tests/stability/depth.h"
#include "tests/stability/jitter.h"
#include "tests/support/worst.h"

namespace {

namespace core = vpe::core;
using PolygonMotion = test_support::GlTest;
using test_support::record_worst;

constexpr std::size_t kBudget = std::size_t{1} << 27;

core::DrawRequest request_for(const core::View& view) {
  core::DrawRequest request;
  request.view = view;
  request.settings.samples = 1;
  request.settings.mode = core::Mode::kColoured;
  request.settings.lod_tolerance_px = 0;
  request.want_range = true;
  return request;
}

TEST_F(PolygonMotion, GroundStandsStillUnderMillimetreSteps) {
  for (const mars::LonLat at : {mars::LonLat{-59.2, -13.7}, mars::LonLat{180, 0}, mars::LonLat{30, 90}}) {
    const test_support::FinePlace place(at);
    const auto planet = place.build(dir_ / ("p" + std::to_string(at.lon_deg)));
    const paging::Surface surface(planet, kBudget);
    const auto draw = renderer(planet);
    const auto jitter = test_support::measure_jitter(
        place, surface, 8, [&](const core::View& view) { return draw->draw(request_for(view)).frame.range_m; });
    EXPECT_GT(jitter.measured, 20 * jitter.outlines);
    record_worst("polygons, 1 m up, steps of 1 mm: ground off S", jitter.off_px, test_support::kJitterBound_px,
                 "px");
    record_worst("polygons, 1 m up, steps of 1 mm: change a frame", jitter.step_px,
                 test_support::kJitterBound_px, "px");
  }
}

TEST_F(PolygonMotion, KeepsTheOrderFromATenthOfAMetreToAHundredThousandKilometres) {
  const auto planet =
      test_support::build_ground(dir_ / "p", test_support::kDeepRadius_m, test_support::deep_ground());
  const paging::Surface surface(planet, kBudget);
  const auto draw = renderer(planet);
  for (const double yaw_deg : {0.0, 100.0, 215.0}) {
    const core::View view = test_support::deep_view(surface, yaw_deg);
    const auto order =
        test_support::check_depth_order(surface, view, draw->draw(request_for(view)).frame.range_m);
    EXPECT_LT(order.nearest_m, 0.2);
    EXPECT_GT(order.farthest_m, 6e7);
    // One or two pixels at the outline of the needle under the camera, a millionth of its length away, show
    // sky.
    record_worst("polygons, 0.1 to 10^8 m in one image: pixels out of order", order.wrong / order.pixels, 2e-4,
                 "of all");
  }
}

}  // namespace
