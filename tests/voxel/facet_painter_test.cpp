// Tests images with flat shading, and with the image at posts, against their definition, pixel by pixel.
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include "mars/geodesy/sun.h"
#include "tests/gl/appearance_fixture.h"
#include "tests/voxel/painted_by_point.h"
#include "vpe/voxel/paint/image_painter.h"

namespace {

namespace core = vpe::core;
using vpe::voxel::ImagePainter;

constexpr std::size_t kBudget = std::size_t{64} << 20;

class PaintedFacets : public ::testing::Test {
 protected:
  void SetUp() override { planet_ = test_support::wavy_planet(dir_ / "wavy.vpe"); }
  void TearDown() override { use_instructions(0); }

  // Restricts the kernel to a target; 0 selects the best one.
  static void use_instructions(std::int64_t target) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }

  static core::DrawRequest request(const paging::PlanetFile& planet, double height_m, double pitch_deg) {
    const mars::LonLat place = mars::lon_lat(test_support::kWavyMiddle);
    core::DrawRequest out;
    out.view.camera =
        mars::to_camera({place.lon_deg, place.lat_deg, height_m, 40, pitch_deg, 10}, planet.radius_m());
    out.view.width = 123;
    out.view.height = 70;
    out.sun = mars::sun_direction(place, 315, 25);
    return out;
  }

  std::vector<float> ranges(const paging::Surface& surface, const core::DrawRequest& of) {
    const auto width = static_cast<std::size_t>(of.view.width);
    std::vector<float> out(width * static_cast<std::size_t>(of.view.height));
    pool_.run(static_cast<std::size_t>(of.view.height), [&](std::size_t y) {
      for (std::size_t x = 0; x < width; ++x)
        out[y * width + x] = static_cast<float>(
            surface.cast(of.view.camera.position_m,
                         core::pixel_ray(of.view, static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5),
                         of.settings.exaggeration));
    });
    return out;
  }

  static std::vector<vpe::base::Rgb> paint(ImagePainter& painter, const core::DrawRequest& of,
                                           const std::vector<float>& range_m, vpe::base::ThreadPool& pool,
                                           std::int64_t* nodata_count = nullptr) {
    std::vector<vpe::base::Rgb> out(range_m.size());
    const std::int64_t count = painter.paint(of, range_m, out, {}, pool);
    if (nodata_count != nullptr) *nodata_count = count;
    return out;
  }

  // Returns the largest difference of any channel.
  static int apart(const std::vector<vpe::base::Rgb>& a, const std::vector<vpe::base::Rgb>& b) {
    int most = 0;
    for (std::size_t n = 0; n < a.size(); ++n)
      most = std::max({most, std::abs(a[n].r - b[n].r), std::abs(a[n].g - b[n].g), std::abs(a[n].b - b[n].b)});
    return most;
  }

  test_support::TempDir dir_;
  std::shared_ptr<const paging::PlanetFile> planet_;
  vpe::base::ThreadPool pool_{2};
};

TEST_F(PaintedFacets, AllAppearancesAsDefined) {
  const paging::Surface surface(planet_, kBudget);
  const test_support::PaintedByPoint definition(planet_, kBudget);
  ImagePainter painter(planet_, kBudget);
  for (const auto& [height_m, pitch_deg] : {std::pair(15000.0, -12.0), {300000.0, -60.0}, {9e6, -88.0}}) {
    core::DrawRequest r = request(*planet_, height_m, pitch_deg);
    for (const core::Appearance& appearance : test_support::all_appearances()) {
      if (appearance.shading != core::Shading::kFlat && appearance.colour != core::Colour::kImage) continue;
      static_cast<core::Appearance&>(r.settings) = appearance;
      r.settings.haze_visibility_m = height_m < 1e6 ? 300000 : 0;
      const auto range_m = ranges(surface, r);
      EXPECT_LE(apart(paint(painter, r, range_m, pool_), definition.paint(r, range_m, pool_)), 1)
          << test_support::name(appearance) << " from " << height_m;
    }
  }
}

TEST_F(PaintedFacets, ShadowsAndNodataAsDefined) {
  const auto with_nodata = test_support::build_fake(
      dir_ / "nodata.vpe", test_support::FakeElevation([](const glm::dvec3& d) {
        return glm::length(d - test_support::kWavyMiddle) < 0.05 ? std::nan("")
                                                                 : 3 * test_support::bumpy_height(d);
      }),
      40000);
  const paging::Surface surface(with_nodata, kBudget);
  const test_support::PaintedByPoint definition(with_nodata, kBudget);
  ImagePainter painter(with_nodata, kBudget);
  core::DrawRequest r = request(*with_nodata, 700000, -70);
  r.sun = mars::sun_direction(mars::lon_lat(test_support::kWavyMiddle), 315, 4);
  r.settings.shading = core::Shading::kFlat;
  r.settings.exaggeration = 12;
  const auto range_m = ranges(surface, r);
  std::vector<vpe::base::Rgb> without;
  for (const bool shadows : {false, true}) {
    for (const core::Colour colour : {core::Colour::kNone, core::Colour::kElevation, core::Colour::kSlope}) {
      r.settings.mode = core::Mode::kColoured;
      r.settings.colour = colour;
      r.settings.shadows = shadows;
      std::int64_t nodata_count = 0;
      const auto painted = paint(painter, r, range_m, pool_, &nodata_count);
      EXPECT_LE(apart(painted, definition.paint(r, range_m, pool_)), 1) << shadows;
      EXPECT_EQ(paint(painter, r, range_m, pool_), painted);
      EXPECT_EQ(nodata_count, std::count(painted.begin(), painted.end(), vpe::base::Rgb{105, 105, 105}));
      EXPECT_GT(nodata_count, 500);
      if (colour != core::Colour::kNone) continue;
      if (shadows) {
        EXPECT_GT(apart(painted, without), 30);
      }
      without = painted;
    }
  }
}

