// Tests images painted in blocks against their definition, pixel by pixel.
#include "vpe/voxel/paint/image_painter.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include "mars/geodesy/sun.h"
#include "tests/gl/appearance_fixture.h"
#include "tests/voxel/painted_by_point.h"
#include "vpe/voxel/paint/ray_rows.h"

namespace {

namespace core = vpe::core;
using test_support::Random;
using vpe::voxel::ImagePainter;

constexpr std::size_t kMemory = std::size_t{64} << 20;
const mars::LonLat kPlace = mars::lon_lat(test_support::kWavyMiddle);

struct Painted {
  std::vector<vpe::base::Rgb> colour;
  std::int64_t nodata_count = 0;
};

// Returns the number of pixels that differ by more than `by` of 255 in some channel.
std::size_t apart(const std::vector<vpe::base::Rgb>& a, const std::vector<vpe::base::Rgb>& b, int by) {
  std::size_t count = 0;
  for (std::size_t n = 0; n < a.size(); ++n) {
    const int off = std::max({std::abs(a[n].r - b[n].r), std::abs(a[n].g - b[n].g), std::abs(a[n].b - b[n].b)});
    count += off > by ? 1 : 0;
  }
  return count;
}

class PaintedImage : public ::testing::Test {
 protected:
  void SetUp() override { planet_ = test_support::wavy_planet(dir_ / "wavy.vpe"); }
  void TearDown() override { use_instructions(0); }

  // Restricts the kernel to a target; 0 selects the best one.
  static void use_instructions(std::int64_t target) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }

  core::DrawRequest request(const mars::Pose& pose, int width, int height, double fov_deg = 60) const {
    core::DrawRequest out;
    out.view.camera = mars::to_camera(pose, planet_->radius_m());
    out.view.width = width;
    out.view.height = height;
    out.view.fov_deg = fov_deg;
    out.sun = mars::sun_direction({pose.lon_deg, pose.lat_deg}, 315, 40);
    return out;
  }

  std::vector<float> ranges(const paging::Surface& surface, const core::DrawRequest& of) {
    const core::SubRectangle part = core::drawn_part(of.view);
    std::vector<float> out(static_cast<std::size_t>(part.width) * static_cast<std::size_t>(part.height));
    pool_.run(static_cast<std::size_t>(part.height), [&](std::size_t y) {
      for (int x = 0; x < part.width; ++x)
        out[y * static_cast<std::size_t>(part.width) + static_cast<std::size_t>(x)] = static_cast<float>(
            surface.cast(of.view.camera.position_m,
                         core::pixel_ray(of.view, part.x + x + 0.5, part.y + static_cast<double>(y) + 0.5),
                         of.settings.exaggeration));
    });
    return out;
  }

  static Painted paint(ImagePainter& painter, const core::DrawRequest& of, const std::vector<float>& range_m,
                       vpe::base::ThreadPool& pool) {
    Painted out;
    out.colour.resize(range_m.size());
    out.nodata_count = painter.paint(of, range_m, out.colour, {}, pool);
    return out;
  }

  test_support::TempDir dir_;
  std::shared_ptr<const paging::PlanetFile> planet_;
  vpe::base::ThreadPool pool_{2};
};

TEST_F(PaintedImage, AllAppearancesAsDefined) {
  const paging::Surface surface(planet_, kMemory);
  const test_support::PaintedByPoint definition(planet_, kMemory);
  ImagePainter painter(planet_, kMemory);
  // Low over fine posts, tiles of many levels to the horizon, and the whole planet, where tiles span several
  // knots.
  for (const mars::Pose& pose : {mars::Pose{kPlace.lon_deg, kPlace.lat_deg, 15000, 40, -12, 10},
                                 {kPlace.lon_deg, kPlace.lat_deg, 9e6, 40, -88, 200}}) {
    core::DrawRequest r = request(pose, 77, 52, 45);
    for (const core::Appearance& appearance : test_support::all_appearances()) {
      if (appearance.shading == core::Shading::kFlat) continue;
      static_cast<core::Appearance&>(r.settings) = appearance;
      const auto range_m = ranges(surface, r);
      const auto expected = definition.paint(r, range_m, pool_);
      EXPECT_EQ(apart(paint(painter, r, range_m, pool_).colour, expected, 1), 0U)
          << test_support::name(appearance);
    }
  }
}

