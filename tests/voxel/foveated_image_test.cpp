// Tests rays.fovea: the middle is that of the image without it, and what thinning adds is stated.
#include "vpe/voxel/foveated_image.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "tests/gl/appearance_fixture.h"
#include "tests/gl/gl_fixture.h"
#include "tests/paging/rough_planet.h"
#include "vpe/core/metrics.h"
#include "vpe/voxel/ray_renderer.h"

namespace {

namespace core = vpe::core;
using test_support::Random;
using test_support::request_for;
using vpe::voxel::fovea_plan;
using vpe::voxel::FoveaPlan;

class Fovea : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    dir_ = std::make_unique<test_support::TempDir>();
    test_support::build_rough(*dir_ / "rough.vpe");
    planets_.push_back(test_support::wavy_planet(*dir_ / "wavy.vpe"));
    planets_.push_back(paging::PlanetFile::open(*dir_ / "rough.vpe"));
  }
  static void TearDownTestSuite() {
    planets_.clear();
    dir_.reset();
  }
  static std::unique_ptr<core::Renderer> rays(const std::shared_ptr<const paging::PlanetFile>& planet) {
    return vpe::voxel::make_ray_renderer(planet, {std::size_t{256} << 20, 2});
  }
  static std::shared_ptr<const paging::PlanetFile> wavy() { return planets_.front(); }

  static core::DrawRequest over_waves(int width, int height, double share) {
    const mars::LonLat place = mars::lon_lat(test_support::kWavyMiddle);
    core::DrawRequest request =
        request_for({place.lon_deg, place.lat_deg, 30000, 40, -15, 5}, wavy()->radius_m(), width, height, 50);
    request.settings.ray_mode = core::RayMode::kMultires;
    request.settings.ray_fovea = share;
    return request;
  }

  static inline std::unique_ptr<test_support::TempDir> dir_;
  static inline std::vector<std::shared_ptr<const paging::PlanetFile>> planets_;
};

core::DrawRequest without_fovea(core::DrawRequest request) {
  request.settings.ray_fovea.reset();
  return request;
}

// Calls `pixel` with the index of each pixel of the drawn part and its position in the full image.
template <typename Pixel>
void for_pixels(const core::View& view, const Pixel& pixel) {
  const core::SubRectangle part = core::drawn_part(view);
  std::size_t at = 0;
  for (int y = part.y; y < part.y + part.height; ++y) {
    for (int x = part.x; x < part.x + part.width; ++x, ++at) pixel(at, x, y);
  }
}

bool holds(const core::SubRectangle& r, int x, int y) {
  return x >= r.x && x < r.x + r.width && y >= r.y && y < r.y + r.height;
}

core::DrawRequest random_request(Random& random, const paging::Surface& surface, bool is_rough) {
  mars::LonLat place = mars::lon_lat(random.direction());
  if (is_rough)
    place = mars::lon_lat(random.integer(0, 1) == 0 ? test_support::kCrater : test_support::kCanyon);
  if (!is_rough && random.integer(0, 1) == 0) place = mars::lon_lat(test_support::kWavyMiddle);
  const double exaggeration = random.integer(0, 3) == 0 ? 4 : 1;
  const double ground_m = surface.at(mars::direction(place), exaggeration).height_m;
  const double height_m = random.log_uniform(50, 3e6);
  const double yaw_deg = random.uniform(0, 360);
  const double pitch_deg = random.uniform(-90, 5);
  const double roll_deg = random.integer(0, 1) == 0 ? 0 : random.uniform(-180, 180);
  const int width = random.integer(150, 420);
  const int height = random.integer(90, 160);
  core::DrawRequest request =
      request_for({place.lon_deg, place.lat_deg, ground_m + height_m, yaw_deg, pitch_deg, roll_deg},
                  surface.planet_radius_m(), width, height, random.log_uniform(5, 100));
  request.settings.ray_mode = core::RayMode::kMultires;
  request.settings.ray_cell_px = random.log_uniform(0.25, 4);
  request.settings.ray_fovea = random.uniform(0.1, 0.6);
  request.settings.exaggeration = exaggeration;
  request.settings.smooth_edges = random.integer(0, 1) == 0;
  request.settings.lod_centre_weight = random.integer(0, 3) == 0 ? 0.5 : 0;
  if (random.integer(0, 3) == 0) request.view.part = {width / 3, height / 4, width / 2, height / 2};
  return request;
}

