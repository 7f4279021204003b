// Second eyes and frames of films that are carried, against those that are drawn in full.
#include "vpe/app/picture/carried_drawer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "tests/app/pictures/carried_images.h"
#include "vpe/voxel/ray_renderer.h"

namespace {

namespace core = vpe::core;
namespace warp = vpe::warp;
using test_support::Random;
using vpe::app::CarriedDrawer;

constexpr unsigned kSeed = 20261125;
using carried_images::bumpy_planet;
using carried_images::Eyes;
using carried_images::eyes_at;
using carried_images::kHeight;
using carried_images::kWidth;
using carried_images::off_px;

class CarriedDrawerTest : public test_support::GlTest {
 protected:
  CarriedDrawerTest()
      : planet_(bumpy_planet()), rays_(vpe::voxel::make_ray_renderer(planet_, {std::size_t{256} << 20, 2})) {}

  // Returns a pose somewhere above the ground that looks ahead or down.
  mars::Pose any_pose(Random& random, double& height_m) const {
    height_m = std::pow(10.0, random.uniform(3.0, 5.8));
    const double lon_deg = random.uniform(-180, 180);
    const double lat_deg = random.uniform(-89.9, 89.9);
    const double ground_m =
        paging::Surface(planet_, std::size_t{1} << 20).at(mars::direction({lon_deg, lat_deg}), 1).height_m;
    return {lon_deg,
            lat_deg,
            ground_m + height_m,
            random.uniform(0, 360),
            random.uniform(-90, 5),
            random.uniform(-20, 20)};
  }

  std::shared_ptr<const paging::PlanetFile> planet_;
  std::unique_ptr<core::PixelRenderer> rays_;
};

TEST_F(CarriedDrawerTest, CarriedPixelsKeepTheCertificateInFiveHundredPairs) {
  Random random(kSeed);
  CarriedDrawer pair(*rays_, planet_, {.threads = 2});
  double most_share = 0;
  double carried = 0;
  for (int n = 0; n < 500; ++n) {
    double height_m = 0;
    const mars::Pose pose = any_pose(random, height_m);
    const double base_m = height_m * std::pow(10.0, random.uniform(-3.0, -0.8));
    const Eyes eyes = eyes_at(pose, planet_->radius_m(), base_m);
    pair.draw_first(eyes.left);
    const core::DrawResult right = pair.draw_carried(eyes.right);
    const core::DrawResult full = rays_->draw(eyes.right);
    ASSERT_TRUE(right.certificate.carried) << n;
    const double bound_px = right.certificate.shift_bound_px + full.certificate.shift_bound_px;
    const double stretch = core::corner_stretch(eyes.right.view);
    ASSERT_EQ(right.frame.range_m.size(), full.frame.range_m.size());
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const auto at = static_cast<std::size_t>(y * kWidth + x);
        const warp::Origin origin = pair.carried().origin[at];
        if (origin != warp::Origin::kCarried && origin != warp::Origin::kBetween) continue;
        const double off = off_px(eyes.right, base_m, right.frame, full.frame, x, y);
        ASSERT_LE(off, bound_px * stretch + 1e-3) << "pair " << n << ", pixel " << x << ", " << y;
        most_share = std::max(most_share, off / (bound_px * stretch + 1e-3));
      }
    }
    carried += right.certificate.carried->carried_share + right.certificate.carried->between_share;
  }
  std::printf("carried %.3f, largest share of the bound %.3f\n", carried / 500, most_share);
  EXPECT_GT(carried / 500, 0.5);
}