TEST_F(PaintedImage, AllProjectionsPartsAndSkiesAsDefined) {
  const paging::Surface surface(planet_, kMemory);
  const test_support::PaintedByPoint definition(planet_, kMemory);
  ImagePainter painter(planet_, kMemory);
  Random random(17);
  std::size_t pixels = 0, off = 0;
  for (int n = 0; n < 60; ++n) {
    const mars::LonLat place = mars::lon_lat(random.direction());
    const double ground = surface.at(mars::direction(place)).height_m;
    const mars::Pose pose{place.lon_deg,          place.lat_deg,           ground + random.log_uniform(2, 1e8),
                          random.uniform(0, 360), random.uniform(-90, 30), random.uniform(-180, 180)};
    core::DrawRequest r = request(pose, 90, 60, random.log_uniform(5, 120));
    r.sun = random.direction();
    r.view.projection = static_cast<core::Projection>(n % 3);
    if (n % 2 == 0) r.view.part = {13, 7, 61, 40};
    if (r.view.projection == core::Projection::kPerspective) r.view.principal_offset_px = {20, -11};
    r.settings.mode = core::Mode::kTextured;
    r.settings.exaggeration = n % 4 == 0 ? 3 : 1;
    r.settings.haze_visibility_m = n % 5 == 0 ? 0 : random.log_uniform(2e4, 1e6);
    r.settings.background = static_cast<core::Background>(n % 7 < 5 ? 2 : n % 7 - 5);
    const auto range_m = ranges(surface, r);
    const auto expected = definition.paint(r, range_m, pool_);
    off += apart(paint(painter, r, range_m, pool_).colour, expected, 1);
    pixels += range_m.size();
  }
  EXPECT_EQ(off, 0U) << "of " << pixels;
}

// Paints sky alone, also from very far away and about the sun's disc.
TEST_F(PaintedImage, SkyAndSunFromEverywhere) {
  ImagePainter painter(planet_, kMemory);
  const test_support::PaintedByPoint definition(planet_, kMemory);
  for (const double height_m : {0.0, 5e4, 1e7, 1e9, 1e12}) {
    for (const double fov_deg : {1.5, 90.0}) {
      core::DrawRequest r = request({10, 20, height_m, 30, height_m < 1e6 ? 5.0 : -80.0, 0}, 200, 150, fov_deg);
      r.sun = core::pixel_ray(r.view, 93.3, 71.2);
      const std::vector<float> range_m(30000, core::kSkyRange);
      const auto expected = definition.paint(r, range_m, pool_);
      EXPECT_EQ(apart(paint(painter, r, range_m, pool_).colour, expected, 1), 0U) << height_m << " " << fov_deg;
    }
  }
}

// Paints ground that needs no lookup.
TEST_F(PaintedImage, OneColourBehindAnyAirAsDefined) {
  const paging::Surface surface(planet_, kMemory);
  const test_support::PaintedByPoint definition(planet_, kMemory);
  ImagePainter painter(planet_, kMemory);
  core::DrawRequest r = request({kPlace.lon_deg, kPlace.lat_deg, 15000, 40, -5, 10}, 77, 52, 60);
  r.settings.mode = core::Mode::kUnlit;
  r.settings.colour = core::Colour::kNone;
  const auto range_m = ranges(surface, r);
  for (const core::Background sky :
       {core::Background::kBlack, core::Background::kWhite, core::Background::kSky}) {
    for (const double visibility_m : {0.0, 30000.0}) {
      r.settings.background = sky;
      r.settings.haze_visibility_m = visibility_m;
      const auto expected = definition.paint(r, range_m, pool_);
      const Painted painted = paint(painter, r, range_m, pool_);
      EXPECT_EQ(apart(painted.colour, expected, 1), 0U) << visibility_m;
      EXPECT_EQ(paint(painter, r, range_m, pool_).colour, painted.colour) << visibility_m;
      EXPECT_EQ(painted.nodata_count, 0);
    }
  }
}

