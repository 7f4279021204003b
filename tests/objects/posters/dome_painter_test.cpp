// Domes that are drawn by blocks against the same ones drawn a pixel at a time.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/constants.hpp>

#include "objects/draw/dome_painter.h"
#include "tests/objects/posters/dome_fixture.h"

namespace objects {
namespace {

using namespace test;

const char* name_of(Kind kind) {
  return kind == Kind::kEquirectangular ? "equirectangular" : kind == Kind::kCylinder ? "cylinder" : "facets";
}
constexpr std::array kKinds{Kind::kEquirectangular, Kind::kCylinder, Kind::kFacets};
constexpr std::array kProjections{core::Projection::kPerspective, core::Projection::kEquirectangular,
                                  core::Projection::kCylinder};

// Turns the camera, as pilots say, within the axes that it has.
void turn(core::View& view, double yaw_deg, double pitch_deg, double roll_deg) {
  const mars::Axes a = view.camera.axes;
  mars::LocalFrame frame;
  frame.east = a.right;
  frame.north = a.forward;
  frame.up = a.up;
  view.camera.axes = mars::oriented_axes(frame, yaw_deg, pitch_deg, roll_deg);
}

core::Frame drawn(const core::DrawRequest& r, const PlacedPoster& dome, int threads = 1, float ground_m = 0) {
  core::Frame frame = empty_frame(r);
  if (ground_m > 0) {
    for (std::size_t n = 0; n < frame.range_m.size(); ++n)
      frame.range_m[n] = ground_m * (1 + 0.001F * static_cast<float>(n % 977));
  }
  (void)draw_posters(r, {&dome, 1}, frame, {}, threads);
  return frame;
}

// Random attitudes, among them those with a pole or the seam in the image, from all places within the dome.
TEST(DomePainter, DrawsWhatPixelsDraw) {
  constexpr unsigned kSeed = 20261127;
  std::mt19937 random(kSeed);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  std::vector<PosterImage> images;
  for (const Kind kind : kKinds) images.push_back(panorama_image(formula_of(kind, 720)));
  for (int n = 0; n < 120; ++n) {
    const Kind kind = kKinds[static_cast<std::size_t>(n) % 3];
    core::DrawRequest r = request_of(90, 70);
    PlacedPoster dome = dome_of(r, images[static_cast<std::size_t>(n) % 3]);
    dome.is_cylinder = n % 4 == 1;
    dome.replaces_ground = n % 2 == 1;
    r.view.projection = n % 9 == 8 ? kProjections[1 + static_cast<std::size_t>(n) % 2] : kProjections[0];
    r.view.fov_deg = n % 10 == 0 ? 150 : std::exp(between(std::log(0.1), std::log(110)));
    if (n % 7 != 0) {
      const double away_m = dome.radius_m * between(0, 0.95);
      const double azimuth = between(0, 2 * mars::kPi);
      r.view.camera.position_m +=
          away_m * (std::cos(azimuth) * dome.axes.right + std::sin(azimuth) * dome.axes.forward);
    }
    turn(r.view, between(0, 360), n % 6 == 0 ? (n % 12 == 0 ? 90 : -90) : between(-90, 90), between(-180, 180));
    r.settings.smooth_edges = n % 3 == 0;
    const float ground_m = n % 5 == 0 ? 90 : 0;
    SCOPED_TRACE(std::string(name_of(kind)) + " " + std::to_string(n) + " seed " + std::to_string(kSeed));
    const FrameDifference d = difference(drawn(r, dome, 1, ground_m), drawn(r, by_pixels(dome), 1, ground_m));
    EXPECT_LE(d.most, 1);
    EXPECT_LT(d.mean, 0.05);
    EXPECT_LE(d.parted, 6);
  }
}

// Level by level, down to where the whole panorama is a pixel.
TEST(DomePainter, MixesLevelsAsPixelsDo) {
  for (const Kind kind : kKinds) {
    for (const int width : {16, 40, 90, 260, 700}) {
      core::DrawRequest r = request_of(width, width * 3 / 4);
      r.view.fov_deg = 70;
      const PlacedPoster dome = dome_of(r, panorama_image(formula_of(kind, 960), 120));
      turn(r.view, 20, 10, 5);
      SCOPED_TRACE(std::string(name_of(kind)) + " " + std::to_string(width));
      const FrameDifference d = difference(drawn(r, dome), drawn(r, by_pixels(dome)));
      EXPECT_LE(d.most, width < 100 ? 3 : 1);
      EXPECT_LT(d.mean, width < 100 ? 0.3 : 0.1);
      EXPECT_EQ(d.parted, 0);
    }
  }
}

// The part of a circle that a panorama shows ends at sharp edges, also where it begins at the seam.
TEST(DomePainter, LeavesWhatThePanoramaDoesNotShow) {
  for (const Kind kind : kKinds) {
    for (const double crop_left_px : {0.0, 100.0, 500.0}) {
      PanoramaFormula f = formula_of(kind, 720);
      f.width_px = 300;
      f.crop_left_px = crop_left_px;
      f.height_px = 200;
      f.horizon_px = 90;
      for (double yaw_deg = 0; yaw_deg < 360; yaw_deg += 45) {
        core::DrawRequest r = request_of(160, 120);
        r.view.fov_deg = 100;
        const PlacedPoster dome = dome_of(r, panorama_image(f));
        turn(r.view, yaw_deg, 0, 30);
        SCOPED_TRACE(std::string(name_of(kind)) + " " + std::to_string(yaw_deg));
        const FrameDifference d = difference(drawn(r, dome), drawn(r, by_pixels(dome)));
        EXPECT_LE(d.most, 1);
        EXPECT_LE(d.parted, 3);
      }
    }
  }
}

TEST(DomePainter, KeepsGammaAndOpacity) {
  core::DrawRequest r = request_of();
  PlacedPoster dome = dome_of(r, panorama_image(formula_of(Kind::kEquirectangular, 720)));
  for (const double gamma : {1.0, 0.6, 1.8}) {
    for (const double opacity : {1.0, 0.7, 0.3}) {
      r.settings.gamma = gamma;
      dome.opacity = opacity;
      SCOPED_TRACE(std::to_string(gamma) + " " + std::to_string(opacity));
      const FrameDifference d = difference(drawn(r, dome, 1, 150), drawn(r, by_pixels(dome), 1, 150));
      EXPECT_LE(d.most, 1);
      EXPECT_EQ(d.parted, 0);
    }
  }
}

TEST(DomePainter, DoesNotDependOnThreads) {
  core::DrawRequest r = request_of(300, 200);
  r.settings.smooth_edges = true;
  PanoramaFormula f = formula_of(Kind::kCylinder, 720);
  f.width_px = 400;
  const PlacedPoster dome = dome_of(r, panorama_image(f, 50));
  turn(r.view, 130, -5, 3);
  const core::Frame one = drawn(r, dome, 1, 99);
  const core::Frame four = drawn(r, dome, 4, 99);
  EXPECT_EQ(one.colour, four.colour);
  EXPECT_EQ(one.range_m, four.range_m);
}

// Without ranges the image is the same, and what is not covered is counted.
TEST(DomePainter, NeedsNoRangesWhereThereIsNoGround) {
  core::DrawRequest r = request_of(200, 150);
  r.settings.smooth_edges = true;
  PanoramaFormula f = formula_of(Kind::kEquirectangular, 720);
  for (const bool is_whole : {true, false}) {
    if (!is_whole) f.width_px = 380;
    const PlacedPoster dome = dome_of(r, panorama_image(f));
    core::Frame with = empty_frame(r);
    core::Frame without = empty_frame(r);
    without.range_m.clear();
    const ComposedObjects a = draw_posters(r, {&dome, 1}, with);
    const ComposedObjects b = draw_posters(r, {&dome, 1}, without);
    EXPECT_EQ(with.colour, without.colour);
    EXPECT_EQ(a.covered, b.covered);
    EXPECT_EQ(a.covered,
              std::ranges::count_if(with.range_m, [](float range_m) { return std::isfinite(range_m); }));
    EXPECT_EQ(is_whole, a.covered == 200 * 150);
  }
}

}  // namespace
}  // namespace objects
