// Tests images of smooth ground by the ray backend: certificates, nodata, cameras below patches, real data.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "mars/geodesy/sun.h"
#include "mars/sources/source.h"
#include "tests/voxel/smooth/smooth_fixture.h"
#include "vpe/core/below_ground.h"
#include "vpe/voxel/ray_renderer.h"
#include "vpe/voxel/smooth/smooth_caster.h"

namespace {

namespace core = vpe::core;
using test_support::Random;
using test_support::SmoothPlanet;

core::DrawRequest smooth_request(const mars::Pose& pose, double radius_m) {
  core::DrawRequest request;
  request.view.camera = mars::to_camera(pose, radius_m);
  request.view.width = 96;
  request.view.height = 64;
  request.view.fov_deg = 60;
  request.settings.samples = 1;
  request.settings.mode = core::Mode::kColoured;
  request.settings.ray_mode = core::RayMode::kPerturbation;
  request.settings.smooth_edges = false;
  request.sun = mars::sun_direction({pose.lon_deg, pose.lat_deg}, 315, 40);
  request.want_range = true;
  return request;
}

std::unique_ptr<core::PixelRenderer> rays(const SmoothPlanet& planet, int threads = 2) {
  return vpe::voxel::make_ray_renderer(planet.planet,
                                       {.memory_bytes = std::size_t{256} << 20, .threads = threads});
}

class SmoothImages : public testing::Test {
 protected:
  SmoothImages() : planet_(test_support::levels_planet(dir_ / "levels.vpe")) {}

  // A camera `height_m` above the smooth ground.
  core::DrawRequest request(double lon_deg, double lat_deg, double height_m, double pitch_deg = -20) const {
    const double ground_m = planet_.ground.at(mars::direction({lon_deg, lat_deg}), {}).height_m;
    return smooth_request({lon_deg, lat_deg, ground_m + height_m, 30, pitch_deg, 0}, planet_.ground.radius_m());
  }