TEST_F(PaintedImage, ShadowsAndNodataAsDefined) {
  const auto with_nodata = test_support::build_fake(
      dir_ / "nodata.vpe", test_support::FakeElevation([](const glm::dvec3& d) {
        return glm::length(d - test_support::kWavyMiddle) < 0.05 ? std::nan("")
                                                                 : 3 * test_support::bumpy_height(d);
      }),
      40000);
  const paging::Surface surface(with_nodata, kMemory);
  const test_support::PaintedByPoint definition(with_nodata, kMemory);
  ImagePainter painter(with_nodata, kMemory);
  core::DrawRequest r = request({kPlace.lon_deg, kPlace.lat_deg, 700000, 40, -70, 0}, 100, 70);
  r.sun = mars::sun_direction(kPlace, 315, 4);
  struct ModeAndColour {
    core::Mode mode;
    core::Colour colour;
  };
  for (const bool shadows : {false, true}) {
    for (const ModeAndColour appearance : {ModeAndColour{core::Mode::kUnlit, core::Colour::kElevation},
                                           ModeAndColour{core::Mode::kUnlit, core::Colour::kNone},
                                           ModeAndColour{core::Mode::kLit, core::Colour::kElevation},
                                           ModeAndColour{core::Mode::kColoured, core::Colour::kElevation}}) {
      r.settings.mode = appearance.mode;
      r.settings.colour = appearance.colour;
      r.settings.shadows = shadows;
      const auto range_m = ranges(surface, r);
      const auto expected = definition.paint(r, range_m, pool_);
      const Painted painted = paint(painter, r, range_m, pool_);
      EXPECT_EQ(apart(painted.colour, expected, 1), 0U);
      const auto grey = std::count(painted.colour.begin(), painted.colour.end(), vpe::base::Rgb{105, 105, 105});
      EXPECT_EQ(painted.nodata_count, grey);
      EXPECT_GT(painted.nodata_count, 500);
    }
  }
}

TEST_F(PaintedImage, ThreadsInstructionsMemoryAndHistoryChangeNothing) {
  const paging::Surface surface(planet_, kMemory);
  ImagePainter reference(planet_, kMemory);
  // Nearly nothing can be kept.
  ImagePainter poor(planet_, std::size_t{1} << 20);
  vpe::base::ThreadPool one(1), three(3);
  core::DrawRequest r = request({kPlace.lon_deg, kPlace.lat_deg, 60000, 40, -20, 10}, 131, 90);
  r.settings.haze_visibility_m = 3e5;
  for (const auto colour : {core::Colour::kElevation, core::Colour::kSlope, core::Colour::kAspect}) {
    r.settings.mode = core::Mode::kTextured;
    r.settings.colour = colour;
    r.settings.colourise = true;
    const auto range_m = ranges(surface, r);
    use_instructions(0);
    const Painted first = paint(reference, r, range_m, one);
    EXPECT_EQ(paint(poor, r, range_m, three).colour, first.colour);
    EXPECT_LE(poor.bytes_resident(), std::size_t{1} << 20);
    int sets = 0;
    const std::int64_t all = hwy::SupportedTargets();
    for (std::int64_t left = all; left != 0; left &= left - 1) {
      use_instructions(left & -left);
      const Painted again = paint(reference, r, range_m, pool_);
      EXPECT_EQ(again.colour, first.colour) << hwy::TargetName(left & -left);
      ++sets;
    }
    EXPECT_GE(sets, 2);
  }
}

