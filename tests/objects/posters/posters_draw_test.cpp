// Images in the world: what hides them, what they hide, opacity, billboards, photographs, domes.
#include <gtest/gtest.h>

#include <cmath>

#include "objects/model/shapes.h"
#include "objects/posters/kiosk.h"
#include "tests/objects/posters/poster_fixture.h"

namespace objects {
namespace {

using namespace test;

Rgb colour_at(const core::Frame& f, int x, int y) { return f.colour[pixel_at(f, x, y)]; }

std::shared_ptr<const Model> model_with(Mesh mesh) {
  Model::Level level;
  level.mesh = std::move(mesh);
  level.tree = TriangleTree(level.mesh);
  std::vector<Model::Level> levels;
  levels.push_back(std::move(level));
  return std::make_shared<const Model>("model", std::move(levels));
}

// A box of 2 m in the middle of the image, 10 m away.
Scene box_scene(const core::DrawRequest& r) {
  Instance i;
  const mars::Axes& a = r.view.camera.axes;
  i.position_m = r.view.camera.position_m + 10.0 * a.forward - 1.0 * a.up;
  i.rotation = glm::quat(glm::normalize(glm::quat_cast(glm::dmat3(a.right, a.forward, a.up))));
  return Scene({model_with(make_box({2, 2, 2}))}, {i});
}

// A panorama of 1 degree a pixel all around: red counts the azimuth, green the elevation.
PosterImage round_image() {
  PosterImage image = ramp_image(360, 180);
  image.is_full_circle = true;
  image.lookup = [](const glm::dvec3& d) -> std::optional<PanoramaPlace> {
    double azimuth = std::atan2(d.x, d.y) / mars::kRadiansPerDegree;
    if (azimuth < 0) azimuth += 360;
    const double elevation = std::asin(std::clamp(d.z, -1.0, 1.0)) / mars::kRadiansPerDegree;
    const double step = mars::kRadiansPerDegree;
    return PanoramaPlace{{azimuth / 360, 0.5 - elevation / 180},
                         step * step * std::max(1e-6, std::cos(elevation * step))};
  };
  return image;
}

PlacedPoster dome_about(const core::DrawRequest& r, double radius_m, double fade_m) {
  PlacedPoster p;
  p.form = PosterForm::kDome;
  p.image = round_image();
  p.axes = r.view.camera.axes;
  p.middle_m = r.view.camera.position_m;
  p.radius_m = radius_m;
  p.fade_m = fade_m;
  return p;
}

TEST(Posters, GroundHidesThemExactly) {
  const core::DrawRequest r = request_of();
  const PlacedPoster pane = pane_before(r, plain_image({200, 0, 0}), {0, 0, 50}, 40, 30);
  core::Frame frame = empty_frame(r);
  // Ground is a sphere about a place before the pane, and a slanted plane.
  const glm::dvec3 to_m = 45.0 * r.view.camera.axes.forward + 8.0 * r.view.camera.axes.right;
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) {
      const glm::dvec3 d = core::pixel_ray(r.view, x + 0.5, y + 0.5);
      const double b = glm::dot(to_m, d);
      const double root = b * b - glm::dot(to_m, to_m) + 9.0 * 9.0;
      double range_m = root >= 0 ? b - std::sqrt(root) : HUGE_VAL;
      const double down = -glm::dot(d, r.view.camera.axes.up) - 0.05 * glm::dot(d, r.view.camera.axes.right);
      if (down > 0) range_m = std::min(range_m, 12 / down);
      frame.range_m[pixel_at(frame, x, y)] = static_cast<float>(range_m);
    }
  }
  const core::Frame ground = frame;
  (void)draw_posters(r, {&pane, 1}, frame);
  int shown = 0;
  int hidden = 0;
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) {
      const glm::dvec3 d = core::pixel_ray(r.view, x + 0.5, y + 0.5);
      const double range_m = 50 / glm::dot(d, r.view.camera.axes.forward);
      const glm::dvec3 at = range_m * d;
      const bool is_within = std::abs(glm::dot(at, r.view.camera.axes.right)) < 20 &&
                             std::abs(glm::dot(at, r.view.camera.axes.up)) < 15;
      const std::size_t pixel = pixel_at(frame, x, y);
      const bool is_before = range_m < static_cast<double>(ground.range_m[pixel]);
      EXPECT_EQ(frame.colour[pixel], is_within && is_before ? (Rgb{200, 0, 0}) : kPaper) << x << " " << y;
      shown += is_within && is_before ? 1 : 0;
      hidden += is_within && !is_before ? 1 : 0;
    }
  }
  EXPECT_GT(shown, 1000);
  EXPECT_GT(hidden, 1000);
}

