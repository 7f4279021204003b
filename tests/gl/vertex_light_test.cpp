// shading=vertex: light of the drawn triangles' vertices, against a rasteriser on the CPU.
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/gl/appearance_fixture.h"
#include "tests/gl/drawn_light.h"
#include "tests/gl/gl_fixture.h"
#include "vpe/core/appearance/shading.h"
#include "vpe/core/image_metrics.h"

namespace {

namespace core = vpe::core;
using core::Colour;
using core::Mode;
using core::Shading;

constexpr int kWidth = 96;
constexpr int kHeight = 72;

// Of the planet's gentle hills.
constexpr double kExaggeration = 15;

class VertexLight : public test_support::GlTest {
 protected:
  void SetUp() override {
    planet_ = test_support::wavy_planet(dir_ / "p.vpe");
    surface_ = std::make_unique<paging::Surface>(planet_, std::size_t{1} << 26);
  }

  // Returns a request for lit ground of one colour, `above_m` over the ground of the finest tiles.
  core::DrawRequest request(double above_m, double pitch_deg, double tolerance_px,
                            double exaggeration = kExaggeration) const {
    const mars::LonLat place = mars::lon_lat(test_support::kWavyMiddle);
    const double ground_m = exaggeration * surface_->at(test_support::kWavyMiddle).height_m;
    core::DrawRequest out =
        test_support::request_for({place.lon_deg, place.lat_deg, ground_m + above_m, 40, pitch_deg, 10},
                                  planet_->radius_m(), kWidth, kHeight, 40);
    out.settings.mode = Mode::kLit;
    out.settings.shading = Shading::kVertex;
    out.settings.background = core::Background::kBlack;
    out.settings.smooth_edges = false;
    out.settings.occlusion = core::Occlusion::kOff;
    out.settings.lod_tolerance_px = tolerance_px;
    out.settings.exaggeration = exaggeration;
    return out;
  }

  test_support::LightImage expected(const core::DrawRequest& request) const {
    return test_support::rasterise(request.view,
                                   test_support::VertexLightReference(*surface_, request).drawn());
  }

