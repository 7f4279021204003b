#include "vpe/explore/images/live_image.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vpe::explore {
namespace {

core::View at(double lon_deg) {
  core::View view;
  view.camera = mars::to_camera({lon_deg, 0, 10'000, 0, -30, 0}, mars::kMarsRadius_m);
  return view;
}

// Imitates images whose time falls with their coarseness.
double cost_ms(double full_ms, double multiplier) { return full_ms / std::pow(multiplier, 1.2); }

TEST(LiveImage, AtRestItEndsWithTheFullImageAndThenNothing) {
  LiveImage live;
  int images = 0;
  double last = 0;
  while (const auto order = live.next(at(0), false, 10'000)) {
    last = order->multiplier;
    live.record(400, true);
    ASSERT_LT(++images, 20);
  }
  EXPECT_GE(images, 1);
  EXPECT_EQ(last, 1.0);
  EXPECT_EQ(live.state(), lod::RefinementState::kWaiting);
  EXPECT_FALSE(live.next(at(0), false, 10'000).has_value());
  const auto again = live.next(at(0), true, 10'000);  // a setting changed
  ASSERT_TRUE(again.has_value());
  EXPECT_TRUE(again->is_full);
}

TEST(LiveImage, IsDrawnAgainWhileTilesArrive) {
  LiveImage live;
  for (int n = 0; n < 30; ++n) {
    ASSERT_TRUE(live.next(at(0), false, 10'000).has_value());
    live.record(20, false);
  }
  ASSERT_TRUE(live.next(at(0), false, 10'000).has_value());
  live.record(20, true);
  EXPECT_FALSE(live.next(at(0), false, 10'000).has_value());
}

TEST(LiveImage, MovingItMeetsItsBudgetByPixelsAndTolerance) {
  LiveImage live({.budget_ms = 50});
  double ms = 0;
  for (int n = 0; n < 60; ++n) {
    const auto order = live.next(at(0.01 * n), false, 10'000);
    ASSERT_TRUE(order.has_value());
    EXPECT_EQ(order->is_full, order->side == 1.0);
    ms = cost_ms(200, order->multiplier / (order->side * order->side));
    live.record(ms, true);
    if (n > 30) {
      EXPECT_LT(order->view.width, 1280);
      EXPECT_NEAR(order->view.width / 1280.0, order->view.height / 720.0, 0.01);
      EXPECT_EQ(order->view.fov_deg, 60);
    }
  }
  EXPECT_LT(ms, 60);
  EXPECT_GT(ms, 35);
}

// A motion begins with the ground of the image at rest, whatever the images at rest have taken.
TEST(LiveImage, ImagesAtRestDoNotMakeTheNextMotionCoarser) {
  LiveImage live({.budget_ms = 50});
  double lon_deg = 0;
  const auto move = [&](double full_ms) {
    const auto order = live.next(at(lon_deg += 0.01), false, 10'000);
    EXPECT_EQ(order->multiplier, 1.0);
    live.record(cost_ms(full_ms, order->is_full ? 1 : 1 / (order->side * order->side)), true);
    return *order;
  };
  for (int n = 0; n < 30; ++n) move(100);
  const double side = move(100).side;
  EXPECT_GT(side, 0.5);
  for (int rest = 0; rest < 5; ++rest) {
    int images = 0;
    while (live.next(at(lon_deg), false, 10'000) && ++images < 20) live.record(5000, true);
    EXPECT_LT(images, 20);
    EXPECT_NEAR(move(100).side, side, 0.1) << rest;
  }
}

TEST(LiveImage, TheToleranceOnTheScreenIsLimited) {
  LiveImage live({.budget_ms = 50});
  double most = 0;
  for (int n = 0; n < 60; ++n) {
    const auto order = live.next(at(0.01 * n), false, 10'000);
    EXPECT_GE(order->side, 1.0 / 3.0);
    if (order->side > 0.34) {
      EXPECT_EQ(order->multiplier, 1.0) << "pixels come first";
    }
    most = std::max(most, order->multiplier);
    live.record(10'000, true);
  }
  EXPECT_NEAR(most, 2.0, 1e-9);
}

TEST(LiveImage, WithoutABudgetImagesAreFull) {
  LiveImage live({.budget_ms = 0});
  for (int n = 0; n < 20; ++n) {
    const auto order = live.next(at(0.5 * n), false, 10'000);
    ASSERT_TRUE(order.has_value());
    EXPECT_TRUE(order->is_full);
    EXPECT_EQ(order->view.width, 1280);
    live.record(1000, true);
  }
}

TEST(LiveImage, OptionsOutOfRangeAreRejected) {
  EXPECT_THROW(LiveImage({.budget_ms = -1}), std::invalid_argument);
  EXPECT_THROW(LiveImage({.budget_ms = 10, .smallest_side = 0}), std::invalid_argument);
  EXPECT_THROW(LiveImage({.budget_ms = 10, .most_tolerance = 0.5}), std::invalid_argument);
}

}  // namespace
}  // namespace vpe::explore
