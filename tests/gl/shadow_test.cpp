// Cast shadows, against geometry and against rays over the formula of the ground.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>

#include "tests/gl/lit_image.h"

namespace {

namespace core = vpe::core;
using test_support::FakeElevation;
using test_support::lit_request;
using test_support::plain_byte;
using test_support::red;

constexpr double kRadius_m = mars::kMarsRadius_m;

// Spacing of the posts around one place; heights are a formula.
constexpr double kPost_m = 200;

class Shadows : public test_support::GlTest {
 protected:
  std::shared_ptr<const paging::PlanetFile> planet(const FakeElevation::Height& height,
                                                   const glm::dvec3& middle, double reach_m) {
    return test_support::build_fake(
        dir_ / "p.vpe", FakeElevation(height, test_support::fine_around(middle, reach_m / kRadius_m, kPost_m)),
        100000);
  }
};

// Returns a request for a view straight down with pixels of `px_m` metres.
core::DrawRequest shadowed_from_above(const mars::LonLat& at, double px_m, int width, int height) {
  constexpr double kHeight_m = 300000;
  const double fov_deg = 2 * std::atan(0.5 * height * px_m / kHeight_m) / mars::kRadiansPerDegree;
  core::DrawRequest out = lit_request({at.lon_deg, at.lat_deg, kHeight_m, 0, -90, 0}, width, height, fov_deg);
  out.settings.shadows = true;
  return out;
}

// Height of a scarp along the meridian 0, where posts are: high in the west, down to the sphere within a post
// in the east.
constexpr double kScarp_m = 1500;
double scarp(const glm::dvec3& d) { return d.x > 0 && d.y <= 0 ? kScarp_m : 0; }

// Returns the length of the shadow of an edge of a height, the sun at an elevation over the edge. The ray over
// the edge reaches the sphere where cos(elevation there) R = cos(elevation) (R + height); between both places
// the vertical turns by the difference of the elevations.
double shadow_rad(double height_m, double elevation_deg) {
  const double e = elevation_deg * mars::kRadiansPerDegree;
  return e - std::acos(std::cos(e) * (kRadius_m + height_m) / kRadius_m);
}

TEST_F(Shadows, OfAScarpAreAsLongAsTheSunIsLow) {
  const auto file = planet(scarp, {1, 0, 0}, 35000);
  const auto draw = renderer(file);
  double worst_gouraud_px = 0, worst_flat_px = 0;
  for (const double elevation_deg : {10.0, 20.0, 45.0}) {
    for (const double exaggeration : {1.0, 3.0}) {
      for (const double posts_per_px : {1.0, 0.4}) {
        for (const auto shading : {core::Shading::kGouraud, core::Shading::kFlat}) {
          const double px_m = posts_per_px * kPost_m;
          const double length_rad = shadow_rad(exaggeration * kScarp_m, elevation_deg);
          const double length_m = length_rad * kRadius_m;
          // The far end is in the middle of the image.
          core::DrawRequest r = shadowed_from_above({length_rad / mars::kRadiansPerDegree, 0}, px_m, 64, 24);
          r.settings.shading = shading;
          r.settings.exaggeration = exaggeration;
          r.sun = mars::sun_direction({0, 0}, 270, elevation_deg);
          SCOPED_TRACE(testing::Message()
                       << "sun at " << elevation_deg << ", exaggeration " << exaggeration << ", " << px_m
                       << " m a pixel, shadow of " << length_m << " m, shading " << static_cast<int>(shading));
          const core::DrawResult result = draw->draw(r);
          const double dark = plain_byte(core::light(0.05, 1.235, 0));
          const double bright = plain_byte(
              core::light(0.05, 1.235, std::sin(elevation_deg * mars::kRadiansPerDegree - length_rad)));
          double least = 1e9, most = -1e9;
          for (int y = 4; y < 20; ++y) {
            EXPECT_NEAR(red(result, 27, y), dark, 2);
            EXPECT_NEAR(red(result, 37, y), bright, 2);
            int x = 32 - static_cast<int>(std::min(12.0, 0.7 * length_m / px_m));
            while (x < 44 && red(result, x + 1, y) < 0.5 * (dark + bright)) ++x;
            const double step =
                (0.5 * (dark + bright) - red(result, x, y)) / (red(result, x + 1, y) - red(result, x, y));
            const double off_px = x + 0.5 + step - 32;
            least = std::min(least, off_px);
            most = std::max(most, off_px);
          }
          double& worst_px = shading == core::Shading::kFlat ? worst_flat_px : worst_gouraud_px;
          worst_px = std::max({worst_px, most, -least});
          // Facets end in steps, which are read to half a pixel.
          const double most_px =
              std::max(1.0, 1 / posts_per_px) + (shading == core::Shading::kFlat ? 0.501 : 0.0);
          EXPECT_GE(least, -most_px);
          EXPECT_LE(most, most_px);
        }
      }
    }
  }
  std::printf("ends of shadows: Gouraud %.2f px off at most, flat %.2f px\n", worst_gouraud_px, worst_flat_px);
}

// A crater with a raised rim, away from axes and grid lines. Rays are marched over the formula itself.
struct Crater {
  static constexpr double kRim_m = 1200, kReach_m = 6000, kWidth_m = 1000, kDepth_m = 900;
  glm::dvec3 middle{1, 0, 0};