// Returns by how much the ground of a carried pixel is off, in the first image, from the best that the full image has within
// two pixels.
double off_in_first_px(const core::View& from, const core::DrawRequest& request, const core::Frame& is,
                       const core::Frame& full, int x, int y) {
  constexpr int kAround = 2;
  const glm::dvec3 camera_m = request.view.camera.position_m;
  const glm::dvec3 ray = core::pixel_ray(request.view, x + 0.5, y + 0.5);
  const auto place_px = [&](float range_m) {
    return core::project(from, camera_m + static_cast<double>(range_m) * ray).xy;
  };
  const glm::dvec2 carried_px = place_px(is.range_m[static_cast<std::size_t>(y * kWidth + x)]);
  double best_px = std::numeric_limits<double>::infinity();
  for (int v = std::max(y - kAround, 0); v <= std::min(y + kAround, kHeight - 1); ++v) {
    for (int u = std::max(x - kAround, 0); u <= std::min(x + kAround, kWidth - 1); ++u) {
      const float range_m = std::min(full.range_m[static_cast<std::size_t>(v * kWidth + u)], 1e12F);
      best_px = std::min(best_px, glm::length(carried_px - place_px(range_m)));
    }
  }
  return best_px;
}

TEST_F(CarriedDrawerTest, FramesOfTenFilmsKeepTheirBounds) {
  constexpr double kMostAdded_px = 0.5;
  Random random(kSeed + 1);
  CarriedDrawer film(*rays_, planet_, {.most_added_px = kMostAdded_px, .repaints_sky = true, .threads = 2});
  double most_share = 0;
  double carried = 0;
  int frames = 0;
  for (int n = 0; n < 10; ++n) {
    double height_m = 0;
    mars::Pose pose = any_pose(random, height_m);
    core::DrawRequest request = test_support::request_for(pose, planet_->radius_m(), kWidth, kHeight);
    request.settings.mode = core::Mode::kLit;
    request.want_range = true;
    const glm::dvec3 step_m = height_m * glm::dvec3(random.uniform(-0.02, 0.02), random.uniform(-0.02, 0.02),
                                                    random.uniform(-0.02, 0.02));
    const double turn_deg = random.uniform(-1, 1);
    const double nod_deg = random.uniform(-0.5, 0.5);
    film.draw_first(request);
    const core::View first = request.view;
    for (int k = 1; k < 8; ++k, ++frames) {
      pose.yaw_deg += turn_deg;
      pose.pitch_deg += nod_deg;
      request.view = test_support::request_for(pose, planet_->radius_m(), kWidth, kHeight).view;
      request.view.camera.position_m += static_cast<double>(k) * step_m;
      const core::DrawResult is = film.draw_carried(request);
      const core::DrawResult full = rays_->draw(request);
      ASSERT_TRUE(is.certificate.carried) << n << ", frame " << k;
      ASSERT_LE(is.certificate.carried->added_px, kMostAdded_px + 2 * warp::kCarriedPosition_px);
      // Bounds are of the new image's middle; in the first image it is larger or smaller by the ratio of distances.
      const double bound_px = (is.certificate.shift_bound_px + full.certificate.shift_bound_px) *
                                  core::corner_stretch(request.view) * 1.2 +
                              1e-3;
      for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
          const auto at = static_cast<std::size_t>(y * kWidth + x);
          const warp::Origin origin = film.carried().origin[at];
          if (origin != warp::Origin::kCarried && origin != warp::Origin::kBetween) continue;
          const double off = off_in_first_px(first, request, is.frame, full.frame, x, y);
          ASSERT_LE(off, bound_px) << "film " << n << ", frame " << k << ", pixel " << x << ", " << y;
          most_share = std::max(most_share, off / bound_px);
        }
      }
      carried += is.certificate.carried->carried_share + is.certificate.carried->between_share;
    }
  }
  std::printf("carried %.3f, largest share of the bound %.3f\n", carried / frames, most_share);
  EXPECT_GT(carried / frames, 0.5);
}

