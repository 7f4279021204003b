// Images with a margin.
#include "vpe/core/margin.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <vector>

namespace vpe::core {
namespace {

View view_towards(double yaw_deg, double pitch_deg) {
  View view;
  view.width = 320;
  view.height = 200;
  view.fov_deg = 40;
  view.principal_offset_px = {7, -3};
  view.camera = mars::to_camera({10, 20, 5000, yaw_deg, pitch_deg, 4}, 3'396'190);
  return view;
}

TEST(Margin, ThePixelsOfTheImageKeepTheirRays) {
  const View view = view_towards(30, -10);
  const View wide = with_margin(view, {24, 9});
  EXPECT_EQ(check(wide), "");
  EXPECT_EQ(wide.width, 368);
  EXPECT_EQ(wide.height, 218);
  EXPECT_NEAR(focal_px(wide), focal_px(view), 1e-10);
  for (const glm::dvec2& at : {glm::dvec2(0.5, 0.5), glm::dvec2(319.5, 0.5), glm::dvec2(100.5, 199.5)}) {
    const glm::dvec3 apart = pixel_ray(wide, at.x + 24, at.y + 9) - pixel_ray(view, at.x, at.y);
    EXPECT_LT(glm::length(apart), 1e-14);
  }
  EXPECT_EQ(with_margin(view, {0, 0}).fov_deg, view.fov_deg);
}

TEST(Margin, CoversWhatOtherViewsShow) {
  const View view = view_towards(30, -10);
  const std::vector<View> others{view_towards(31, -10), view_towards(30, -9.5)};
  const glm::ivec2 most(100, 100);
  const glm::ivec2 margin = margin_for(view, others, 1000, most);
  const double px_deg = focal_px(view) * 3.14159265 / 180;
  EXPECT_GE(margin.x, static_cast<int>(px_deg));
  EXPECT_LE(margin.x, static_cast<int>(1.5 * px_deg));
  EXPECT_GE(margin.y, static_cast<int>(0.5 * px_deg));
  const View wide = with_margin(view, margin);
  for (const View& other : others) {
    for (const glm::dvec2& corner :
         {glm::dvec2(0, 0), glm::dvec2(320, 0), glm::dvec2(0, 200), glm::dvec2(320, 200)}) {
      const Projected seen =
          project(wide, other.camera.position_m + 1e9 * pixel_ray(other, corner.x, corner.y));
      EXPECT_GE(seen.xy.x, -1e-6);
      EXPECT_GE(seen.xy.y, -1e-6);
      EXPECT_LE(seen.xy.x, wide.width + 1e-6);
      EXPECT_LE(seen.xy.y, wide.height + 1e-6);
    }
  }
  EXPECT_EQ(margin_for(view, std::vector<View>{view}, 1000, most), glm::ivec2(0));
  EXPECT_EQ(margin_for(view, {}, 1000, most), glm::ivec2(0));
  // Another direction altogether is not covered.
  EXPECT_EQ(margin_for(view, std::vector<View>{view_towards(210, 0)}, 1000, most), most);
}

TEST(Margin, IsCutOff) {
  Frame frame{5, 4, {}, {}};
  for (int n = 0; n < 20; ++n) {
    frame.colour.push_back({static_cast<std::uint8_t>(n), 0, 0});
    frame.range_m.push_back(static_cast<float>(n));
  }
  const Frame inner = without_margin(frame, {1, 1});
  EXPECT_EQ(inner.width, 3);
  EXPECT_EQ(inner.height, 2);
  EXPECT_EQ(inner.range_m, (std::vector<float>{6, 7, 8, 11, 12, 13}));
  EXPECT_EQ(inner.colour[3].r, 11);
  const RgbImage image = without_margin(RgbImage{5, 4, frame.colour}, {1, 1});
  EXPECT_EQ(image.width, 3);
  EXPECT_EQ(image.pixels, inner.colour);
  frame.colour.clear();
  EXPECT_TRUE(without_margin(frame, {1, 1}).colour.empty());
}

}  // namespace
}  // namespace vpe::core
