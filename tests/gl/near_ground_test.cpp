// Ground so near that triangles reach behind the camera: they are cut, and leave no hole to those beside them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "tests/gl/appearance_fixture.h"
#include "tests/gl/gl_fixture.h"
#include "tests/paging/patch_between.h"

namespace {

namespace core = vpe::core;
using test_support::kPatched;
using test_support::Random;

class NearGroundTest : public test_support::GlTest {
 protected:
  // Posts are 9 km apart, so that the camera of a view is over one or two cells.
  std::shared_ptr<const paging::PlanetFile> planet_ = test_support::build_changed(dir_ / "a.vpe", {});
  std::unique_ptr<core::Renderer> draw_ = renderer(planet_);
  paging::Surface surface_{planet_, std::size_t{16} << 20};
  Random random_{3};

  core::DrawRequest next_request() {
    const mars::LonLat place = mars::lon_lat(glm::normalize(kPatched + 0.1 * random_.direction()));
    const double height_m = surface_.at(mars::direction(place)).height_m + random_.log_uniform(50, 5000);
    const mars::Pose pose{
        place.lon_deg,           place.lat_deg, height_m, random_.uniform(0, 360), random_.uniform(-85, -55),
        random_.uniform(-30, 30)};
    core::DrawRequest request = test_support::request_for(pose, planet_->radius_m(), 96, 64, 50);
    request.settings.lod_tolerance_px = 0;
    return request;
  }
};

TEST_F(NearGroundTest, HasNoHoleWhereTrianglesReachBehindTheCamera) {
  std::int64_t holes = 0;
  for (int n = 0; n < 1000; ++n) {
    const core::DrawResult result = draw_->draw(next_request());
    holes += std::ranges::count_if(result.frame.range_m, [](float range) { return !std::isfinite(range); });
  }
  EXPECT_EQ(holes, 0);
}

// Corners that are cut have the height, the place in the texture and the air of the edge there.
TEST_F(NearGroundTest, HasTheColoursOfTheDefinition) {
  const auto wavy = test_support::wavy_planet(dir_ / "wavy.vpe");
  const paging::Surface surface(wavy, std::size_t{16} << 20);
  const auto draw = renderer(wavy);
  const mars::LonLat place = mars::lon_lat(test_support::kWavyMiddle);
  const double ground_m = surface.at(test_support::kWavyMiddle).height_m;
  for (const double yaw_deg : {0.0, 90.0, 180.0, 270.0}) {
    core::DrawRequest request = test_support::request_for(
        {place.lon_deg, place.lat_deg, ground_m + 500, yaw_deg, -35, 10}, wavy->radius_m(), 64, 48, 60);
    request.settings.lod_tolerance_px = 0;
    request.settings.background = core::Background::kBlack;
    request.settings.smooth_edges = false;
    request.settings.colour = core::Colour::kElevation;
    request.settings.palette_low = ground_m - 300;
    request.settings.palette_high = ground_m + 300;
    request.settings.mode = core::Mode::kUnlit;
    EXPECT_GE(test_support::agreement(*draw, surface, request), 0.999) << "a palette, " << yaw_deg;
    request.settings.mode = core::Mode::kTextured;
    EXPECT_GE(test_support::agreement(*draw, surface, request), 0.999) << "a texture, " << yaw_deg;
  }
}

}  // namespace