// The bare image in stripes, whatever colours the ground with data.
TEST_F(PaintedFacets, NodataShowsTheImageOfOtherModes) {
  const test_support::WavyImage image;
  paging::BuildOptions options;
  options.output = (dir_ / "holes.vpe").string();
  options.base_spacing_m = 40000;
  options.threads = 2;
  options.tile_k = 5;
  options.resampling_posts = 1000;
  paging::build_planet(options, test_support::FakeElevation([](const glm::dvec3& d) {
                         return glm::length(d - test_support::kWavyMiddle) < 0.05 ? std::nan("") : 0.0;
                       }),
                       &image);
  const auto planet = paging::PlanetFile::open(options.output);
  const paging::Surface surface(planet, kBudget);
  ImagePainter painter(planet, kBudget);
  core::DrawRequest r = request(*planet, 700000, -70);
  r.settings.background = core::Background::kBlack;
  const auto range_m = ranges(surface, r);
  const auto painted = [&](core::Mode mode, core::Shading shading, core::Colour colour) {
    r.settings.mode = mode;
    r.settings.shading = shading;
    r.settings.colour = colour;
    return paint(painter, r, range_m, pool_);
  };
  using core::Colour, core::Mode, core::Shading;
  const auto expected = painted(Mode::kTextured, Shading::kGouraud, Colour::kNone);
  const auto holes = painted(Mode::kUnlit, Shading::kGouraud, Colour::kNone);
  const auto holes_of_facets = painted(Mode::kUnlit, Shading::kFlat, Colour::kNone);
  const auto at_posts = painted(Mode::kColoured, Shading::kGouraud, Colour::kImage);
  const auto flat = painted(Mode::kTextured, Shading::kFlat, Colour::kNone);
  const auto flat_at_posts = painted(Mode::kColoured, Shading::kFlat, Colour::kImage);
  const vpe::base::Rgb grey{105, 105, 105};
  std::size_t nodata = 0, nodata_of_facets = 0;
  for (std::size_t n = 0; n < range_m.size(); ++n) {
    if (holes[n] != grey) continue;
    ++nodata;
    EXPECT_LE(apart({at_posts[n]}, {expected[n]}), 1);
    if (holes_of_facets[n] != grey) continue;
    ++nodata_of_facets;
    EXPECT_EQ(flat[n], expected[n]);
    EXPECT_EQ(flat_at_posts[n], expected[n]);
  }
  EXPECT_GT(nodata, 500U);
  EXPECT_GT(nodata_of_facets, 500U);
}

TEST_F(PaintedFacets, ThreadsInstructionsAndMemoryChangeNothing) {
  const paging::Surface surface(planet_, kBudget);
  ImagePainter reference(planet_, kBudget);
  // Nearly nothing can be kept.
  ImagePainter poor(planet_, std::size_t{1} << 20);
  vpe::base::ThreadPool one(1), three(3);
  core::DrawRequest r = request(*planet_, 60000, -20);
  r.settings.haze_visibility_m = 3e5;
  struct Case {
    core::Mode mode;
    core::Shading shading;
    core::Colour colour;
    bool shadows;
  };
  for (const Case& one_case :
       {Case{core::Mode::kTextured, core::Shading::kFlat, core::Colour::kSlope, false},
        Case{core::Mode::kColoured, core::Shading::kFlat, core::Colour::kAspect, false},
        Case{core::Mode::kLit, core::Shading::kFlat, core::Colour::kNone, true},
        Case{core::Mode::kColoured, core::Shading::kGouraud, core::Colour::kImage, false}}) {
    r.settings.mode = one_case.mode;
    r.settings.shading = one_case.shading;
    r.settings.colour = one_case.colour;
    r.settings.colourise = one_case.mode == core::Mode::kTextured;
    r.settings.shadows = one_case.shadows;
    const auto range_m = ranges(surface, r);
    use_instructions(0);
    const auto first = paint(reference, r, range_m, one);
    EXPECT_EQ(paint(poor, r, range_m, three), first);
    EXPECT_LE(poor.bytes_resident(), std::size_t{1} << 20);
    int sets = 0;
    for (std::int64_t left = hwy::SupportedTargets(); left != 0; left &= left - 1) {
      use_instructions(left & -left);
      EXPECT_EQ(paint(reference, r, range_m, pool_), first) << hwy::TargetName(left & -left);
      ++sets;
    }
    EXPECT_GE(sets, 2);
  }
}

}  // namespace
