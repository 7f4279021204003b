// The inspector shows how an image is made and changes nothing else in it.
#include "vpe/core/appearance/inspect.h"
#include "vpe/core/appearance/shading.h"

#include <set>

#include "tests/gl/gl_fixture.h"

namespace {

namespace core = vpe::core;
using test_support::bumpy_height;
using test_support::FakeElevation;
using test_support::GlTest;
using test_support::request_for;

class Inspect : public GlTest {
 protected:
  std::shared_ptr<const paging::PlanetFile> planet() {
    const FakeElevation source(bumpy_height, test_support::fine_around({1, 0, 0}, 0.05, 5000));
    return test_support::build_fake(dir_ / "p.vpe", source, 100000);
  }
  static core::DrawRequest oblique() {
    core::DrawRequest request = request_for({0.5, 0.3, 60000, 30, -25, 0}, mars::kMarsRadius_m, 320, 240);
    request.settings.smooth_edges = false;
    return request;
  }
};

TEST_F(Inspect, BordersAreLinesOverTheImage) {
  auto gl = renderer(planet());
  core::DrawRequest request = oblique();
  const core::DrawResult plain = gl->draw(request);
  request.settings.inspect = core::Inspect::kBorders;
  const core::DrawResult lined = gl->draw(request);
  EXPECT_EQ(plain.frame.range_m, lined.frame.range_m);
  EXPECT_EQ(plain.certificate.nodata_share, lined.certificate.nodata_share);
  const vpe::base::Rgb line{26, 255, 51};
  std::size_t changed = 0;
  for (std::size_t n = 0; n < plain.frame.colour.size(); ++n) {
    if (plain.frame.colour[n] == lined.frame.colour[n]) continue;
    ++changed;
    ASSERT_EQ(lined.frame.colour[n], line);
  }
  EXPECT_GT(changed, 200u);
  EXPECT_LT(changed, plain.frame.colour.size() / 5);
  // Switched off, it leaves nothing behind.
  request.settings.inspect = core::Inspect::kNone;
  EXPECT_EQ(gl->draw(request).frame.colour, plain.frame.colour);
}

TEST_F(Inspect, LevelsHaveTheColoursOfThePalette) {
  auto gl = renderer(planet());
  core::DrawRequest request = oblique();
  request.settings.mode = core::Mode::kUnlit;
  request.settings.colour = core::Colour::kNone;
  request.settings.background = core::Background::kBlack;
  request.settings.inspect = core::Inspect::kLevels;
  const core::DrawResult result = gl->draw(request);
  std::set<int> seen;
  for (std::size_t n = 0; n < result.frame.colour.size(); ++n) {
    if (!(result.frame.range_m[n] < core::kSkyRange)) continue;
    const vpe::base::Rgb c = result.frame.colour[n];
    bool found = false;
    EXPECT_GT(result.stats.triangles_in_sight, 0);
    EXPECT_LE(result.stats.triangles_in_sight, result.stats.triangles);
    for (std::size_t level = 0; level < result.stats.tiles_by_level.size(); ++level) {
      if (result.stats.tiles_by_level[level] == 0) continue;
      const vpe::base::Rgb wanted = core::level_colour(static_cast<int>(level)).colour;
      const auto near = [](double got, double flat, double tint) {
        return std::abs(got - 0.4 * flat - 0.6 * tint) < 2.0;
      };
      if (!near(c.r, core::kPlainGround.r, wanted.r) || !near(c.g, core::kPlainGround.g, wanted.g) ||
          !near(c.b, core::kPlainGround.b, wanted.b))
        continue;
      found = true;
      seen.insert(static_cast<int>(level));
    }
    ASSERT_TRUE(found) << "pixel " << n << ": " << int{c.r} << " " << int{c.g} << " " << int{c.b};
  }
  EXPECT_GE(seen.size(), 2u);
}

TEST_F(Inspect, FrozenCullingFromItsOwnViewIsTheImage) {
  auto gl = renderer(planet());
  core::DrawRequest request = oblique();
  const core::DrawResult plain = gl->draw(request);
  request.cull_view = request.view;
  const core::DrawResult same = gl->draw(request);
  EXPECT_EQ(same.frame.colour, plain.frame.colour);
  EXPECT_EQ(same.frame.range_m, plain.frame.range_m);
}

TEST_F(Inspect, FrozenCullingShowsWhatWasCulled) {
  auto gl = renderer(planet());
  core::DrawRequest request = oblique();
  request.settings.lod_tolerance_px = 4;
  const core::DrawResult inside = gl->draw(request);
  core::DrawRequest outside = request_for({0.5, 0.3, 3000000, 0, -90, 0}, mars::kMarsRadius_m, 320, 240, 80);
  outside.settings = request.settings;
  const core::DrawResult whole = gl->draw(outside);
  outside.cull_view = request.view;
  const core::DrawResult frozen = gl->draw(outside);
  EXPECT_EQ(frozen.stats.tiles_drawn, inside.stats.tiles_drawn);
  EXPECT_EQ(frozen.stats.tiles_by_level, inside.stats.tiles_by_level);
  int ground = 0, left_out = 0;
  for (std::size_t n = 0; n < whole.frame.range_m.size(); ++n) {
    const bool was = whole.frame.range_m[n] < core::kSkyRange;
    const bool is = frozen.frame.range_m[n] < core::kSkyRange;
    ground += is ? 1 : 0;
    left_out += was && !is ? 1 : 0;
    if (was && is) {
      // Both are within their own bound of the same ground.
      const double bound = (whole.certificate.shift_bound_px + frozen.certificate.shift_bound_px) *
                           static_cast<double>(whole.frame.range_m[n]) / core::focal_px(outside.view);
      ASSERT_NEAR(whole.frame.range_m[n], frozen.frame.range_m[n], 1.5 * bound);
    }
  }
  EXPECT_GT(ground, 200);
  EXPECT_GT(left_out, 20000);
}

}  // namespace