TEST_F(PaintedImage, OnlyWantedPixelsArePainted) {
  const paging::Surface surface(planet_, kMemory);
  ImagePainter painter(planet_, kMemory);
  Random random(23);
  for (const core::Mode mode : {core::Mode::kTextured, core::Mode::kLit}) {
    core::DrawRequest r = request({kPlace.lon_deg, kPlace.lat_deg, 30000, 40, -10, 30}, 101, 50);
    r.settings.mode = mode;
    r.settings.haze_visibility_m = 3e5;
    const auto range_m = ranges(surface, r);
    const Painted all = paint(painter, r, range_m, pool_);
    for (const double share : {0.0, 0.01, 0.3, 1.0}) {
      std::vector<std::uint8_t> wanted(range_m.size());
      for (std::uint8_t& w : wanted) w = random.uniform(0, 1) < share ? 1 : 0;
      const vpe::base::Rgb before{1, 2, 3};
      std::vector<vpe::base::Rgb> colour(range_m.size(), before);
      painter.paint(r, range_m, colour, wanted, pool_);
      for (std::size_t n = 0; n < colour.size(); ++n)
        ASSERT_EQ(colour[n], wanted[n] != 0 ? all.colour[n] : before) << n << " of " << share;
    }
  }
}

TEST_F(PaintedImage, UnreadablePalettesAreErrors) {
  ImagePainter painter(planet_, kMemory);
  core::DrawRequest r = request({kPlace.lon_deg, kPlace.lat_deg, 60000, 40, -20, 10}, 40, 30);
  r.settings.mode = core::Mode::kColoured;
  r.settings.palette = (dir_ / "none.txt").string();
  const std::vector<float> range_m(1200, 1e5F);
  std::vector<vpe::base::Rgb> colour(1200);
  EXPECT_THROW(painter.paint(r, range_m, colour, {}, pool_), std::runtime_error);
}

TEST(RayRows, AreThePixelsRays) {
  Random random(3);
  for (int n = 0; n < 60; ++n) {
    core::View view;
    view.camera = mars::to_camera(
        {10, 20, 1000, random.uniform(0, 360), random.uniform(-90, 90), random.uniform(-180, 180)},
        mars::kMarsRadius_m);
    view.projection = static_cast<core::Projection>(n % 3);
    view.width = 201;
    view.height = 99;
    view.fov_deg = random.log_uniform(0.01, 170);
    if (n % 3 != 2) view.principal_offset_px = {random.uniform(-300, 300), random.uniform(-300, 300)};
    if (n % 2 == 0) view.part = {11, 5, 120, 70};
    const core::SubRectangle part = core::drawn_part(view);
    const vpe::voxel::RayRows rows = vpe::voxel::ray_rows(view);
    ASSERT_EQ(rows.rows.size(), static_cast<std::size_t>(part.height));
    ASSERT_EQ(rows.c0.size() % vpe::voxel::kBlock, 0U);
    for (int y = 0; y < part.height; y += 7) {
      for (int x = 0; x < part.width; x += 5) {
        const vpe::voxel::RowRays& row = rows.rows[static_cast<std::size_t>(y)];
        const double c0 = rows.c0[static_cast<std::size_t>(x)], c1 = rows.c1[static_cast<std::size_t>(x)];
        const glm::dvec3 ray = row.a * c0 + row.b * c1 + row.c;
        const double length2 = row.m0 + c0 * (row.m1 + c0 * row.m2);
        EXPECT_NEAR(length2 / glm::dot(ray, ray), 1, 1e-13);
        EXPECT_LT(glm::length(glm::normalize(ray) - core::pixel_ray(view, part.x + x + 0.5, part.y + y + 0.5)),
                  1e-14);
      }
    }
  }
}

}  // namespace