TEST_F(Fovea, MiddleIsThatOfTheUniformImageAndTheCertificateHolds) {
  Random random(20261125);
  int thinned = 0;
  int middles = 0;
  double worst = 0;
  double worst_middle = 0;
  for (std::size_t planet = 0; planet < planets_.size(); ++planet) {
    const paging::Surface surface(planets_[planet], std::size_t{1} << 27);
    const auto draw = rays(planets_[planet]);
    for (int n = 0; n < 100; ++n) {
      SCOPED_TRACE(std::to_string(planet) + ", view " + std::to_string(n));
      const core::DrawRequest request = random_request(random, surface, planet == 1);
      const std::optional<FoveaPlan> plan = fovea_plan(request);
      const core::DrawResult uniform = draw->draw(without_fovea(request));
      const core::DrawResult result = draw->draw(request);
      const core::Certificate& c = result.certificate;
      EXPECT_EQ(uniform.certificate.thinning_px, 0);
      EXPECT_FALSE(uniform.certificate.middle_bound_px);
      if (!plan) {
        EXPECT_EQ(result.frame.colour, uniform.frame.colour);
        EXPECT_EQ(result.frame.range_m, uniform.frame.range_m);
        EXPECT_EQ(c.thinning_px, 0);
        continue;
      }
      ++thinned;
      const double x = request.settings.exaggeration;
      const core::SurfaceRadius radius = [&](std::span<const glm::dvec3> directions,
                                             std::span<double> radius_m) {
        surface.radius(directions, radius_m, x);
      };
      const std::vector<double> shift_px =
          core::forward_shift_px(request.view, result.frame.range_m, radius, {1, 1});
      int differ = 0;
      for_pixels(request.view, [&](std::size_t at, int column, int row) {
        const bool is_middle = holds(plan->middle, column, row);
        const bool is_same = result.frame.colour[at] == uniform.frame.colour[at] &&
                             (result.frame.range_m[at] == uniform.frame.range_m[at]);
        if (is_middle && !is_same) ++differ;
        if (std::isnan(shift_px[at])) return;
        worst = std::max(worst, shift_px[at] / c.shift_bound_px);
        if (!is_middle) return;
        ASSERT_TRUE(c.middle_bound_px);
        worst_middle = std::max(worst_middle, shift_px[at] / *c.middle_bound_px);
      });
      EXPECT_EQ(differ, 0);
      middles += c.middle_bound_px ? 1 : 0;
      EXPECT_GE(c.thinning_px, vpe::voxel::kThinnedColour_px);
      EXPECT_GE(c.shift_bound_px, c.thinning_px);
      if (c.middle_bound_px) {
        EXPECT_LE(*c.middle_bound_px, uniform.certificate.shift_bound_px);
      }
    }
  }
  EXPECT_GE(thinned, 150);
  EXPECT_GE(middles, 120);
  std::printf("largest shift of its bound: %.3f, in the middle %.3f\n", worst, worst_middle);
  EXPECT_LE(worst, 1);
  EXPECT_LE(worst_middle, 1);
}

// By the outer view, drawn by itself.
TEST_F(Fovea, OutsideShowsEverySecondRowAndColumn) {
  const auto draw = rays(wavy());
  core::DrawRequest request = over_waves(320, 180, 0.3);
  request.settings.smooth_edges = false;
  const std::optional<FoveaPlan> plan = fovea_plan(request);
  ASSERT_TRUE(plan);
  const core::DrawResult result = draw->draw(request);
  core::DrawRequest outer_request = without_fovea(request);
  outer_request.view = plan->outer;
  const core::Frame outer = draw->draw(outer_request).frame;
  ASSERT_EQ(outer.width, 160);
  ASSERT_EQ(outer.height, 90);
  const auto at_outer = [&](int x, int y) {
    return static_cast<std::size_t>(std::clamp(y, 0, 89) * 160 + std::clamp(x, 0, 159));
  };
  int outside = 0;
  for_pixels(request.view, [&](std::size_t at, int x, int y) {
    if (holds(plan->dense, x, y)) return;
    ++outside;
    ASSERT_EQ(result.frame.range_m[at], outer.range_m[at_outer(x / 2, y / 2)]) << x << " " << y;
    const double u = 0.5 * x - 0.25;
    const double v = 0.5 * y - 0.25;
    const int i = static_cast<int>(std::floor(u));
    const int j = static_cast<int>(std::floor(v));
    const auto red = [&](int a, int b) { return static_cast<double>(outer.colour[at_outer(i + a, j + b)].r); };
    const double s = u - i;
    const double t = v - j;
    const double mean =
        (1 - t) * ((1 - s) * red(0, 0) + s * red(1, 0)) + t * ((1 - s) * red(0, 1) + s * red(1, 1));
    ASSERT_NEAR(result.frame.colour[at].r, mean, 0.5 + 1e-9) << x << " " << y;
  });
  EXPECT_GT(outside, 320 * 180 / 2);
}