TEST(Posters, ObjectsAndImagesHideEachOther) {
  const core::DrawRequest r = request_of();
  const Scene scene = box_scene(r);
  const Rgb box = [&] {
    core::Frame frame = empty_frame(r);
    (void)draw_posters(r, {}, frame, scene);
    return colour_at(frame, 80, 60);
  }();
  ASSERT_NE(box, kPaper);
  const std::vector<PlacedPoster> both{pane_before(r, plain_image({0, 250, 0}), {0, 0, 20}, 8, 8),
                                       pane_before(r, plain_image({0, 0, 250}), {0.5, 0, 5}, 0.5, 4)};
  core::Frame frame = empty_frame(r);
  (void)draw_posters(r, both, frame, scene);
  EXPECT_EQ(colour_at(frame, 80, 60), box);
  EXPECT_EQ(colour_at(frame, 80, 42), (Rgb{0, 250, 0}));  // above the box
  EXPECT_EQ(colour_at(frame, 93, 60), (Rgb{0, 0, 250}));
  EXPECT_NEAR(static_cast<double>(frame.range_m[pixel_at(frame, 93, 60)]), 5, 0.1);
}

TEST(Posters, OpacityMixesFromFarToNear) {
  const core::DrawRequest r = request_of();
  std::vector<PlacedPoster> two{pane_before(r, plain_image({100, 0, 0}), {0, 0, 5}, 20, 20),
                                pane_before(r, plain_image({0, 200, 0}), {0, 0, 8}, 20, 20)};
  two[0].opacity = 0.25;
  two[1].opacity = 0.5;
  for (int order = 0; order < 2; ++order) {
    core::Frame frame = empty_frame(r);
    const ComposedObjects drawn = draw_posters(r, two, frame);
    EXPECT_TRUE(drawn.is_see_through);
    EXPECT_NEAR(drawn.clear_m, 5, 1e-9);
    const Rgb c = colour_at(frame, 80, 60);
    EXPECT_NEAR(c.r, 0.25 * 100 + 0.75 * 0.5 * kPaper.r, 0.51);
    EXPECT_NEAR(c.g, 0.75 * 0.5 * 200 + 0.75 * 0.5 * kPaper.g, 0.51);
    EXPECT_NEAR(static_cast<double>(frame.range_m[pixel_at(frame, 80, 60)]), 8, 0.01);
    std::swap(two[0], two[1]);
  }
}

TEST(Posters, ColoursAreTheirOwnAfterGamma) {
  core::DrawRequest r = request_of();
  r.settings.gamma = 1.5;
  const PlacedPoster pane = pane_before(r, plain_image({200, 120, 60}), {0, 0, 5}, 20, 20);
  core::Frame frame = empty_frame(r);
  (void)draw_posters(r, {&pane, 1}, frame);
  const Rgb c = colour_at(frame, 80, 60);
  const auto shown = [](int v) { return 255 * std::pow(v / 255.0, 1 / 1.5); };
  EXPECT_NEAR(shown(c.r), 200, 1.5);
  EXPECT_NEAR(shown(c.g), 120, 1.5);
  EXPECT_NEAR(shown(c.b), 60, 1.5);
}

TEST(Posters, NoneLeavesAnImageAsItIs) {
  core::DrawRequest r = request_of();
  r.settings.smooth_edges = true;
  const Scene scene = box_scene(r);
  core::Frame without = empty_frame(r);
  (void)draw_posters(r, {}, without, scene);
  PlacedPoster behind = pane_before(r, plain_image({255, 0, 0}), {0, 0, -5}, 4, 4);
  core::Frame with = empty_frame(r);
  (void)draw_posters(r, {&behind, 1}, with, scene, 3);
  EXPECT_EQ(with.colour, without.colour);
  EXPECT_EQ(with.range_m, without.range_m);
}

TEST(Posters, ResultsDoNotDependOnThreads) {
  core::DrawRequest r = request_of();
  r.settings.smooth_edges = true;
  std::vector<PlacedPoster> some{dome_about(r, 100, 100), pane_before(r, ramp_image(64, 64), {1, 0, 6}, 3, 3)};
  some[1].opacity = 0.5;
  core::Frame one = empty_frame(r);
  core::Frame four = empty_frame(r);
  (void)draw_posters(r, some, one, box_scene(r), 1);
  (void)draw_posters(r, some, four, box_scene(r), 4);
  EXPECT_EQ(one.colour, four.colour);
}