TEST_F(CarriedDrawerTest, SkiesAreThoseOfTheNewCamera) {
  core::DrawRequest request =
      test_support::request_for({10, 20, 15'000, 40, 2, 0}, planet_->radius_m(), kWidth, kHeight);
  request.settings.mode = core::Mode::kLit;
  request.settings.smooth_edges = false;
  request.want_range = true;
  CarriedDrawer film(*rays_, planet_, {.repaints_sky = true, .threads = 2});
  film.draw_first(request);
  // A little higher the sky is darker.
  request.view =
      test_support::request_for({10, 20, 16'000, 41, 1, 0}, planet_->radius_m(), kWidth, kHeight).view;
  const core::DrawResult is = film.draw_carried(request);
  const core::DrawResult full = rays_->draw(request);
  int skies = 0;
  for (std::size_t n = 0; n < is.frame.colour.size(); ++n) {
    if (film.carried().origin[n] != warp::Origin::kSky || full.frame.range_m[n] != core::kSkyRange) continue;
    ++skies;
    ASSERT_EQ(is.frame.colour[n], full.frame.colour[n]) << n;
    ASSERT_EQ(is.frame.range_m[n], core::kSkyRange);
  }
  EXPECT_GT(skies, 500);
}

TEST_F(CarriedDrawerTest, AMarginLeavesNoStripAtTheBorder) {
  core::DrawRequest request = eyes_at({10, 20, 15'000, 40, -12, 0}, planet_->radius_m(), 500).left;
  core::DrawRequest turned = request;
  turned.view = eyes_at({10, 20, 15'000, 43, -12, 0}, planet_->radius_m(), 500).left.view;
  CarriedDrawer film(*rays_, planet_, {.threads = 2});
  const core::DrawResult full = film.draw_first(request);
  const double strip = film.draw_carried(turned).certificate.carried->drawn_share;
  const core::DrawResult first = film.draw_first(request, {12, 4});
  const double rest = film.draw_carried(turned).certificate.carried->drawn_share;
  EXPECT_GT(strip, 0.03);
  EXPECT_LT(rest, 0.01);
  ASSERT_EQ(first.frame.colour.size(), full.frame.colour.size());
  for (std::size_t n = 0; n < full.frame.range_m.size(); ++n) {
    if (full.frame.range_m[n] == core::kSkyRange) continue;
    ASSERT_NEAR(first.frame.range_m[n] / full.frame.range_m[n], 1, 1e-3) << n;
  }
  EXPECT_EQ(first.certificate.corner_stretch, full.certificate.corner_stretch);
}

TEST_F(CarriedDrawerTest, AnImageOfWhichLittleIsKnownIsDrawnInFull) {
  CarriedDrawer film(*rays_, planet_, {.most_drawn_share = 0.25, .threads = 2});
  core::DrawRequest request = eyes_at({10, 20, 15'000, 40, -12, 0}, planet_->radius_m(), 500).left;
  film.draw_first(request);
  request.view = eyes_at({10, 20, 15'000, 75, -12, 0}, planet_->radius_m(), 500).left.view;
  const core::DrawResult is = film.draw_carried(request);
  EXPECT_FALSE(is.certificate.carried);
  EXPECT_EQ(is.frame.colour, rays_->draw(request).frame.colour);
}

TEST_F(CarriedDrawerTest, TheFirstEyeIsThatOfTheRenderer) {
  CarriedDrawer pair(*rays_, planet_, {.threads = 2});
  for (const bool smooth : {true, false}) {
    for (const bool want_range : {true, false}) {
      core::DrawRequest request = eyes_at({10, 20, 15'000, 40, -12, 0}, planet_->radius_m(), 500).left;
      request.settings.smooth_edges = smooth;
      request.settings.gamma = 1.7;
      request.want_range = want_range;
      const core::DrawResult full = rays_->draw(request);
      const core::DrawResult first = pair.draw_first(request);
      EXPECT_EQ(first.frame.colour, full.frame.colour);
      EXPECT_EQ(first.frame.range_m, full.frame.range_m);
      EXPECT_EQ(core::to_json(first.certificate), core::to_json(full.certificate));
    }
  }
}

TEST_F(CarriedDrawerTest, TheCertificateSaysWhatIsCarried) {
  CarriedDrawer pair(*rays_, planet_, {.threads = 2});
  const Eyes eyes = eyes_at({10, 20, 15'000, 40, -12, 0}, planet_->radius_m(), 500);
  const core::Certificate first = pair.draw_first(eyes.left).certificate;
  EXPECT_FALSE(first.carried);
  const core::Certificate second = pair.draw_carried(eyes.right).certificate;
  ASSERT_TRUE(second.carried);
  EXPECT_GT(second.carried->carried_share, 0.5);
  EXPECT_GT(second.carried->drawn_share, 0);
  EXPECT_NEAR(second.carried->carried_share + second.carried->between_share + second.carried->drawn_share, 1,
              1e-12);
  EXPECT_GE(second.shift_bound_px, first.shift_bound_px + second.carried->added_px);
  EXPECT_LE(second.carried->added_px, 1 + 2 * warp::kCarriedPosition_px);
  EXPECT_FALSE(second.image_bound_px);
  const std::string json = core::to_json(second).dump();
  for (const char* key : {"carrying_px", "carried_share", "between_share", "drawn_share"})
    EXPECT_NE(json.find(key), std::string::npos) << key;
  EXPECT_EQ(core::to_json(first).dump().find("carrying_px"), std::string::npos);
}

TEST_F(CarriedDrawerTest, ThreadsChangeNoBit) {
  const Eyes eyes = eyes_at({10, 20, 15'000, 40, -12, 5}, planet_->radius_m(), 500);
  std::vector<core::Frame> frames;
  for (const int threads : {1, 3}) {
    const auto rays = vpe::voxel::make_ray_renderer(planet_, {std::size_t{256} << 20, threads});
    CarriedDrawer pair(*rays, planet_, {.threads = threads});
    pair.draw_first(eyes.left);
    frames.push_back(pair.draw_carried(eyes.right).frame);
  }
  EXPECT_EQ(frames[0].colour, frames[1].colour);
  EXPECT_EQ(frames[0].range_m, frames[1].range_m);
}

TEST_F(CarriedDrawerTest, ACameraBelowTheGroundIsDrawnInFull) {
  CarriedDrawer pair(*rays_, planet_, {.threads = 2});
  const Eyes above = eyes_at({10, 20, 15'000, 40, -12, 0}, planet_->radius_m(), 500);
  const Eyes below = eyes_at({10, 20, -15'000, 40, -12, 0}, planet_->radius_m(), 500);
  const core::DrawResult full = rays_->draw(below.right);
  ASSERT_TRUE(full.certificate.is_below_ground);
  for (const core::DrawRequest& left : {above.left, below.left}) {
    pair.draw_first(left);
    const core::DrawResult right = pair.draw_carried(below.right);
    EXPECT_EQ(right.frame.colour, full.frame.colour);
    EXPECT_TRUE(right.certificate.is_below_ground);
    EXPECT_FALSE(right.certificate.carried);
    EXPECT_TRUE(pair.carried().origin.empty());
  }
}

TEST_F(CarriedDrawerTest, SaysWhatCannotBeCarried) {
  CarriedDrawer pair(*rays_, planet_, {.threads = 1});
  core::DrawRequest request = eyes_at({10, 20, 15'000, 40, -12, 0}, planet_->radius_m(), 500).right;
  EXPECT_THROW((void)pair.draw_carried(request), std::logic_error);
  EXPECT_EQ(vpe::app::why_not_carried(request), "");
  request.settings.samples = 4;
  EXPECT_NE(vpe::app::why_not_carried(request).find("samples"), std::string::npos);
  request.settings.samples = 1;
  request.settings.mode = core::Mode::kWireframe;
  EXPECT_NE(vpe::app::why_not_carried(request), "");
  request.settings.mode = core::Mode::kLit;
  request.view.projection = core::Projection::kCylinder;
  EXPECT_NE(vpe::app::why_not_carried(request).find("perspective"), std::string::npos);
}

}  // namespace
