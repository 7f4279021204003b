// Progressive refinement, by counted frames.
#include "lod/progressive_refinement.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "mars/geodesy/pose.h"
#include "mars/geodesy/sphere.h"
#include "tests/lod/fake_tree.h"
#include "tests/support/support.h"
#include "vpe/core/view.h"

namespace {

using lod::ProgressiveRefinement;
using lod::RefinementInput;
using lod::RefinementOutput;
using lod::RefinementState;
namespace core = vpe::core;

constexpr RefinementInput kRest{0, false, true, 1};

TEST(ProgressiveRefinement, AtRestOneFrameIsDrawnThenNone) {
  ProgressiveRefinement look;
  RefinementOutput out = look.next(kRest);
  EXPECT_TRUE(out.draw);
  EXPECT_EQ(out.multiplier, 1.0);
  EXPECT_EQ(out.state, RefinementState::kRefining);
  for (int frame = 0; frame < 100; ++frame) {
    out = look.next(kRest);
    ASSERT_FALSE(out.draw);
    ASSERT_EQ(out.state, RefinementState::kWaiting);
  }
}

TEST(ProgressiveRefinement, WhatIsNotSettledIsDrawnOn) {
  ProgressiveRefinement look;
  RefinementInput loading = kRest;
  loading.settled = false;
  for (int frame = 0; frame < 20; ++frame) ASSERT_TRUE(look.next(loading).draw);
  EXPECT_FALSE(look.next(kRest).draw);
}

TEST(ProgressiveRefinement, AChangeIsDrawnOnce) {
  ProgressiveRefinement look;
  look.next(kRest);
  ASSERT_FALSE(look.next(kRest).draw);
  RefinementInput changed = kRest;
  changed.changed = true;
  EXPECT_TRUE(look.next(changed).draw);
  EXPECT_FALSE(look.next(kRest).draw);
}

TEST(ProgressiveRefinement, FastIsCoarseAtOnceAndRestIsRefinedByHalves) {
  ProgressiveRefinement look;
  look.next(kRest);
  EXPECT_EQ(look.next({4, false, true, 1}).multiplier, 1.0);  // four pixels a frame: still sharp
  EXPECT_EQ(look.next({12, false, true, 1}).multiplier, 3.0);
  const RefinementOutput fast = look.next({1000, false, true, 1});
  EXPECT_EQ(fast.multiplier, 8.0);
  EXPECT_EQ(fast.state, RefinementState::kMoving);
  // At rest: multipliers 4, 2, 1, then no drawing.
  for (const double wanted : {4.0, 2.0, 1.0}) {
    const RefinementOutput out = look.next(kRest);
    EXPECT_TRUE(out.draw);
    EXPECT_EQ(out.multiplier, wanted);
    EXPECT_EQ(out.state, RefinementState::kRefining);
  }
  EXPECT_FALSE(look.next(kRest).draw);
  // After a small motion of the mouse the image is drawn again, in full.
  const RefinementOutput touch = look.next({1, false, true, 1});
  EXPECT_TRUE(touch.draw);
  EXPECT_EQ(touch.multiplier, 1.0);
  EXPECT_TRUE(look.next(kRest).draw);  // of the pose where it came to rest
  EXPECT_FALSE(look.next(kRest).draw);
}

TEST(ProgressiveRefinement, TheBudgetCountsWhileTheCameraMovesAndNotAtRest) {
  ProgressiveRefinement look;
  EXPECT_EQ(look.next({1, false, true, 20}).multiplier, 20.0);
  EXPECT_EQ(look.next({12, false, true, 20}).multiplier, 20.0);
  RefinementInput rest = kRest;
  rest.budget_multiplier = 20;
  int drawn = 0;
  RefinementOutput out = look.next(rest);
  for (; out.draw && drawn < 100; ++drawn) out = look.next(rest);
  EXPECT_EQ(drawn, 5);  // 10, 5, 2.5, 1.25, 1
  EXPECT_EQ(out.multiplier, 1.0);
}

TEST(ProgressiveRefinement, TheImageThatStaysIsAlwaysTheFullOne) {
  test_support::Random random(71);
  ProgressiveRefinement look;
  double last_drawn = 0;
  bool clean = false;  // nothing moved or changed since the frame drawn last, that frame included
  int waited = 0;
  for (int frame = 0; frame < 20000; ++frame) {
    RefinementInput in;
    const bool moves = random.integer(0, 9) == 0;
    in.motion_px = moves ? random.log_uniform(0.02, 1000) : random.uniform(0, 0.01);
    in.changed = random.integer(0, 29) == 0;
    in.settled = random.integer(0, 2) > 0;
    in.budget_multiplier = random.log_uniform(1, 30);
    const RefinementOutput out = look.next(in);
    ASSERT_GE(out.multiplier, 1.0);
    if (out.draw) {
      last_drawn = out.multiplier;
      clean = true;
    } else {
      ASSERT_TRUE(clean);
      ASSERT_FALSE(moves || in.changed || !in.settled);
      ASSERT_EQ(last_drawn, 1.0);
      ++waited;
    }
  }
  EXPECT_GT(waited, 1000);
}

TEST(ProgressiveRefinement, WhatIsNoNumberIsFastAndBadOptionsAreRefused) {
  ProgressiveRefinement look;
  EXPECT_EQ(look.next({std::nan(""), false, true, 1}).multiplier, 8.0);
  EXPECT_EQ(look.next({std::numeric_limits<double>::infinity(), false, true, 1}).multiplier, 8.0);
  EXPECT_THROW(ProgressiveRefinement({.still_px = -1}), std::invalid_argument);
  EXPECT_THROW(ProgressiveRefinement({.still_px = 5, .sharp_px = 4}), std::invalid_argument);
  EXPECT_THROW(ProgressiveRefinement({.max_multiplier = 0.5}), std::invalid_argument);
  EXPECT_THROW(ProgressiveRefinement({.refine_factor = 1}), std::invalid_argument);
}

core::View view_at(double lon, double alt_m, double yaw, double pitch, double roll) {
  core::View view;
  view.camera = mars::to_camera(mars::Pose{lon, 0, alt_m, yaw, pitch, roll}, fake::kRadius_m);
  return view;
}

TEST(ImageMotion, IsAtLeastWhatPointsMoveBy) {
  test_support::Random random(72);
  double tightest = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const double yaw = random.uniform(0, 360);
    const double pitch = random.uniform(-80, -30);
    const double roll = random.uniform(-20, 20);
    const core::View a = view_at(0, 1e5, yaw, pitch, roll);
    const auto some = [&](double most) { return random.integer(0, 1) == 0 ? 0 : random.uniform(-most, most); };
    const double lon = random.integer(0, 1) * 1e-4;
    const double alt = 1e5 + some(50);
    const glm::dvec3 turn{some(0.05), some(0.05), some(0.05)};
    core::View b = view_at(lon, alt, yaw + turn.x, pitch + turn.y, roll + turn.z);
    if (random.integer(0, 3) == 0) b.fov_deg *= random.uniform(0.999, 1.001);
    const double bound = lod::image_motion_px(a, b, 9.9e4);
    for (int sample = 0; sample < 20; ++sample) {
      const double x = random.uniform(0, a.width);
      const double y = random.uniform(0, a.height);
      const glm::dvec3 point = a.camera.position_m + random.log_uniform(1e5, 1e6) * core::pixel_ray(a, x, y);
      const core::Projected to = core::project(b, point);
      const double moved = std::hypot(to.xy.x - x, to.xy.y - y);
      ASSERT_LE(moved, bound * 1.02 + 1e-9) << trial;
      if (bound > 0) tightest = std::max(tightest, moved / bound);
    }
  }
  EXPECT_GT(tightest, 0.5);
}

TEST(ImageMotion, KnownCases) {
  const core::View view = view_at(0, 1e5, 0, 0, 0);
  EXPECT_EQ(lod::image_motion_px(view, view, 1e5), 0.0);
  EXPECT_EQ(lod::image_motion_px(view, view, 0), 0.0);
  core::View other = view;
  other.width = 640;
  EXPECT_TRUE(std::isinf(lod::image_motion_px(view, other, 1e5)));
  EXPECT_TRUE(std::isinf(lod::image_motion_px(view, view_at(1e-5, 1e5, 0, 0, 0), 0)));
  // Zooming by a hundredth moves the corners by a hundredth of their distance from the middle, 734 px.
  other = view;
  other.fov_deg = 2 / mars::kRadiansPerDegree * std::atan(std::tan(30 * mars::kRadiansPerDegree) / 1.01);
  EXPECT_NEAR(lod::image_motion_px(view, other, 1e5), 7.34, 0.01);
  // A degree of roll as well.
  EXPECT_NEAR(lod::image_motion_px(view, view_at(0, 1e5, 0, 0, 1), 1e5), 734.3 * mars::kRadiansPerDegree, 0.1);
}

}  // namespace
