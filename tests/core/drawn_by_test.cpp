#include "vpe/core/drawn_by.h"

#include <gtest/gtest.h>

namespace vpe::core {
namespace {

TEST(DrawnBy, WhatIsNamedDraws) {
  for (const bool has_gpu : {false, true}) {
    EXPECT_EQ(backend_for(DrawnBy::kPolygon, {.has_gpu = has_gpu, .height_radii = 0.001}), Backend::kPolygon);
    EXPECT_EQ(backend_for(DrawnBy::kRay, {.has_gpu = has_gpu, .suits_rays = false, .height_radii = 10}),
              Backend::kRay);
  }
  EXPECT_EQ(drawn_by(std::nullopt), DrawnBy::kAuto);
  EXPECT_EQ(drawn_by(Backend::kRay), DrawnBy::kRay);
  EXPECT_EQ(drawn_by(Backend::kPolygon), DrawnBy::kPolygon);
}

TEST(DrawnBy, RaysDrawNearGroundWithoutAGpu) {
  const auto chosen = [](double height_radii, bool has_gpu, bool suits_rays) {
    return backend_for(DrawnBy::kAuto,
                       {.has_gpu = has_gpu, .suits_rays = suits_rays, .height_radii = height_radii});
  };
  EXPECT_EQ(chosen(0.001, false, true), Backend::kRay);
  EXPECT_EQ(chosen(-0.001, false, true), Backend::kRay);
  EXPECT_EQ(chosen(0.001, true, true), Backend::kPolygon);
  EXPECT_EQ(chosen(0.001, false, false), Backend::kPolygon);
  EXPECT_EQ(chosen(1, false, true), Backend::kPolygon);
}

// A camera that hovers about the height keeps its backend.
TEST(DrawnBy, TheChoiceDoesNotChangeToAndFro) {
  Backend now = Backend::kPolygon;
  int changes = 0;
  for (int n = 0; n < 100; ++n) {
    const Backend next = backend_for(
        DrawnBy::kAuto, {.height_radii = kRaysReach_radii * (n % 2 == 0 ? 0.95 : 1.05), .now = now});
    changes += next != now ? 1 : 0;
    now = next;
  }
  EXPECT_EQ(changes, 0);
  for (double height = 0.1; height > 0.001; height *= 0.9) {
    const Backend next = backend_for(DrawnBy::kAuto, {.height_radii = height, .now = now});
    changes += next != now ? 1 : 0;
    now = next;
  }
  EXPECT_EQ(changes, 1);
  EXPECT_EQ(now, Backend::kRay);
}

}  // namespace
}  // namespace vpe::core