TEST_F(Fovea, MiddleFadesIntoTheRest) {
  core::DrawRequest request = over_waves(300, 200, 0.3);
  const std::optional<FoveaPlan> plan = fovea_plan(request);
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->middle, (core::SubRectangle{105, 70, 90, 60}));
  const glm::ivec2 outer_size = core::drawn_size(plan->outer);
  const std::vector<vpe::base::Rgb> outer(static_cast<std::size_t>(outer_size.x * outer_size.y), {100, 0, 255});
  const std::vector<vpe::base::Rgb> dense(static_cast<std::size_t>(plan->dense.width * plan->dense.height),
                                          {190, 255, 0});
  std::vector<vpe::base::Rgb> merged(300 * 200);
  vpe::base::ThreadPool pool(2);
  vpe::voxel::merge_colours(*plan, request.view, {outer, dense}, pool, merged);
  int most_step = 0;
  for_pixels(request.view, [&](std::size_t at, int x, int y) {
    if (holds(plan->middle, x, y)) {
      ASSERT_EQ(merged[at], dense.front());
    } else if (!holds(plan->dense, x, y)) {
      ASSERT_EQ(merged[at], outer.front());
    }
    if (x > 0) most_step = std::max(most_step, std::abs(merged[at].r - merged[at - 1].r));
    if (y > 0) most_step = std::max(most_step, std::abs(merged[at].r - merged[at - 300].r));
  });
  EXPECT_EQ(most_step, (190 - 100) / (vpe::voxel::kFade_px + 1));
}

TEST_F(Fovea, PartsHaveTheMiddleOfTheWhole) {
  core::DrawRequest request = over_waves(300, 200, 0.4);
  const std::optional<FoveaPlan> whole = fovea_plan(request);
  ASSERT_TRUE(whole);
  request.view.part = {0, 0, 120, 90};
  const std::optional<FoveaPlan> part = fovea_plan(request);
  ASSERT_TRUE(part);
  EXPECT_EQ(part->middle, whole->middle);
  request.view.part = {0, 0, 300, 40};  // above the middle
  const std::optional<FoveaPlan> above = fovea_plan(request);
  ASSERT_TRUE(above);
  EXPECT_EQ(above->dense.width, 0);
  const core::DrawResult drawn = rays(wavy())->draw(request);
  EXPECT_FALSE(drawn.certificate.middle_bound_px);
  EXPECT_GT(drawn.certificate.thinning_px, 0);
  request.view.part = {100, 70, 90, 50};  // within it
  EXPECT_FALSE(fovea_plan(request));
}

TEST_F(Fovea, SamplesAndFilmsHaveTheirMiddleToo) {
  const auto draw = rays(wavy());
  core::DrawRequest request = over_waves(260, 150, 0.3);
  const std::optional<FoveaPlan> plan = fovea_plan(request);
  ASSERT_TRUE(plan);
  const auto expect_equal_middle = [&](const core::DrawResult& a, const core::DrawResult& b) {
    for_pixels(request.view, [&](std::size_t at, int x, int y) {
      if (!holds(plan->middle, x, y)) return;
      ASSERT_EQ(a.frame.colour[at], b.frame.colour[at]) << x << " " << y;
      ASSERT_EQ(a.frame.range_m[at], b.frame.range_m[at]) << x << " " << y;
    });
  };
  const core::DrawResult alone = draw->draw(request);
  core::DrawRequest before = request;
  before.view.camera = mars::to_camera({10, 20, 40000, 0, -20, 0}, wavy()->radius_m());
  before.paging.next = std::make_shared<const core::DrawRequest>(request);
  draw->draw(before);
  const core::DrawResult after = draw->draw(request);
  EXPECT_EQ(after.frame.colour, alone.frame.colour);
  EXPECT_EQ(after.frame.range_m, alone.frame.range_m);
  request.settings.samples = 4;
  const core::DrawResult several = draw->draw(request);
  expect_equal_middle(several, draw->draw(without_fovea(request)));
  EXPECT_GT(several.certificate.thinning_px, 0);
  request.want_colour = false;
  EXPECT_EQ(draw->draw(request).frame.range_m, alone.frame.range_m);
}

TEST_F(Fovea, OtherModesAndProjectionsRefuseIt) {
  const core::DrawRequest request = over_waves(64, 48, 0.3);
  EXPECT_EQ(vpe::voxel::why_not(request), "");
  core::DrawRequest exact = request;
  exact.settings.ray_mode = core::RayMode::kExact;
  EXPECT_NE(vpe::voxel::why_not(exact).find("rays.mode=multires"), std::string::npos);
  EXPECT_THROW(rays(wavy())->draw(exact), std::runtime_error);
  core::DrawRequest round = request;
  round.view.projection = core::Projection::kCylinder;
  EXPECT_NE(vpe::voxel::why_not(round).find("perspective"), std::string::npos);
  EXPECT_THROW(rays(wavy())->draw(round), std::runtime_error);
}

}  // namespace
