// Nodata ground is striped, in every mode and from every distance, and nothing else is.
#include <gtest/gtest.h>

#include "tests/gl/gl_fixture.h"

namespace {

using test_support::build_fake;
using test_support::bumpy_height;
using test_support::FakeElevation;
using vpe::core::DrawRequest;
using vpe::core::DrawResult;
using vpe::core::Mode;

// The stripes of vpe/gl/shaders/nodata_pattern.glsl.
constexpr int kBright = 150;
constexpr int kDark = 60;

bool grey(const vpe::base::Rgb& c) { return c.r == c.g && c.g == c.b && c.r >= kDark && c.r <= kBright; }

class Nodata : public test_support::GlTest {
 protected:
  static constexpr double kSpacing_m = 60000;
  const glm::dvec3 middle_ = mars::direction({10, 20});

  std::shared_ptr<const paging::PlanetFile> planet_with_nodata() {
    return build_fake(dir_ / "nodata.vpe", FakeElevation([m = middle_](const glm::dvec3& d) {
                        return glm::length(d - m) < 0.25 ? std::nan("") : bumpy_height(d);
                      }),
                      kSpacing_m);
  }

  // Returns a request for finest tiles only, so that the stripes end where query says.
  DrawRequest request(const mars::Pose& pose, double radius_m) const {
    DrawRequest out = test_support::request_for(pose, radius_m, 160, 120);
    out.settings.lod_tolerance_px = 0;
    out.settings.smooth_edges = false;
    return out;
  }
};

TEST_F(Nodata, AreStripedInEveryModeAndNothingElseIs) {
  const auto planet = planet_with_nodata();
  const paging::Surface surface(planet, std::size_t{64} << 20);
  const auto draw = renderer(planet);
  const std::vector<std::pair<const char*, mars::Pose>> poses{{"far", {10, 20, 4e6, 0, -90, 0}},
                                                              {"boundary", {10, 6, 600e3, 0, -60, 0}},
                                                              {"grazing", {10, 2, 80e3, 0, -14, 0}},
                                                              {"near", {10, 20, 30e3, 40, -30, 0}},
                                                              {"at the ground", {10, 20, 20e3, 40, -70, 10}}};
  for (const auto& [name, pose] : poses) {
    DrawRequest request = this->request(pose, planet->radius_m());
    using vpe::core::Shading;
    for (const auto& [mode, shading] :
         {std::pair(Mode::kUnlit, Shading::kGouraud), std::pair(Mode::kLit, Shading::kGouraud),
          std::pair(Mode::kColoured, Shading::kGouraud), std::pair(Mode::kTextured, Shading::kGouraud),
          std::pair(Mode::kLit, Shading::kVertex)}) {
      request.settings.mode = mode;
      request.settings.shading = shading;
      SCOPED_TRACE(std::string(name) + " " + std::to_string(static_cast<int>(mode)) + " " +
                   std::to_string(static_cast<int>(shading)));
      const DrawResult result = draw->draw(request);
      const int w = result.frame.width;
      const int h = result.frame.height;
      // By query. 1: nodata, 0: data, -1: sky.
      std::vector<int> nodata(result.frame.range_m.size(), -1);
      std::vector<bool> near_boundary(nodata.size());
      for (std::size_t n = 0; n < nodata.size(); ++n) {
        const float range = result.frame.range_m[n];
        if (!std::isfinite(range)) continue;
        const int x = static_cast<int>(n) % w;
        const int y = static_cast<int>(n) / w;
        const glm::dvec3 p =
            request.view.camera.position_m +
            double{range} * glm::normalize(vpe::core::pixel_ray(request.view, x + 0.5, y + 0.5));
        const glm::dvec3 d = glm::normalize(p);
        nodata[n] = surface.at(d).nodata ? 1 : 0;
        // Below level 5 the boundary is right to a texel, here a quarter of a post.
        const double reach = 0.25 * kSpacing_m / planet->radius_m();
        for (const glm::dvec3& aside : {glm::dvec3(1, 0, 0), {0, 1, 0}, {0, 0, 1}}) {
          for (const double to : {-reach, reach}) {
            if (surface.at(glm::normalize(d + to * aside)).nodata != (nodata[n] == 1)) near_boundary[n] = true;
          }
        }
      }
      int striped = 0;
      int bright = 0;
      int dark = 0;
      int wrong = 0;
      int all = 0;
      for (int y = 1; y + 1 < h; ++y) {
        for (int x = 1; x + 1 < w; ++x) {
          const auto at = static_cast<std::size_t>(y * w + x);
          all += nodata[at] == 1;
          bool inside = !near_boundary[at];  // and all pixels around are alike
          for (const int step : {-w - 1, -w, -w + 1, -1, 1, w - 1, w, w + 1}) {
            inside = inside && nodata[at] == nodata[static_cast<std::size_t>(static_cast<int>(at) + step)];
          }
          const vpe::base::Rgb& c = result.frame.colour[at];
          if (!inside) continue;
          if (nodata[at] != 1) {
            wrong += grey(c);
            continue;
          }
          ++striped;
          wrong += !grey(c);
          bright += c.r == kBright;
          dark += c.r == kDark;
        }
      }
      ASSERT_GT(striped, 500);
      EXPECT_EQ(wrong, 0);
      // Between the two colours are only the edges of the stripes.
      EXPECT_GT(bright, striped / 4);
      EXPECT_GT(dark, striped / 4);
      EXPECT_GT(bright + dark, striped * 2 / 3);
      ASSERT_TRUE(result.certificate.nodata_share.has_value());
      EXPECT_NEAR(*result.certificate.nodata_share, static_cast<double>(all) / (w * h), 0.04);
    }
  }
}

TEST_F(Nodata, StayOnTheGroundWhileTheCameraMoves) {
  const auto planet = planet_with_nodata();
  const auto draw = renderer(planet);
  test_support::Random random(5);
  for (const double altitude_m : {20e3, 300e3, 3e6}) {
    const double step_deg = altitude_m / 3e6;
    const DrawRequest a = request({10, 20, altitude_m, 0, -90, 0}, planet->radius_m());
    const DrawRequest b =
        request({10 + step_deg, 20 + 0.7 * step_deg, altitude_m, 30, -85, 0}, planet->radius_m());
    const DrawResult first = draw->draw(a);
    const DrawResult second = draw->draw(b);
    int same = 0;
    int other = 0;
    for (int n = 0; n < 4000; ++n) {
      const double reach = std::min(0.4 * altitude_m / planet->radius_m(), 0.2);
      const glm::dvec3 d = glm::normalize(
          middle_ + reach * glm::dvec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
      const glm::dvec3 p = d * (planet->radius_m() + planet->meta().fill_m);
      const auto colour = [&](const DrawRequest& request, const DrawResult& result) {
        const auto xy = vpe::core::project(request.view, p).xy;
        if (!(xy.x >= 0 && xy.x < 160 && xy.y >= 0 && xy.y < 120)) return 0;
        return int{
            result.frame.colour[static_cast<std::size_t>(static_cast<int>(xy.y) * 160 + static_cast<int>(xy.x))]
                .r};
      };
      const int one = colour(a, first);
      const int two = colour(b, second);
      if ((one != kBright && one != kDark) || (two != kBright && two != kDark)) continue;
      ++(one == two ? same : other);
    }
    ASSERT_GT(same + other, 500);
    EXPECT_LT(other, (same + other) / 20) << altitude_m;
  }
}

TEST_F(Nodata, CostNothingElsewhere) {
  const auto planet = planet_with_nodata();
  const auto whole = build_fake(dir_ / "whole.vpe", FakeElevation(bumpy_height), kSpacing_m);
  const auto with = renderer(planet);
  const auto without = renderer(whole);
  // A renderer that has drawn stripes before.
  with->draw(request({10, 20, 300e3, 0, -90, 0}, planet->radius_m()));
  DrawRequest request = this->request({-140, -40, 300e3, 0, -50, 0}, planet->radius_m());
  for (const Mode mode : {Mode::kWireframe, Mode::kUnlit, Mode::kLit, Mode::kColoured}) {
    request.settings.mode = mode;
    const DrawResult a = with->draw(request);
    const DrawResult b = without->draw(request);
    EXPECT_EQ(a.frame.colour, b.frame.colour);
    EXPECT_EQ(a.frame.range_m, b.frame.range_m);
    EXPECT_EQ(a.certificate.nodata_share, 0.0);
    EXPECT_EQ(b.certificate.nodata_share, 0.0);
  }
  EXPECT_FALSE(whole->has_nodata({mars::Face{}, 0, 0, 0}));
}

TEST_F(Nodata, WireframesShowNone) {
  const auto planet = planet_with_nodata();
  DrawRequest request = this->request({10, 20, 300e3, 0, -90, 0}, planet->radius_m());
  request.settings.mode = Mode::kWireframe;
  const DrawResult result = renderer(planet)->draw(request);
  EXPECT_FALSE(result.certificate.nodata_share.has_value());
  for (const vpe::base::Rgb& c : result.frame.colour) ASSERT_FALSE(grey(c));
}

// Pixels count by their share of nodata samples.
TEST_F(Nodata, ShareOfAMultisampledImage) {
  const auto planet = planet_with_nodata();
  const auto draw = renderer(planet);
  DrawRequest request = this->request({10, 6, 600e3, 0, -60, 0}, planet->radius_m());
  const double one = draw->draw(request).certificate.nodata_share.value_or(-1);
  request.settings.samples = 4;
  EXPECT_NEAR(draw->draw(request).certificate.nodata_share.value_or(-1), one, 0.01);
  EXPECT_GT(one, 0.05);
  EXPECT_LT(one, 0.95);
}

}  // namespace