  std::shared_ptr<const paging::PlanetFile> planet_;
  std::unique_ptr<paging::Surface> surface_;
};

// Returns the largest difference of a channel from a colour in an amount of light.
double off(const vpe::base::Rgb& drawn, const glm::dvec3& colour, double light) {
  const glm::dvec3 wanted = glm::min(colour * light, 255.0);
  const glm::dvec3 difference = glm::abs(glm::dvec3(drawn.r, drawn.g, drawn.b) - wanted);
  return std::max({difference.x, difference.y, difference.z});
}

// Compares the pixels whose light is known. `colour(pixel)` is the colour without light. Pixels that show something else
// than the reference's triangles, which are skirts, are left out and must be few.
template <typename ColourAt>
void expect_light(const core::DrawResult& result, const std::vector<float>& range_m,
                  const test_support::LightImage& expected, const ColourAt& colour) {
  int known = 0, compared = 0, wrong = 0;
  double worst = 0;
  for (std::size_t at = 0; at < expected.light.size(); ++at) {
    if (std::isnan(expected.light[at])) continue;
    ++known;
    if (!(std::abs(double{range_m[at]} / expected.range_m[at] - 1) < 1e-3)) continue;
    ++compared;
    const double difference = off(result.frame.colour[at], colour(at), expected.light[at]);
    worst = std::max(worst, difference);
    wrong += difference > 2 ? 1 : 0;
  }
  std::printf("%d pixels compared, %.2f off at most\n", compared, worst);
  EXPECT_EQ(wrong, 0) << "worst " << worst;
  EXPECT_GT(known, kWidth * kHeight / 6);
  EXPECT_GT(compared, 0.98 * known);
}

TEST_F(VertexLight, IsInterpolatedOverTheDrawnTriangles) {
  const auto draw = renderer(planet_);
  struct Case {
    const char* name;
    double above_m, pitch_deg, tolerance_px, exaggeration;
    bool shadows;
    double sun_elevation_deg;
  };
  for (const Case& c : {Case{"finest, from above", 60000, -65, 0, kExaggeration, false, 40},
                        Case{"finest, not exaggerated", 60000, -65, 0, 1, false, 40},
                        Case{"coarse, from above", 150000, -70, 0.25, kExaggeration, false, 40},
                        Case{"coarser", 150000, -60, 1, kExaggeration, false, 25},
                        Case{"near, triangles behind the camera", 3000, -35, 0, kExaggeration, false, 40},
                        Case{"shadows", 60000, -65, 0, 2 * kExaggeration, true, 2}}) {
    SCOPED_TRACE(c.name);
    core::DrawRequest r = request(c.above_m, c.pitch_deg, c.tolerance_px, c.exaggeration);
    r.settings.shadows = c.shadows;
    r.sun = mars::sun_direction(mars::lon_lat(test_support::kWavyMiddle), 315, c.sun_elevation_deg);
    const test_support::LightImage light = expected(r);
    const core::DrawResult with_ranges = draw->draw(r);
    const auto plain = [](std::size_t) { return core::kPlainGround; };
    expect_light(with_ranges, with_ranges.frame.range_m, light, plain);
    // Without ranges most tiles are drawn by another program.
    r.want_range = false;
    expect_light(draw->draw(r), with_ranges.frame.range_m, light, plain);
    if (!c.shadows) continue;
    int dark = 0;
    const double ambient = core::light(r.settings.sun_ambient, r.settings.sun_diffuse, 0);
    for (const double l : light.light) dark += std::abs(l - ambient) < 1e-9 ? 1 : 0;
    EXPECT_GT(dark, 20);
    EXPECT_LT(dark, kWidth * kHeight / 2);
  }
}

TEST_F(VertexLight, DiffersFromFlatAndFromLightOfPosts) {
  const auto draw = renderer(planet_);
  core::DrawRequest r = request(150000, -70, 0.5, 2 * kExaggeration);
  r.sun = mars::sun_direction(mars::lon_lat(test_support::kWavyMiddle), 315, 15);
  const auto image = [&](Shading shading) {
    r.settings.shading = shading;
    return draw->draw(r).frame.colour;
  };
  const auto vertex = image(Shading::kVertex), flat = image(Shading::kFlat), posts = image(Shading::kGouraud);
  EXPECT_GT(core::colour_rms(vertex, flat), 1);
  EXPECT_GT(core::colour_rms(vertex, posts), 0.5);
  EXPECT_EQ(image(Shading::kVertex), vertex);
  EXPECT_EQ(image(Shading::kFlat), flat);
  EXPECT_EQ(image(Shading::kGouraud), posts);
}

// Colours are those without light: they are lit once.
TEST_F(VertexLight, MultipliesColoursOfEverySource) {
  const auto draw = renderer(planet_);
  struct Case {
    Mode mode;
    Colour colour;
    bool colourise;
    // The same colours without light.
    Mode unlit;
    Shading shading;
  };
  for (const Case& c : {Case{Mode::kTextured, Colour::kNone, false, Mode::kTextured, Shading::kGouraud},
                        Case{Mode::kTextured, Colour::kElevation, true, Mode::kTextured, Shading::kGouraud},
                        Case{Mode::kColoured, Colour::kElevation, false, Mode::kUnlit, Shading::kGouraud},
                        Case{Mode::kColoured, Colour::kImage, false, Mode::kUnlit, Shading::kGouraud},
                        Case{Mode::kColoured, Colour::kNone, false, Mode::kUnlit, Shading::kGouraud},
                        // One colour a triangle.
                        Case{Mode::kColoured, Colour::kSlope, false, Mode::kUnlit, Shading::kFlat},
                        Case{Mode::kColoured, Colour::kAspect, false, Mode::kUnlit, Shading::kFlat}}) {
    core::DrawRequest r = request(60000, -65, 0.1);
    r.settings.mode = c.mode;
    r.settings.colour = c.colour;
    r.settings.colourise = c.colourise;
    SCOPED_TRACE(test_support::name(r.settings));
    const test_support::LightImage light = expected(r);
    const core::DrawResult lit = draw->draw(r);
    core::DrawRequest without = r;
    without.settings.mode = c.unlit;
    without.settings.shading = c.shading;
    without.settings.sun_ambient = 1;  // light of 1 everywhere
    without.settings.sun_diffuse = 0;
    const core::DrawResult unlit = draw->draw(without);
    expect_light(lit, lit.frame.range_m, light, [&](std::size_t at) {
      const vpe::base::Rgb colour = unlit.frame.colour[at];
      return glm::dvec3(colour.r, colour.g, colour.b);
    });
    // Modes without light are as they are with the other shadings.
    core::DrawRequest unlit_by_vertex = without;
    unlit_by_vertex.settings.mode = Mode::kUnlit;
    const auto other = draw->draw(unlit_by_vertex).frame.colour;
    unlit_by_vertex.settings.shading = Shading::kVertex;
    EXPECT_EQ(draw->draw(unlit_by_vertex).frame.colour, other);
  }
}

// The sun is no part of meshes and textures, unless there are shadows.
TEST_F(VertexLight, FollowsTheSunWithoutLoading) {
  const auto draw = renderer(planet_);
  for (const bool shadows : {false, true}) {
    core::DrawRequest r = request(150000, -65, 0.25, 2 * kExaggeration);
    r.settings.mode = Mode::kTextured;
    r.settings.shadows = shadows;
    r.sun = mars::sun_direction(mars::lon_lat(test_support::kWavyMiddle), 315, 8);
    const core::DrawResult first = draw->draw(r);
    r.sun = mars::sun_direction(mars::lon_lat(test_support::kWavyMiddle), 120, 12);
    const core::DrawResult second = draw->draw(r);
    EXPECT_EQ(second.stats.pages_uploaded == 0, !shadows);
    EXPECT_GT(core::colour_rms(first.frame.colour, second.frame.colour), 10);
    EXPECT_EQ(second.frame.colour, renderer(planet_)->draw(r).frame.colour);
  }
}

TEST_F(VertexLight, IsUnderHazeAndNotOnLines) {
  const auto draw = renderer(planet_);
  core::DrawRequest r = request(60000, -65, 0.1, 1);  // mountains would be above the dust
  const core::DrawResult clear = draw->draw(r);
  r.settings.haze_visibility_m = 1e9;  // next to nothing
  EXPECT_LT(core::colour_rms(draw->draw(r).frame.colour, clear.frame.colour), 1);
  r.settings.haze_visibility_m = 20000;
  EXPECT_GT(core::colour_rms(draw->draw(r).frame.colour, clear.frame.colour), 10);
  r.settings.haze_visibility_m = 0;
  for (const Mode mode : {Mode::kWireframe, Mode::kMarkers}) {
    r.settings.mode = mode;
    r.settings.shading = Shading::kVertex;
    const auto lines = draw->draw(r).frame.colour;
    r.settings.shading = Shading::kGouraud;
    EXPECT_EQ(draw->draw(r).frame.colour, lines);
  }
}

// Stripes over imagery have no light, as with the other shadings.
TEST_F(VertexLight, LeavesNodataAsItIs) {
  const auto path = dir_ / "nodata.vpe";
  paging::BuildOptions options;
  options.output = path.string();
  options.base_spacing_m = 60000;
  options.threads = 2;
  options.tile_k = 5;
  options.resampling_posts = 1000;
  const test_support::WavyImage image;
  const glm::dvec3 hole = mars::direction({10, 20});
  paging::build_planet(options, test_support::FakeElevation([&](const glm::dvec3& d) {
                         return glm::length(d - hole) < 0.25 ? std::nan("") : test_support::bumpy_height(d);
                       }),
                       &image);
  const auto planet = paging::PlanetFile::open(options.output);
  const paging::Surface surface(planet, std::size_t{1} << 26);
  const auto draw = renderer(planet);
  core::DrawRequest r =
      test_support::request_for({10, 6, 600e3, 0, -60, 0}, planet->radius_m(), kWidth, kHeight);
  r.settings.mode = Mode::kTextured;
  r.settings.background = core::Background::kBlack;
  r.settings.smooth_edges = false;
  r.settings.lod_tolerance_px = 0;
  r.settings.exaggeration = kExaggeration;
  const auto drawn = [&](Shading shading, double azimuth_deg) {
    r.settings.shading = shading;
    r.sun = mars::sun_direction({10, 6}, azimuth_deg, 20);
    return draw->draw(r);
  };
  const core::DrawResult posts = drawn(Shading::kGouraud, 0);
  const core::DrawResult here = drawn(Shading::kVertex, 0), there = drawn(Shading::kVertex, 180);
  int striped = 0, lit = 0, moved = 0;
  for (std::size_t at = 0; at < here.frame.colour.size(); ++at) {
    if (!std::isfinite(here.frame.range_m[at])) continue;
    const int x = static_cast<int>(at) % kWidth, y = static_cast<int>(at) / kWidth;
    const auto is_nodata = [&](double dx, double dy) {
      return surface
          .at(r.view.camera.position_m +
              double{here.frame.range_m[at]} * core::pixel_ray(r.view, x + 0.5 + dx, y + 0.5 + dy))
          .nodata;
    };
    int missing = 0;
    for (const double dx : {-3.0, 0.0, 3.0})
      for (const double dy : {-3.0, 0.0, 3.0}) missing += is_nodata(dx, dy) ? 1 : 0;
    const vpe::base::Rgb a = here.frame.colour[at], b = there.frame.colour[at], c = posts.frame.colour[at];
    if (missing == 9) {
      ++striped;
      EXPECT_EQ(a, b) << x << " " << y;
      EXPECT_LE(off(a, {c.r, c.g, c.b}, 1), 2) << x << " " << y;
    }
    if (missing == 0) {
      ++lit;
      moved += a == b ? 0 : 1;
    }
  }
  EXPECT_GT(striped, 500);
  EXPECT_GT(lit, 100);
  EXPECT_GT(moved, lit / 2);
}

}  // namespace
