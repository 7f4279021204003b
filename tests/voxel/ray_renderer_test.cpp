// Tests the ray backend against exact casts, the definition of appearances, and the polygon backend.
#include "vpe/voxel/ray_renderer.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <functional>

#include "mars/embedded/embedded.h"
#include "tests/gl/appearance_fixture.h"
#include "tests/gl/gl_fixture.h"
#include "tests/paging/rough_planet.h"
#include "tests/voxel/stated_range.h"
#include "vpe/core/image/image.h"
#include "vpe/voxel/cast/range_caster.h"

namespace {

namespace core = vpe::core;
using test_support::is_tie;
using test_support::Random;
using test_support::request_for;
using vpe::voxel::RangeCaster;

class Rays : public test_support::GlTest {
 protected:
  std::shared_ptr<const paging::PlanetFile> bumpy() {
    return test_support::build_fake(dir_ / "bumpy.vpe", test_support::FakeElevation(test_support::bumpy_height),
                                    50000);
  }
  static std::unique_ptr<core::Renderer> rays(std::shared_ptr<const paging::PlanetFile> planet,
                                              int threads = 2) {
    return vpe::voxel::make_ray_renderer(std::move(planet), {std::size_t{256} << 20, threads});
  }
  static core::DrawRequest random_request(Random& random, const paging::Surface& surface, int width,
                                          int height) {
    const mars::LonLat place = mars::lon_lat(random.direction());
    const double ground = surface.at(mars::direction(place)).height_m;
    const mars::Pose pose{
        place.lon_deg,          place.lat_deg,           ground + random.log_uniform(1.5, 3e7),
        random.uniform(0, 360), random.uniform(-90, 10), random.uniform(-180, 180)};
    return request_for(pose, surface.planet_radius_m(), width, height, random.log_uniform(5, 100));
  }
};

TEST_F(Rays, RangesAreThoseOfTheReferenceSurfaceInEveryProjection) {
  const auto planet = bumpy();
  const paging::Surface surface(planet, std::size_t{1} << 27);
  const auto draw = rays(planet);
  Random random(91);
  int ties = 0;
  for (const auto projection :
       {core::Projection::kPerspective, core::Projection::kCylinder, core::Projection::kEquirectangular}) {
    for (int n = 0; n < 4; ++n) {
      core::DrawRequest request = random_request(random, surface, 64, 40);
      request.view.projection = projection;
      request.view.part = {8, 6, 40, 30};
      const core::DrawResult result = draw->draw(request);
      ASSERT_EQ(result.frame.range_m.size(), 1200U);
      for (int k = 0; k < 1200; ++k) {
        const glm::dvec3 ray = core::pixel_ray(request.view, 8.5 + k % 40, 6.5 + k / 40);
        const test_support::CastRay cast{request.view.camera.position_m, ray};
        const double exact = surface.cast(cast.camera_m, cast.direction);
        const auto seen = static_cast<double>(result.frame.range_m[static_cast<std::size_t>(k)]);
        if (seen == exact) continue;
        // Equal but for rounding (voxel/range_caster_test), or beside a ridge that lies between two columns.
        if (std::isfinite(seen) && std::isfinite(exact) &&
            test_support::stated_range_error(surface, cast, seen, exact) <= RangeCaster::kRangeError)
          continue;
        EXPECT_EQ(projection, core::Projection::kPerspective) << k << ": " << seen << " for " << exact;
        EXPECT_TRUE(is_tie(surface, cast, seen, 0.7 / core::focal_px(request.view)))
            << k << ": " << seen << " for " << exact;
        ++ties;
      }
      EXPECT_EQ(result.frame.width, 40);
      EXPECT_TRUE(result.settled);
      const auto errors = core::compare_to_reference(request.view, result.frame.range_m,
                                                     test_support::reference_ranges(surface, request.view),
                                                     test_support::radius_of(surface), {1, 1});
      EXPECT_LE(errors.forward.max_px, result.certificate.shift_bound_px);
      EXPECT_LT(result.certificate.shift_bound_px, 1e-3);
    }
  }
  // Of pixels a tenth of a radian wide (PerspectiveImagesAreExactButForWhatIsNarrowerThanAPixel).
  EXPECT_LE(ties, 4 * 1200 / 100);
}

TEST_F(Rays, FlatPlanetIsTheSphere) {
  const auto planet = test_support::build_fake(
      dir_ / "flat.vpe", test_support::FakeElevation([](const glm::dvec3&) { return 0.0; }), 3000000);
  const auto draw = rays(planet);
  const double radius = planet->radius_m();
  // Facets lie below the sphere by their sagitta at most.
  const double spacing_m =
      lod::post_spacing_m(planet->meta().finest_level, planet->meta().tile.intervals(), radius);
  const double sagitta_m = spacing_m * spacing_m / (4 * radius);
  for (const double height : {1e6, 3e7}) {
    core::DrawRequest request = request_for({20, 30, height, 0, -90, 0}, radius, 80, 60, 40);
    const core::DrawResult result = draw->draw(request);
    for (int y = 0; y < 60; ++y) {
      for (int x = 0; x < 80; ++x) {
        const glm::dvec3 ray = core::pixel_ray(request.view, x + 0.5, y + 0.5);
        const double half = glm::dot(ray, request.view.camera.position_m);
        const double under = half * half -
                             glm::dot(request.view.camera.position_m, request.view.camera.position_m) +
                             radius * radius;
        const float drawn = result.frame.range_m[static_cast<std::size_t>(y * 80 + x)];
        const double closest = std::sqrt(std::max(0.0, radius * radius - under));
        if (std::abs(closest - radius) < 2 * sagitta_m) continue;  // the limb
        ASSERT_EQ(std::isfinite(drawn), under > 0) << x << " " << y;
        if (!(under > 0)) continue;
        const double exact = -half - std::sqrt(under);
        const double sine = std::sqrt(under) / radius;
        ASSERT_NEAR(static_cast<double>(drawn), exact, 2e-7 * exact / sine + sagitta_m / sine * 1.1);
      }
    }
  }
}

TEST_F(Rays, ThreadsChangeNothing) {
  const auto planet = bumpy();
  const paging::Surface surface(planet, std::size_t{1} << 27);
  Random random(92);
  const auto one = rays(planet, 1);
  const auto three = rays(planet, 3);
  for (int n = 0; n < 4; ++n) {
    const core::DrawRequest request = random_request(random, surface, 80, 60);
    const core::DrawResult a = one->draw(request);
    const core::DrawResult b = three->draw(request);
    EXPECT_EQ(a.frame.colour, b.frame.colour);
    EXPECT_EQ(a.frame.range_m, b.frame.range_m);
  }
}

TEST_F(Rays, EveryModeShadingAndColourAsDefined) {
  const auto planet = test_support::wavy_planet(dir_ / "wavy.vpe");
  const paging::Surface surface(planet, std::size_t{1} << 26);
  const auto draw = rays(planet);
  const mars::LonLat place = mars::lon_lat(test_support::kWavyMiddle);
  for (const core::Appearance& appearance : test_support::all_appearances()) {
    core::DrawRequest request =
        request_for({place.lon_deg, place.lat_deg, 60000, 40, -65, 10}, planet->radius_m(), 64, 48, 40);
    request.settings.smooth_edges = false;
    static_cast<core::Appearance&>(request.settings) = appearance;
    EXPECT_GE(test_support::agreement(*draw, surface, request), 0.999) << test_support::name(appearance);
  }
}

// The error that multires states is true and no larger than requested, and it draws fewer and coarser tiles in
// total. (In a single view the ground behind a crest that sinks may take some more.)
TEST_F(Rays, MultiresKeepsItsCertificate) {
  const auto planet = test_support::build_fake(dir_ / "finer.vpe",
                                               test_support::FakeElevation(test_support::bumpy_height), 20000);
  const paging::Surface surface(planet, std::size_t{1} << 27);
  const auto draw = rays(planet);
  Random random(93);
  int views_of_many_tiles = 0;  // the others cannot have fewer
  int coarser = 0;
  std::int64_t tiles = 0;
  std::int64_t exact_tiles = 0;
  for (int n = 0; n < 12 || (views_of_many_tiles < 8 && n < 100); ++n) {
    core::DrawRequest request = random_request(random, surface, 96, 64);
    request.settings.smooth_edges = false;
    const core::DrawResult exact = draw->draw(request);
    request.settings.ray_mode = core::RayMode::kMultires;
    request.settings.ray_cell_px = 2;
    const core::DrawResult drawn = draw->draw(request);
    const auto errors = core::compare_to_reference(request.view, drawn.frame.range_m, exact.frame.range_m,
                                                   test_support::radius_of(surface), {1, 1});
    EXPECT_LE(errors.forward.max_px, drawn.certificate.shift_bound_px) << n;
    EXPECT_LE(drawn.certificate.shift_bound_px, 2 + 0.01) << n;
    EXPECT_LE(drawn.stats.tiles_by_level.size(), exact.stats.tiles_by_level.size());
    tiles += drawn.stats.tiles_drawn;
    exact_tiles += exact.stats.tiles_drawn;
    views_of_many_tiles += exact.stats.tiles_drawn >= 8 ? 1 : 0;
    coarser += drawn.stats.tiles_drawn < exact.stats.tiles_drawn ? 1 : 0;
    // Frames that must be quick are coarser still.
    request.coarsening = 4;
    EXPECT_LE(draw->draw(request).stats.tiles_by_level.size(), drawn.stats.tiles_by_level.size());
  }
  EXPECT_GE(coarser, 8);
  EXPECT_LT(tiles, exact_tiles / 2);
}

// Tests steep ground and exaggeration, where cells a pixel wide would be off by more than a pixel.
TEST_F(Rays, MultiresStatesNoMoreThanTheCell) {
  test_support::build_rough(dir_ / "rough.vpe");
  const auto planet = paging::PlanetFile::open(dir_ / "rough.vpe");
  const paging::Surface surface(planet, std::size_t{1} << 27);
  const auto draw = rays(planet);
  Random random(95);
  int coarser = 0;
  for (int n = 0; n < 40; ++n) {
    const mars::LonLat place = mars::lon_lat(n % 3 == 0 ? test_support::kCrater : test_support::kCanyon);
    const double exaggeration = n % 2 == 0 ? 1 : 6;
    const mars::Pose pose{
        place.lon_deg,          place.lat_deg,          exaggeration * 9000 + random.log_uniform(1000, 3e6),
        random.uniform(0, 360), random.uniform(-90, 0), random.uniform(-180, 180)};
    core::DrawRequest request =
        request_for(pose, surface.planet_radius_m(), 64, 48, random.log_uniform(5, 100));
    request.want_range = false;
    request.settings.ray_mode = core::RayMode::kMultires;
    request.settings.ray_cell_px = random.log_uniform(0.1, 8);
    request.settings.exaggeration = exaggeration;
    const core::DrawResult drawn = draw->draw(request);
    EXPECT_LE(drawn.certificate.shift_bound_px, request.settings.ray_cell_px + 0.01) << n;
    coarser += drawn.certificate.screen_space_error_px > 0.5 * request.settings.ray_cell_px ? 1 : 0;
  }
  EXPECT_GE(coarser, 10);
}

TEST_F(Rays, ReferenceStepsEndOnTheSurface) {
  const auto planet = bumpy();
  const paging::Surface surface(planet, std::size_t{1} << 27);
  const auto draw = rays(planet);
  Random random(94);
  std::int64_t hits = 0, same = 0;
  for (int n = 0; n < 6; ++n) {
    core::DrawRequest request = random_request(random, surface, 40, 30);
    const core::DrawResult exact = draw->draw(request);
    request.settings.ray_mode = core::RayMode::kReference;
    const core::DrawResult stepped = draw->draw(request);
    for (std::size_t k = 0; k < stepped.frame.range_m.size(); ++k) {
      const auto range = static_cast<double>(stepped.frame.range_m[k]);
      if (std::isinf(range)) continue;
      ++hits;
      const glm::dvec3 ray =
          core::pixel_ray(request.view, static_cast<double>(k % 40) + 0.5, static_cast<double>(k / 40) + 0.5);
      const glm::dvec3 place = request.view.camera.position_m + range * ray;
      ASSERT_NEAR(glm::length(place), surface.at(place).radius_m, 1e-6 * range + 0.01) << n << " " << k;
      same += std::abs(range - static_cast<double>(exact.frame.range_m[k])) <= 1e-5 * range ? 1 : 0;
    }
  }
  EXPECT_GT(hits, 1000);
  EXPECT_GE(same, hits * 95 / 100);
}

// Several samples come nearer to the mean over the pixel than one does.
TEST_F(Rays, SamplesAverageThePixel) {
  const auto planet = bumpy();
  const auto draw = rays(planet);
  const auto request = [&](int scale, int samples) {
    core::DrawRequest r =
        request_for({20, 30, 40000, 30, -15, 20}, planet->radius_m(), 80 * scale, 60 * scale, 40);
    r.settings.smooth_edges = false;
    r.settings.samples = samples;
    return r;
  };
  constexpr int kScale = 8;
  const core::Frame fine = draw->draw(request(kScale, 1)).frame;
  const auto difference = [&](int samples) {
    const core::Frame frame = draw->draw(request(1, samples)).frame;
    double sum = 0;
    for (int y = 0; y < 60; ++y) {
      for (int x = 0; x < 80; ++x) {
        double mean = 0;
        for (int b = 0; b < kScale; ++b) {
          for (int a = 0; a < kScale; ++a)
            mean += fine.colour[static_cast<std::size_t>((y * kScale + b) * 80 * kScale + x * kScale + a)].r;
        }
        const double off = mean / (kScale * kScale) - frame.colour[static_cast<std::size_t>(y * 80 + x)].r;
        sum += off * off;
      }
    }
    return sum;
  };
  const double one = difference(1);
  EXPECT_LT(difference(2), 0.8 * one);
  EXPECT_LT(difference(4), 0.5 * one);
  // The certificate holds for the rays of all samples.
  core::DrawRequest coarse = request(1, 1);
  coarse.settings.ray_mode = core::RayMode::kMultires;
  const core::Certificate single = draw->draw(coarse).certificate;
  coarse.settings.samples = 4;
  const core::Certificate several = draw->draw(coarse).certificate;
  EXPECT_GE(several.screen_space_error_px, single.screen_space_error_px);
  EXPECT_LE(several.screen_space_error_px, coarse.settings.ray_cell_px);
  EXPECT_GT(several.geometric_error_m, 0);
  EXPECT_GE(several.tiles_drawn, single.tiles_drawn);
  // Ranges are those of the pixels' centres.
  EXPECT_EQ(draw->draw(request(1, 4)).frame.range_m, draw->draw(request(1, 1)).frame.range_m);
}

// Writes an image of the differences: grey where both backends agree; by the larger shift green over 1/4 px,
// yellow over 1/2, red over 1; white: sky in one of them.
void write_difference(const std::string& path, const core::DrawResult& a, const core::DrawResult& b,
                      std::span<const double> forward, std::span<const double> backward) {
  std::vector<vpe::base::Rgb> out;
  for (std::size_t k = 0; k < forward.size(); ++k) {
    const vpe::base::Rgb c = a.frame.colour[k];
    const auto grey = static_cast<std::uint8_t>((c.r + c.g + c.b) / 6);
    const double shift =
        std::max(std::isnan(forward[k]) ? 0.0 : forward[k], std::isnan(backward[k]) ? 0.0 : backward[k]);
    vpe::base::Rgb colour{grey, grey, grey};
    if (shift > 0.25) colour = {0, 160, 0};
    if (shift > 0.5) colour = {230, 230, 0};
    if (shift > 1) colour = {255, 0, 0};
    if (std::isinf(a.frame.range_m[k]) != std::isinf(b.frame.range_m[k])) colour = {255, 255, 255};
    out.push_back(colour);
  }
  core::write_image(path, out, a.frame.width, a.frame.height);
}

// Keeps the largest of each figure over several views.
struct Worst {
  core::ShiftSummary largest;
  std::string worst_view;  // of p99_px
  void add(const core::ShiftSummary& s, const std::string& view) {
    if (worst_view.empty() || s.p99_px > largest.p99_px) worst_view = view;
    largest.median_px = std::max(largest.median_px, s.median_px);
    largest.p99_px = std::max(largest.p99_px, s.p99_px);
    largest.p999_px = std::max(largest.p999_px, s.p999_px);
    largest.max_px = std::max(largest.max_px, s.max_px);
    largest.share_over_1px = std::max(largest.share_over_1px, s.share_over_1px);
  }
  void print(const char* name) const {
    std::printf("%s: at most median %.4f, 99 %% %.3f (%s), 99.9 %% %.3f, largest %.2f px; over 1 px %.4f %%\n",
                name, largest.median_px, largest.p99_px, worst_view.c_str(), largest.p999_px, largest.max_px,
                100 * largest.share_over_1px);
  }
};

// Expects that the images of both backends shift by at most 1 px on all but 0.5 % of the pixels (skylines).
// $VPE_PICTURES names a folder for images of the differences.
core::ImageErrors expect_agreement(core::Renderer& polygons, core::Renderer& rays,
                                   const paging::Surface& surface, core::DrawRequest request,
                                   const std::string& name) {
  request.settings.lod_tolerance_px = 0.5;
  request.settings.smooth_edges = false;
  const core::DrawResult a = polygons.draw(request);
  const core::DrawResult b = rays.draw(request);
  const auto errors = core::compare_to_reference(request.view, a.frame.range_m, b.frame.range_m,
                                                 test_support::radius_of(surface), {1, 1});
  SCOPED_TRACE(name + " " + core::to_json(errors));
  EXPECT_LE(errors.forward.share_over_1px, 0.005);
  EXPECT_LE(errors.backward.share_over_1px, 0.005);
  const char* images = std::getenv("VPE_PICTURES");
  if (images != nullptr)
    write_difference(std::string(images) + "/" + name + ".png", a, b,
                     core::forward_shift_px(request.view, a.frame.range_m, test_support::radius_of(surface)),
                     core::backward_shift_px(request.view, a.frame.range_m, b.frame.range_m, {1, 1}));
  // Where both see sky, it is one sky.
  std::int64_t sky = 0, differ = 0;
  for (std::size_t n = 0; n < a.frame.colour.size(); ++n) {
    if (std::isfinite(a.frame.range_m[n]) || std::isfinite(b.frame.range_m[n])) continue;
    ++sky;
    const vpe::base::Rgb p = a.frame.colour[n], q = b.frame.colour[n];
    differ += std::max({std::abs(p.r - q.r), std::abs(p.g - q.g), std::abs(p.b - q.b)}) > 2 ? 1 : 0;
  }
  EXPECT_EQ(differ, 0) << "of " << sky;
  return errors;
}

TEST_F(Rays, BackendsAgree) {
  const auto planet = bumpy();
  const paging::Surface surface(planet, std::size_t{1} << 27);
  const auto polygons = renderer(planet);
  const auto draw = rays(planet);
  Random random(93);
  for (int n = 0; n < 8; ++n) {
    expect_agreement(*polygons, *draw, surface, random_request(random, surface, 120, 80),
                     "view " + std::to_string(n));
  }
}

class LongRays : public Rays {
 protected:
  using Request = std::function<core::DrawRequest(Random& random, const paging::Surface& surface)>;
  void expect_agreement_in_200_views(const char* file, const std::string& name, const Request& next) {
    const auto planet = paging::PlanetFile::open(file);
    const paging::Surface surface(planet, std::size_t{1} << 28);
    const auto polygons = renderer(planet, std::size_t{1} << 29);
    const auto draw = rays(planet);
    Random random(94);
    Worst forward, backward;
    for (int n = 0; n < 200; ++n) {
      const std::string view = name + "-" + std::to_string(n);
      const auto errors = expect_agreement(*polygons, *draw, surface, next(random, surface), view);
      forward.add(errors.forward, view);
      backward.add(errors.backward, view);
    }
    forward.print("forward");
    backward.print("backward");
  }
};

// $VPE_EMBEDDED_PLANET names a planet file of the embedded Mars.
TEST_F(LongRays, BackendsAgreeOnTheEmbeddedMars) {
  const char* ready = std::getenv("VPE_EMBEDDED_PLANET");
  if (ready == nullptr) GTEST_SKIP() << "skipped: $VPE_EMBEDDED_PLANET names no planet file";
  expect_agreement_in_200_views(ready, "mars", [](Random& random, const paging::Surface& surface) {
    return random_request(random, surface, 240, 144);
  });
}

// $VPE_GALE_PLANET names a planet file with fine ground at Gale. From 1.5 m to 300 km, about the rover's place.
TEST_F(LongRays, BackendsAgreeOverGale) {
  const char* ready = std::getenv("VPE_GALE_PLANET");
  if (ready == nullptr) GTEST_SKIP() << "skipped: $VPE_GALE_PLANET names no planet file";
  expect_agreement_in_200_views(ready, "gale", [](Random& random, const paging::Surface& surface) {
    const double azimuth_rad = random.uniform(0, 2 * M_PI);
    const double off_deg = random.log_uniform(1e-4, 2);
    const mars::LonLat place{137.4417 + off_deg * std::cos(azimuth_rad),
                             -4.5895 + off_deg * std::sin(azimuth_rad)};
    const double ground = surface.at(mars::direction(place)).height_m;
    const mars::Pose pose{
        place.lon_deg,          place.lat_deg,           ground + random.log_uniform(1.5, 3e5),
        random.uniform(0, 360), random.uniform(-90, 10), random.uniform(-180, 180)};
    return request_for(pose, surface.planet_radius_m(), 240, 144, random.log_uniform(5, 100));
  });
}

TEST_F(Rays, RefusesWhatItCannotDraw) {
  const auto planet = bumpy();
  const auto draw = rays(planet);
  core::DrawRequest request = request_for({0, 0, 1000, 0, 0, 0}, planet->radius_m(), 16, 16);
  request.settings.mode = core::Mode::kWireframe;
  EXPECT_THROW(draw->draw(request), std::runtime_error);
  request.settings.mode = core::Mode::kLit;
  request.settings.shading = core::Shading::kVertex;
  EXPECT_THROW(draw->draw(request), std::runtime_error);
  request.settings.shading = core::Shading::kGouraud;
  request.settings.inspect = core::Inspect::kBorders;
  EXPECT_THROW(draw->draw(request), std::runtime_error);
  request.settings.inspect = core::Inspect::kNone;
  request.cull_view = request.view;
  EXPECT_THROW(draw->draw(request), std::runtime_error);
  request.cull_view.reset();
  EXPECT_NO_THROW(draw->draw(request));
  request.view.camera.position_m.x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(draw->draw(request), std::runtime_error);
}

}  // namespace
