// Lighting: the subsolar point and the terminator, against published tables and the sphere.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>

#include "mars/geodesy/mars_time.h"
#include "tests/gl/lit_image.h"

namespace {

namespace core = vpe::core;
using test_support::FakeElevation;
using test_support::lit_request;
using test_support::plain_byte;
using test_support::red;

constexpr double kRadius_m = mars::kMarsRadius_m;

using Sun = test_support::GlTest;

// Returns the direction of the point where a ray meets the sphere; length 0 if it misses.
glm::dvec3 on_sphere(const glm::dvec3& camera, const glm::dvec3& ray) {
  const double half = -glm::dot(camera, ray);
  const double under = half * half - glm::dot(camera, camera) + kRadius_m * kRadius_m;
  if (half < 0 || under < 0) return glm::dvec3(0);
  return glm::normalize(camera + (half - std::sqrt(under)) * ray);
}

// Date of a published test case and the subsolar point in its table. The table counts longitude west. Its
// latitude is planetographic; the planetocentric one is asin(0.42565 sin Ls) = graphic - 0.25 sin Ls.
struct Published {
  const char* date;
  double solar_longitude_deg, west_deg, graphic_lat_deg;
  glm::dvec3 subsolar() const {
    const double lat = (graphic_lat_deg - 0.25 * std::sin(solar_longitude_deg * mars::kRadiansPerDegree)) *
                       mars::kRadiansPerDegree;
    const double lon = -west_deg * mars::kRadiansPerDegree;
    return {std::cos(lat) * std::cos(lon), std::cos(lat) * std::sin(lon), std::sin(lat)};
  }
};
const Published kPublished[] = {{"2000-01-06T00:00:00Z", 277.18759, 174.72600, -25.22824},
                                {"2004-01-03T13:46:31Z", 327.32416, 4.70500, -13.42040}};

TEST_F(Sun, SubsolarPointAndTerminatorAreWhereTheDatePutsThem) {
  constexpr int kSide = 260;
  const auto file =
      test_support::build_fake(dir_ / "p.vpe", FakeElevation([](const glm::dvec3&) { return 0.0; }), 50000);
  const auto draw = renderer(file);
  for (const Published& published : kPublished) {
    const glm::dvec3 subsolar = published.subsolar();
    const mars::LonLat below = mars::lon_lat(subsolar);
    for (const double bearing_deg : {80.0, 200.0}) {
      SCOPED_TRACE(std::string(published.date) + " from " + std::to_string(bearing_deg));
      const mars::LonLat at = mars::destination(below, bearing_deg, 0.9);
      core::DrawRequest r = lit_request({at.lon_deg, at.lat_deg, 10 * kRadius_m, 30, -90, 0}, kSide, kSide, 11);
      r.sun = *mars::sun_direction(*mars::parse_sun(published.date), {});
      const core::DrawResult result = draw->draw(r);
      const int ambient = static_cast<int>(std::ceil(plain_byte(core::light(0.05, 1.235, 0))));

      // Pixels of the brightest byte form a cap; its middle, by area on the ground, is the brightest place.
      int brightest = 0;
      for (const vpe::base::Rgb& c : result.frame.colour) brightest = std::max(brightest, int{c.r});
      EXPECT_NEAR(brightest, plain_byte(core::light(0.05, 1.235, 1)), 1);
      glm::dvec3 sum(0);
      int lit = 0, dark = 0, wrong = 0;
      for (int y = 0; y < kSide; ++y) {
        for (int x = 0; x < kSide; ++x) {
          const auto hit = [&](double dx, double dy) {
            return on_sphere(r.view.camera.position_m, core::pixel_ray(r.view, x + 0.5 + dx, y + 0.5 + dy));
          };
          const glm::dvec3 here = hit(0, 0);
          if (here == glm::dvec3(0)) continue;
          const int byte = red(result, x, y);
          if (byte == brightest) {
            const glm::dvec3 way = here * kRadius_m - r.view.camera.position_m;
            sum += here * (-std::pow(glm::length(way), 3) / glm::dot(way, here));
          }
          // Farther than a pixel from the great circle, and from the limb, the pixel is on one side for
          // certain.
          bool all_lit = true, all_dark = true;
          for (int k = 0; k < 16; ++k) {
            const double a = k * mars::kPi / 8;
            const glm::dvec3 near = hit(std::cos(a), std::sin(a));
            const double incidence = glm::dot(near, subsolar);
            all_lit = all_lit && near != glm::dvec3(0) && incidence > 0;
            all_dark = all_dark && near != glm::dvec3(0) && incidence < 0;
          }
          lit += all_lit ? 1 : 0;
          dark += all_dark ? 1 : 0;
          wrong += (all_lit && byte <= ambient) || (all_dark && byte > ambient) ? 1 : 0;
        }
      }
      const core::Projected got = core::project(r.view, glm::normalize(sum) * kRadius_m);
      const core::Projected wanted = core::project(r.view, subsolar * kRadius_m);
      std::printf("%s: brightest %.2f px from the subsolar point; %d lit, %d dark, %d wrong\n", published.date,
                  glm::length(got.xy - wanted.xy), lit, dark, wrong);
      EXPECT_LE(glm::length(got.xy - wanted.xy), 1.0);
      EXPECT_EQ(wrong, 0);
      EXPECT_GT(lit, 20000);
      EXPECT_GT(dark, 5000);
    }
  }
}

}  // namespace
