// The ray backend while the camera moves by millimetres, and over nine orders of magnitude in one image.
#include "tests/stability/jitter.h"

#include <gtest/gtest.h>

#include "tests/stability/depth.h"
#include "tests/support/worst.h"
#include "vpe/base/parallel.h"
#include "vpe/voxel/cast/range_caster.h"

namespace {

namespace core = vpe::core;
using test_support::record_worst;
using vpe::voxel::RangeCaster;

constexpr std::size_t kBudget = std::size_t{1} << 27;

std::vector<float> cast(RangeCaster& caster, const core::View& view) {
  vpe::base::ThreadPool pool(2);
  const glm::ivec2 size = core::drawn_size(view);
  std::vector<float> out(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y), -1.0F);
  caster.cast(view, {}, pool, out);
  return out;
}

TEST(Jitter, GroundOfRaysStandsStillUnderMillimetreSteps) {
  test_support::TempDir dir;
  for (const mars::LonLat at : {mars::LonLat{-59.2, -13.7}, mars::LonLat{180, 0}, mars::LonLat{30, 90}}) {
    const test_support::FinePlace place(at);
    RangeCaster caster(place.build(dir / ("p" + std::to_string(at.lon_deg))), kBudget);
    const auto jitter = test_support::measure_jitter(
        place, caster.surface(), 12, [&](const core::View& view) { return cast(caster, view); });
    EXPECT_GT(jitter.measured, 20 * jitter.outlines);
    record_worst("rays, 1 m up, steps of 1 mm: ground off S", jitter.off_px, test_support::kJitterBound_px,
                 "px");
    record_worst("rays, 1 m up, steps of 1 mm: change a frame", jitter.step_px, test_support::kJitterBound_px,
                 "px");
  }
}

// The camera's own pixels of a point that stands still: no step beyond what was moved.
TEST(Jitter, ProjectedPostsMoveSmoothly) {
  test_support::TempDir dir;
  const test_support::FinePlace place({-59.2, -13.7});
  const paging::Surface surface(place.build(dir / "p"), kBudget);
  test_support::Random random(331);
  double worst_px = 0;
  for (int n = 0; n < 200; ++n) {
    const double east_m = random.uniform(-6, 6);
    const double north_m = random.uniform(-6, 6);
    const glm::dvec3 d = glm::normalize(
        place.frame.up + (place.frame.east * east_m + place.frame.north * north_m) / mars::kMarsRadius_m);
    const glm::dvec3 post = d * surface.at(d).radius_m;
    std::vector<glm::dvec2> at;
    for (int frame = 0; frame < 200; ++frame) {
      const core::Projected p = core::project(test_support::millimetre_view(place, surface, 20, frame), post);
      if (p.behind || p.depth_m < 0.5) break;
      at.push_back(p.xy);
    }
    // A smooth curve: its third difference is nothing but rounding.
    for (std::size_t k = 3; k < at.size(); ++k) {
      const glm::dvec2 third = (at[k] - at[k - 3]) - 3.0 * (at[k - 1] - at[k - 2]);
      worst_px = std::max(worst_px, glm::length(third));
    }
  }
  record_worst("projected posts, 1 m up, steps of 1 mm: third difference", worst_px, 1e-3, "px");
}

TEST(Depth, RaysKeepTheOrderFromATenthOfAMetreToAHundredThousandKilometres) {
  test_support::TempDir dir;
  RangeCaster caster(
      test_support::build_ground(dir / "p", test_support::kDeepRadius_m, test_support::deep_ground()), kBudget);
  for (const double yaw_deg : {0.0, 100.0, 215.0}) {
    const core::View view = test_support::deep_view(caster.surface(), yaw_deg);
    const auto order = test_support::check_depth_order(caster.surface(), view, cast(caster, view));
    EXPECT_LT(order.nearest_m, 0.2);
    EXPECT_GT(order.farthest_m, 6e7);
    record_worst("rays, 0.1 to 10^8 m in one image: pixels out of order", order.wrong / order.pixels, 0,
                 "of all");
  }
}

}  // namespace