  double operator()(const glm::dvec3& d) const {
    const double r = 2 * std::asin(std::min(1.0, 0.5 * glm::length(d - middle))) * kRadius_m;
    const double inside = r < kReach_m ? 1 - r * r / (kReach_m * kReach_m) : 0;
    const double out = (r - kReach_m) / kWidth_m;
    return kRim_m * std::exp(-out * out) - kDepth_m * inside * inside;
  }
  // Returns the height of a point over the ground.
  double over(const glm::dvec3& p, double exaggeration) const {
    const double r = glm::length(p);
    return r - kRadius_m - exaggeration * (*this)(p / r);
  }
  glm::dvec3 normal(const glm::dvec3& p, double exaggeration) const {
    glm::dvec3 out(0);
    for (int k = 0; k < 3; ++k) {
      glm::dvec3 step(0);
      step[k] = 1;
      out[k] = over(p + step, exaggeration) - over(p - step, exaggeration);
    }
    return glm::normalize(out);
  }
  glm::dvec3 below(const glm::dvec3& camera, const glm::dvec3& ray, double exaggeration) const {
    double t = glm::length(camera) - kRadius_m;
    for (int n = 0; n < 40; ++n) t += 0.7 * over(camera + t * ray, exaggeration);
    return camera + t * ray;
  }
  bool sees(const glm::dvec3& p, const glm::dvec3& sun, double exaggeration) const {
    const double top_m = exaggeration * kRim_m;
    for (double t = 5; t < 200000; t += 20) {
      const glm::dvec3 at = p + t * sun;
      if (over(at, exaggeration) < 0) return false;
      if (glm::length(at) > kRadius_m + top_m) return true;
    }
    return true;
  }
};

// Draws the crater with the sun on all sides.
void expect_shadows_of(const Crater& crater, core::Renderer& draw) {
  constexpr int kSide = 96;
  const mars::LonLat at = mars::lon_lat(crater.middle);
  struct Case {
    double azimuth_deg, elevation_deg, exaggeration, px_m;
    core::Shading shading;
  };
  const auto gouraud = core::Shading::kGouraud, flat = core::Shading::kFlat;
  for (const Case& c :
       {Case{60, 10, 1, 250, gouraud}, Case{130, 20, 1, 200, gouraud}, Case{205, 45, 2, 200, gouraud},
        Case{300, 20, 3, 250, gouraud}, Case{300, 20, 1, 200, flat}, Case{80, 10, 1, 200, flat}}) {
    SCOPED_TRACE(testing::Message() << "sun at " << c.azimuth_deg << ", " << c.elevation_deg
                                    << ", exaggeration " << c.exaggeration << ", shading "
                                    << static_cast<int>(c.shading));
    core::DrawRequest r = shadowed_from_above(at, c.px_m, kSide, kSide);
    r.settings.shading = c.shading;
    r.settings.exaggeration = c.exaggeration;
    r.sun = mars::sun_direction(at, c.azimuth_deg, c.elevation_deg);
    const core::DrawResult result = draw.draw(r);
    // Values of the formula at each pixel, with a margin of two pixels.
    constexpr int kMore = 2, kWide = kSide + 2 * kMore;
    std::vector<double> wanted;
    int hidden = 0;
    for (int y = -kMore; y < kSide + kMore; ++y) {
      for (int x = -kMore; x < kSide + kMore; ++x) {
        const glm::dvec3 p =
            crater.below(r.view.camera.position_m, core::pixel_ray(r.view, x + 0.5, y + 0.5), c.exaggeration);
        const double incidence = glm::dot(crater.normal(p, c.exaggeration), r.sun);
        const bool sees = incidence > 0 && crater.sees(p, r.sun, c.exaggeration);
        hidden += incidence > 0 && !sees ? 1 : 0;
        wanted.push_back(plain_byte(core::light(0.05, 1.235, sees ? incidence : 0)));
      }
    }
    // Each pixel shows what the formula shows within a pixel of it. A facet has the light of its own normal,
    // which the formula has nowhere. For facets only the visibility of the sun is compared, within two pixels,
    // since the middle of a facet is up to 0.94 posts away.
    const int reach = c.shading == flat ? 2 : 1;
    const double ambient = plain_byte(core::light(0.05, 1.235, 0));
    const double clearly_lit = plain_byte(core::light(0.05, 1.235, 0.15));
    const auto agreeing = [&](bool mirrored) {
      int good = 0;
      for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
          double low = 1e9, high = 0;
          for (int b = kMore - reach; b <= kMore + reach; ++b) {
            for (int a = kMore - reach; a <= kMore + reach; ++a) {
              const double w = wanted[static_cast<std::size_t>((y + b) * kWide + x + a)];
              low = std::min(low, w);
              high = std::max(high, w);
            }
          }
          const int byte = red(result, mirrored ? kSide - 1 - x : x, y);
          if (c.shading == flat && high > ambient) {
            low = low > clearly_lit ? ambient + 6 : 0;
            high = 255;
          }
          good += byte >= low - 3 && byte <= high + 3 ? 1 : 0;
        }
      }
      return static_cast<double>(good) / (kSide * kSide);
    };
    std::printf(
        "sun at %.0f, %.0f, exaggeration %.0f, flat %d: %d pixels in cast shadow, %.4f agree, mirrored %.4f\n",
        c.azimuth_deg, c.elevation_deg, c.exaggeration, c.shading == flat, hidden, agreeing(false),
        agreeing(true));
    EXPECT_GE(agreeing(false), 0.999);
    EXPECT_LE(agreeing(true), 0.9);
    EXPECT_GT(hidden, 100);
  }
}