  test_support::TempDir dir_;
  SmoothPlanet planet_;
};

TEST_F(SmoothImages, TheCertificateStatesWhatSmoothingAdds) {
  const auto draw = rays(planet_);
  core::DrawRequest smooth = request(12, 34, 20000);
  const core::DrawResult drawn = draw->draw(smooth);
  EXPECT_GT(drawn.certificate.smoothing_m, 1);
  EXPECT_GT(drawn.certificate.smoothing_px, 0.1);
  EXPECT_GE(drawn.certificate.shift_bound_px, drawn.certificate.smoothing_px);
  EXPECT_EQ(drawn.certificate.geometric_error_m, 0);
  EXPECT_TRUE(core::to_json(drawn.certificate).contains("smoothing_px"));
  EXPECT_TRUE(drawn.settled);
  // The ranges are those of the caster.
  std::vector<float> range_m(drawn.frame.range_m.size());
  vpe::base::ThreadPool pool(1);
  const auto usage = cast_smooth(planet_.ground, smooth.view, {}, pool, {range_m});
  EXPECT_EQ(drawn.frame.range_m, range_m);
  EXPECT_EQ(drawn.certificate.smoothing_m, usage.smoothing_m);

  smooth.settings.ray_mode = core::RayMode::kExact;
  const core::DrawResult exact = draw->draw(smooth);
  EXPECT_EQ(exact.certificate.smoothing_m, 0);
  EXPECT_FALSE(core::to_json(exact.certificate).contains("smoothing_px"));
  EXPECT_NE(exact.frame.range_m, range_m);
  EXPECT_NE(exact.frame.colour, drawn.frame.colour);
}

TEST_F(SmoothImages, ThreadsAndBilinearPatches) {
  const core::DrawRequest bicubic = request(-70, 10, 5000);
  const core::DrawResult one = rays(planet_, 1)->draw(bicubic);
  const core::DrawResult four = rays(planet_, 4)->draw(bicubic);
  EXPECT_EQ(one.frame.range_m, four.frame.range_m);
  EXPECT_EQ(one.frame.colour, four.frame.colour);
  core::DrawRequest bilinear = bicubic;
  bilinear.settings.ray_patch = core::RayPatch::kBilinear;
  EXPECT_NE(rays(planet_)->draw(bilinear).frame.range_m, one.frame.range_m);
}

// Single pixels are those of the whole image.
TEST_F(SmoothImages, WantedPixelsAreThoseOfTheImage) {
  const auto draw = rays(planet_);
  const core::DrawRequest whole = request(45, 35, 3000, -5);
  const core::DrawResult drawn = draw->draw(whole);
  const std::size_t count = drawn.frame.range_m.size();
  Random random(41);
  std::vector<std::uint8_t> wanted(count);
  for (auto& pixel : wanted) pixel = random.integer(0, 1) == 0 ? 1 : 0;
  core::Frame frame = drawn.frame;
  for (std::size_t n = 0; n < count; ++n) {
    if (wanted[n] == 0) continue;
    frame.range_m[n] = -1;
    frame.colour[n] = {1, 2, 3};
  }
  const std::vector<float> clear_m(count, 0);
  draw->draw_pixels(whole, {wanted, clear_m}, frame);
  EXPECT_EQ(frame.range_m, drawn.frame.range_m);
  EXPECT_EQ(frame.colour, drawn.frame.colour);
}

TEST_F(SmoothImages, SeveralSamplesAndCoarserImages) {
  const auto draw = rays(planet_);
  core::DrawRequest samples = request(0, 0, 8000);
  const core::DrawResult one = draw->draw(samples);
  samples.settings.samples = 4;
  const core::DrawResult four = draw->draw(samples);
  EXPECT_EQ(four.frame.range_m, one.frame.range_m);
  EXPECT_GT(four.certificate.smoothing_px, 0);
  // Coarser images, of windows in motion, are cast in cells.
  samples.settings.samples = 1;
  samples.coarsening = 4;
  const core::DrawResult coarse = draw->draw(samples);
  EXPECT_EQ(coarse.certificate.smoothing_m, 0);
  EXPECT_GT(coarse.certificate.shift_bound_px, 0);
}

// A place between posts where the patch is above the reference surface: a camera between both is below ground.
TEST_F(SmoothImages, ACameraBelowThePatchesIsBelowGround) {
  Random random(42);
  int found = 0;
  for (int n = 0; n < 1000 && found < 3; ++n) {
    const glm::dvec3 up = random.direction();
    const double smooth_m = planet_.ground.at(up, {}).height_m;
    const double flat_m = planet_.surface.at(up).height_m;
    if (smooth_m < flat_m + 10) continue;
    ++found;
    const mars::LonLat place = mars::lon_lat(up);
    core::DrawRequest between = smooth_request(
        {place.lon_deg, place.lat_deg, 0.5 * (smooth_m + flat_m), 0, 0, 0}, planet_.ground.radius_m());
    EXPECT_TRUE(rays(planet_)->draw(between).certificate.is_below_ground);
    between.settings.ray_mode = core::RayMode::kExact;
    EXPECT_FALSE(rays(planet_)->draw(between).certificate.is_below_ground);
  }
  EXPECT_EQ(found, 3);
}

TEST(SmoothNodata, IsPaintedWhereTheDataEnd) {
  const test_support::TempDir dir;
  const glm::dvec3 middle = mars::direction({10, 20});
  const SmoothPlanet planet(test_support::levels_planet(dir / "hole.vpe", [=](const glm::dvec3& d) {
    return glm::length(d - middle) < 0.25 ? NAN : test_support::bumpy_height(d);
  }));
  core::DrawRequest request = smooth_request({10, 20, 4e6, 0, -90, 0}, planet.ground.radius_m());
  const auto draw = rays(planet);
  const double smooth = draw->draw(request).certificate.nodata_share.value();
  request.settings.ray_mode = core::RayMode::kExact;
  const double exact = draw->draw(request).certificate.nodata_share.value();
  EXPECT_GT(exact, 0.02);
  EXPECT_NEAR(smooth, exact, 0.1 * exact);
}

// Of the data of MOLA: sphere and patches are the planet within the stated distance.
TEST(SmoothMola, AgreesWithThePlanet) {
  VPE_NEED_SHARED(dem, "mola4/megt90n000cb.lbl");
  const test_support::TempDir dir;
  const auto source = mars::open_elevation(dem.string());
  paging::BuildOptions options;
  options.output = (dir / "mola.vpe").string();
  options.base_spacing_m = 30000;
  options.threads = 2;
  paging::build_planet(options, *source, nullptr);
  const SmoothPlanet planet(paging::PlanetFile::open(options.output));
  Random random(43);
  const auto draw = rays(planet);
  std::int64_t pixels = 0;
  std::int64_t off = 0;
  for (int n = 0; n < 40; ++n) {
    const mars::LonLat place = mars::lon_lat(random.direction());
    const double ground_m = planet.ground.at(mars::direction(place), {}).height_m;
    const core::DrawRequest request =
        smooth_request({place.lon_deg, place.lat_deg, ground_m + random.log_uniform(100, 1e7),
                        random.uniform(0, 360), random.uniform(-90, 0), 0},
                       planet.ground.radius_m());
    const core::DrawResult drawn = draw->draw(request);
    for (std::size_t k = 0; k < drawn.frame.range_m.size(); ++k) {
      const auto range = static_cast<double>(drawn.frame.range_m[k]);
      if (!std::isfinite(range)) continue;
      const glm::dvec3 point_m = request.view.camera.position_m +
                                 range * core::pixel_ray(request.view, static_cast<double>(k % 96) + 0.5,
                                                         static_cast<double>(k / 96) + 0.5);
      ++pixels;
      const double over_m = std::abs(glm::length(point_m) - planet.surface.at(point_m).radius_m);
      off += over_m > drawn.certificate.smoothing_m + 1.2e-7 * range ? 1 : 0;
    }
  }
  std::printf("%lld pixels, %lld beyond the stated distance\n", static_cast<long long>(pixels),
              static_cast<long long>(off));
  EXPECT_GT(pixels, 50000);
  EXPECT_EQ(off, 0);
}

}  // namespace