TEST(Posters, BillboardsFaceTheCameraAboutTheVertical) {
  PosterEntry entry;
  entry.form = PosterForm::kBillboard;
  entry.place = mars::LonLat{10, 20};
  entry.width_m = 4;
  const PlacedPoster placed =
      place_entry(entry, plain_image({9, 9, 9}, 4, 8), kRadius_m, [](const glm::dvec3&) { return kRadius_m; });
  EXPECT_NEAR(placed.tall_m, 8, 1e-12);
  for (const double yaw : {0.0, 70.0, 200.0}) {
    core::DrawRequest r = request_of();
    const mars::LonLat from = mars::destination({10, 20}, yaw, 40 / kRadius_m);
    r.view.camera = mars::to_camera(
        {from.lon_deg, from.lat_deg, 4, mars::initial_bearing_deg(from, {10, 20}), 0, 0}, kRadius_m);
    core::Frame frame = empty_frame(r);
    (void)draw_posters(r, {&placed, 1}, frame);
    int columns = 0;
    for (int x = 0; x < frame.width; ++x) columns += colour_at(frame, x, 60) == Rgb{9, 9, 9} ? 1 : 0;
    EXPECT_NEAR(columns, 4.0 / 40 * core::focal_px(r.view), 1.01) << yaw;
  }
}

TEST(Posters, PanesFaceTheirHeadingAndLeanBack) {
  PosterEntry entry;
  entry.place = mars::LonLat{0, 0};
  entry.heading_deg = 180;
  entry.pitch_deg = 30;
  entry.width_m = 2;
  entry.tall_m = 2;
  const PlacedPoster placed =
      place_entry(entry, plain_image({1, 1, 1}), kRadius_m, [](const glm::dvec3&) { return kRadius_m; });
  const mars::LocalFrame frame = mars::local_frame({0, 0});
  // Seen from the south, east is on the right, and the top is farther.
  EXPECT_NEAR(glm::dot(placed.axes.right, frame.east), 1, 1e-12);
  EXPECT_NEAR(glm::dot(placed.axes.up, frame.north), 0.5, 1e-12);
  EXPECT_NEAR(glm::dot(placed.middle_m, frame.up) - kRadius_m, std::sqrt(0.75), 1e-6);
}

// A photograph covers for its own camera what it shows, at any distance and with any attitude.
TEST(Posters, PhotographsCoverTheImageOfTheirCamera) {
  for (const double distance_m : {1.0, 500.0}) {
    PosterEntry entry;
    entry.form = PosterForm::kPhotograph;
    entry.place = mars::LonLat{30, -40};
    entry.height_kind = HeightKind::kAltitude;
    entry.height_m = 300;
    entry.heading_deg = 77;
    entry.pitch_deg = -12;
    entry.roll_deg = 8;
    entry.fov_deg = 50;
    entry.distance_m = distance_m;
    core::DrawRequest r = request_of();
    r.view.camera = mars::to_camera({30, -40, 300, 77, -12, 8}, kRadius_m);
    std::mt19937 random(5);
    Texture t{160, 120, {}};
    for (int n = 0; n < 160 * 120; ++n) {
      const auto byte = [&] { return static_cast<std::uint8_t>(random()); };
      t.texels.push_back({byte(), byte(), byte(), 255});
    }
    const Texture taken = t;
    const PlacedPoster placed =
        place_entry(entry, {std::make_shared<const TexturePyramid>(std::move(t)), 160, 120}, kRadius_m,
                    [](const glm::dvec3&) { return 0.0; });
    core::Frame frame = empty_frame(r);
    (void)draw_posters(r, {&placed, 1}, frame);
    double sum = 0;
    for (std::size_t n = 0; n < frame.colour.size(); ++n)
      sum += std::abs(frame.colour[n].r - taken.texels[n].r) + std::abs(frame.colour[n].g - taken.texels[n].g);
    EXPECT_LT(sum / static_cast<double>(2 * frame.colour.size()), 0.05) << distance_m;
  }
}

TEST(Domes, ShowTheirPanoramaFromTheMiddle) {
  for (const auto projection : {core::Projection::kPerspective, core::Projection::kEquirectangular}) {
    for (const bool is_cylinder : {false, true}) {
      core::DrawRequest r = request_of();
      r.view.projection = projection;
      if (projection != core::Projection::kPerspective) r.view.width = 240, r.view.fov_deg = 120;
      PlacedPoster dome = dome_about(r, 200, 200);
      dome.is_cylinder = is_cylinder;
      core::Frame frame = empty_frame(r);
      (void)draw_posters(r, {&dome, 1}, frame);
      const SeenPosters seen({&dome, 1}, r.view, 1);
      for (int y = 0; y < frame.height; y += 7) {
        for (int x = 0; x < frame.width; x += 7) {
          const glm::dvec3 d = core::pixel_ray(r.view, x + 0.5, y + 0.5);
          const mars::Axes& a = r.view.camera.axes;
          const auto place =
              dome.image.lookup({glm::dot(d, a.right), glm::dot(d, a.forward), glm::dot(d, a.up)});
          const auto hit = seen.meet(0, d, 1e9);
          ASSERT_TRUE(hit);
          EXPECT_NEAR(hit->uv.x, place->uv.x, 1e-5);
          EXPECT_NEAR(hit->uv.y, place->uv.y, 1e-5);
          const double e = std::asin(glm::dot(d, a.up));
          EXPECT_NEAR(hit->range_m, is_cylinder ? 200 / std::cos(e) : 200, 1e-6);
          EXPECT_TRUE(std::isfinite(frame.range_m[pixel_at(frame, x, y)]));
        }
      }
    }
  }
}