TEST_F(Shadows, OfACraterAreThoseOfRaysOverItsFormula) {
  const Crater crater{mars::direction({37, -28})};
  expect_shadows_of(crater, *renderer(planet(crater, crater.middle, 22000)));
}

// On two and three faces of the cube, where longitudes jump, and where they meet.
using LongShadows = Shadows;
TEST_F(LongShadows, AreRightWhereFacesMeetAndAtThePole) {
  for (const glm::dvec3& middle :
       {glm::dvec3(1, 1, 1), glm::dvec3(1, -1, 0.3), glm::dvec3(-1, 0, 0.4), glm::dvec3(0, 0, -1)}) {
    SCOPED_TRACE(testing::Message() << middle.x << " " << middle.y << " " << middle.z);
    const Crater crater{glm::normalize(middle)};
    std::filesystem::remove(dir_ / "p.vpe");
    expect_shadows_of(crater, *renderer(planet(crater, crater.middle, 22000)));
  }
}

TEST_F(Shadows, AHighSunCastsNoneAndALowOneLeavesAmbientOnly) {
  const Crater crater{mars::direction({37, -28})};
  const mars::LonLat at = mars::lon_lat(crater.middle);
  const auto file = planet(crater, crater.middle, 12000);
  const auto draw = renderer(file);
  for (const auto shading : {core::Shading::kGouraud, core::Shading::kFlat}) {
    core::DrawRequest r = shadowed_from_above(at, 250, 64, 64);
    r.settings.shading = shading;
    const auto drawn = [&](double elevation_deg, bool shadows) {
      r.sun = mars::sun_direction(at, 250, elevation_deg);
      r.settings.shadows = shadows;
      return draw->draw(r).frame.colour;
    };
    // No slope is as steep as this sun is high.
    const auto high = drawn(80, false);
    EXPECT_EQ(drawn(80, true), high);
    // Off, on and off again: the same.
    const auto low = drawn(15, false);
    EXPECT_NE(drawn(15, true), low);
    EXPECT_EQ(drawn(15, false), low);
    // Shadows only darken.
    const auto shaded = drawn(15, true);
    for (std::size_t n = 0; n < low.size(); ++n) ASSERT_LE(shaded[n].r, low[n].r);
    // Without shadows slopes may face a sun under the horizon; with them only ambient light is left.
    EXPECT_NE(drawn(-10, false), drawn(-60, false));
    const double ambient = core::light(0.05, 1.235, 0);
    for (const vpe::base::Rgb& c : drawn(-10, true)) {
      ASSERT_NEAR(c.r, core::kPlainGround.r * ambient, 1);
      ASSERT_NEAR(c.g, core::kPlainGround.g * ambient, 1);
      ASSERT_NEAR(c.b, core::kPlainGround.b * ambient, 1);
    }
  }
}

}  // namespace
