// Tests rays.blend: levels of the discrete caster fade into each other.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "tests/gl/gl_fixture.h"
#include "tests/paging/planet_fixture.h"
#include "vpe/voxel/discrete_image.h"
#include "vpe/voxel/ray_renderer.h"

namespace {

namespace core = vpe::core;
using test_support::request_for;
using vpe::voxel::coarser_share;

TEST(CoarserShare, RisesFromTheBeginningOfALevelToItsEnd) {
  constexpr double kLevelRange_m = 3e6;
  EXPECT_EQ(coarser_share(3e6F, kLevelRange_m), 0);
  EXPECT_NEAR(coarser_share(4.5e6F, kLevelRange_m), 0.5, 1e-6);
  EXPECT_NEAR(coarser_share(5.99999e6F, kLevelRange_m), 1, 1e-5);
  for (int level = 0; level < 20; ++level) {
    const float begins_m = std::ldexp(3e6F, -level);
    EXPECT_EQ(coarser_share(begins_m, kLevelRange_m), 0) << level;
    EXPECT_NEAR(coarser_share(1.25F * begins_m, kLevelRange_m), 0.25, 1e-6) << level;
    // What shows all of the coarser level goes on as that level, which shows none of the next one.
    EXPECT_NEAR(coarser_share(std::nextafter(2 * begins_m, 0.0F), kLevelRange_m), 1, 1e-6) << level;
  }
  EXPECT_EQ(coarser_share(core::kSkyRange, kLevelRange_m), 0);
  EXPECT_EQ(coarser_share(0, kLevelRange_m), 0);
}

double grey(const vpe::base::Rgb& c) { return 0.299 * c.r + 0.587 * c.g + 0.114 * c.b; }

// Every level of posts differs from the next one: heights without any smoothness.
double noise(const glm::dvec3& d) {
  const double x = std::sin(d.x * 12989.8 + d.y * 78233 + d.z * 37719) * 43758.5453;
  return 1500 * (x - std::floor(x));
}

class DiscreteBlend : public testing::Test {
 protected:
  static std::shared_ptr<const paging::PlanetFile> planet() {
    static const test_support::TempDir folder;
    static const auto file =
        test_support::build_fake(folder / "noise.vpe", test_support::FakeElevation(noise), 30000);
    return file;
  }
  static core::DrawRequest request(double alt_m, bool blends) {
    core::DrawRequest out = request_for({20, 10, alt_m, 30, -85, 0}, planet()->radius_m(), 320, 240);
    out.settings.ray_mode = core::RayMode::kDiscrete;
    out.settings.ray_blend = blends;
    out.settings.smooth_edges = false;
    return out;
  }
  // Moves the camera by some ten thousandths, so that little but borders of levels changes, and returns the largest step of colour of
  // pixels that kept their voxel and changed their level.
  static double largest_step(bool blends, int& crossing) {
    const auto draw = vpe::voxel::make_ray_renderer(planet(), {std::size_t{256} << 20, 2});
    const double root = lod::nominal_side_m(0, planet()->radius_m()) / planet()->meta().tile.intervals();
    double largest = 0;
    crossing = 0;
    for (int n = 0; n < 12; ++n) {
      const double alt_m = 6e6 * std::pow(1.06, n);
      const core::DrawRequest at = request(alt_m, blends);
      const core::DrawResult before = draw->draw(at);
      const core::DrawResult now = draw->draw(request(alt_m * (1 + 4e-4), blends));
      const auto level = [&](float range_m) {
        return std::ceil(std::log2(root * core::focal_px(at.view) / static_cast<double>(range_m)));
      };
      for (std::size_t k = 0; k < now.frame.range_m.size(); ++k) {
        const float a = before.frame.range_m[k];
        const float b = now.frame.range_m[k];
        if (!std::isfinite(a) || !std::isfinite(b) || std::abs(a - b) > 1e-3F * a || level(a) == level(b))
          continue;
        ++crossing;
        largest = std::max(largest, std::abs(grey(now.frame.colour[k]) - grey(before.frame.colour[k])));
      }
    }
    return largest;
  }
};

TEST_F(DiscreteBlend, HalvesTheLargestStepOfColourAtABorder) {
  int crossing = 0;
  const double sharp = largest_step(false, crossing);
  EXPECT_GT(crossing, 60);
  const double blended = largest_step(true, crossing);
  EXPECT_GT(crossing, 60);
  std::printf("largest step of grey: %.1f, blended %.1f\n", sharp, blended);
  EXPECT_GT(sharp, 4);
  EXPECT_GE(sharp, 2 * blended);
}

// Without a coarser level in sight nothing is blended.
TEST_F(DiscreteBlend, ChangesNothingWhereTheFinestLevelIsShownWhole) {
  const auto draw = vpe::voxel::make_ray_renderer(planet(), {std::size_t{256} << 20, 2});
  core::DrawRequest sharp = request(20000, false);
  sharp.view.camera = mars::to_camera({20, 10, 20000, 30, -90, 0}, planet()->radius_m());
  core::DrawRequest blended = sharp;
  blended.settings.ray_blend = true;
  const core::DrawResult a = draw->draw(sharp);
  const core::DrawResult b = draw->draw(blended);
  EXPECT_EQ(a.frame.range_m, b.frame.range_m);
  EXPECT_EQ(a.frame.colour, b.frame.colour);
}

}  // namespace