TEST(Domes, FadeInWhereTheCameraComesNearer) {
  EXPECT_EQ(dome_share(0, 10), 1);
  EXPECT_EQ(dome_share(5, 10), 1);
  EXPECT_EQ(dome_share(7.5, 10), 0.5);
  EXPECT_EQ(dome_share(10, 10), 0);
  core::DrawRequest r = request_of();
  PlacedPoster dome = dome_about(r, 100, 20);
  dome.image = plain_image({210, 210, 210});
  dome.image.lookup = [](const glm::dvec3&) { return PanoramaPlace{{0.5, 0.5}, 1e-3}; };
  double last = 255;
  for (const double moved_m : {0.0, 9.9, 12.0, 15.0, 18.0, 20.0, 99.0, 101.0, 500.0}) {
    r.view.camera.position_m = dome.middle_m + moved_m * r.view.camera.axes.right;
    core::Frame frame = empty_frame(r);
    (void)draw_posters(r, {&dome, 1}, frame);
    const double share = dome_share(moved_m, 20);
    EXPECT_NEAR(colour_at(frame, 80, 60).r, share * 210 + (1 - share) * kPaper.r, 0.51) << moved_m;
    EXPECT_LE(colour_at(frame, 80, 60).r, last);
    last = colour_at(frame, 80, 60).r;
  }
}

// Ground nearer than the dome hides it, or is painted by it.
TEST(Domes, ReplaceNearerGroundOnDemand) {
  const core::DrawRequest r = request_of();
  PlacedPoster dome = dome_about(r, 100, 100);
  core::Frame hidden = empty_frame(r);
  hidden.range_m.assign(hidden.range_m.size(), 40.0F);
  core::Frame painted = hidden;
  (void)draw_posters(r, {&dome, 1}, hidden);
  EXPECT_EQ(colour_at(hidden, 80, 60), kPaper);
  dome.replaces_ground = true;
  (void)draw_posters(r, {&dome, 1}, painted);
  EXPECT_NE(colour_at(painted, 80, 60), kPaper);
  EXPECT_EQ(painted.range_m[pixel_at(painted, 80, 60)], 40.0F);
}

TEST(Domes, HaveNoSeamWhereTheCircleEnds) {
  core::DrawRequest r = request_of();
  PlacedPoster dome = dome_about(r, 100, 100);
  Texture t{8, 4, {}};
  for (int n = 0; n < 32; ++n)
    t.texels.push_back({static_cast<std::uint8_t>(n % 8 == 0 || n % 8 == 7 ? 200 : 50), 0, 0, 255});
  const auto lookup = dome.image.lookup;
  dome.image = {std::make_shared<const TexturePyramid>(std::move(t)), 8, 4, lookup, true};
  core::Frame frame = empty_frame(r);
  (void)draw_posters(r, {&dome, 1}, frame);
  for (int x = 70; x < 90; ++x) EXPECT_EQ(colour_at(frame, x, 60).r, 200) << x;
}

TEST(Kiosks, AreClosedMeshesOfAMetre) {
  const Mesh mesh = make_kiosk();
  EXPECT_EQ(check(mesh), "");
  float top = 0;
  float bottom = 9;
  for (const glm::vec3& p : mesh.positions_m) top = std::max(top, p.z), bottom = std::min(bottom, p.z);
  EXPECT_FLOAT_EQ(top, 1);
  EXPECT_FLOAT_EQ(bottom, 0);
}

TEST(TexturePyramids, SampleWithinTheirEdges) {
  Texture t{2, 1, {{0, 0, 0, 255}, {200, 0, 0, 255}}};
  const TexturePyramid pyramid(t);
  EXPECT_FLOAT_EQ(pyramid.sample_within({0, 0.5F}, 1, false).x, 0);
  EXPECT_FLOAT_EQ(pyramid.sample_within({1, 0.5F}, 1, false).x, 200);
  EXPECT_FLOAT_EQ(pyramid.sample_within({0.5F, 0.5F}, 1, false).x, 100);
  EXPECT_FLOAT_EQ(pyramid.sample_within({0, 0.5F}, 1, true).x, 100);
  EXPECT_FLOAT_EQ(pyramid.sample_within({0, 0.5F}, 2, false).x, 100);
}

}  // namespace
}  // namespace objects
