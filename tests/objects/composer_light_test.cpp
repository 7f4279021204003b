// Light, haze, shadows and semi-transparent surfaces of objects in images.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/objects/composer_fixture.h"
#include "vpe/core/appearance/shading.h"

namespace objects {
namespace {

// Returns the only colour of a white box's side that faces the camera.
Rgb colour_of_side(const core::DrawRequest& r, Material material = {{255, 255, 255, 255}}) {
  Mesh box = make_box({4, 1, 4});
  box.material_table = {material};
  std::fill(box.materials.begin(), box.materials.end(), std::uint16_t{0});
  const Scene scene({model_of(std::move(box))}, {instance_before(r, {0, -2, 10})});
  core::Frame frame = paper_frame(r);
  draw(scene, r, frame);
  return frame.colour[at(frame, 100, 80)];
}

TEST(Composer, LightIsThatOfTheGround) {
  core::DrawRequest r = request_at();
  EXPECT_EQ(colour_of_side(r), (Rgb{255, 255, 255}));
  r.settings.mode = core::Mode::kTextured;
  for (const double forward : {-1.0, -0.3, 0.4}) {
    r.sun = glm::normalize(glm::dvec3(1, forward, 0.2));  // the side faces -y
    r.settings.sun_diffuse = 0.7;
    const double expected =
        255 * core::light(r.settings.sun_ambient, r.settings.sun_diffuse, std::max(0.0, -r.sun.y));
    EXPECT_NEAR(colour_of_side(r).g, expected, 0.6) << forward;
  }
  // At night there is no sun, whatever a side faces.
  r.sun = glm::normalize(glm::dvec3(-1, -1, 0));
  EXPECT_NEAR(colour_of_side(r).g, 255 * core::light(r.settings.sun_ambient, 0, 0), 0.6);
}

TEST(Composer, HazeIsThatOfTheGround) {
  core::DrawRequest r = request_at();
  r.settings.haze_visibility_m = 40;
  r.settings.atmosphere = core::Atmosphere::kMars;
  const ImageLight light{r, kRadius_m, nullptr};
  const glm::dvec3 d = ray_at(r, 100, 80);
  const Haze haze = haze_at(light, d, 9.5);
  EXPECT_NEAR(haze.transmitted, std::exp(-core::kKoschmieder * 9.5 * std::exp(-1000 / core::kAirScale_m) / 40),
              1e-4);
  const Rgb c = colour_of_side(r, {{100, 100, 100, 255}});
  EXPECT_NEAR(c.r, 100 * haze.transmitted + haze.added.r, 1.5);
}

TEST(Composer, ModesPaintAsTheirNamesSay) {
  core::DrawRequest r = request_at();
  const Material red{{200, 10, 10, 255}};
  r.settings.mode = core::Mode::kLit;
  r.sun = glm::normalize(glm::dvec3(1, -1, 0));
  const Rgb lit = colour_of_side(r, red);
  const double light = core::light(r.settings.sun_ambient, r.settings.sun_diffuse, -r.sun.y);
  EXPECT_NEAR(lit.g, std::min(255.0, r.settings.plain_ground.g * light), 1);
  r.settings.mode = core::Mode::kWireframe;
  core::Frame frame = paper_frame(r);
  const Scene scene({model_of(make_box({4, 1, 4}))}, {instance_before(r, {0, -2, 10})});
  draw(scene, r, frame);
  const auto lines = std::count(frame.colour.begin(), frame.colour.end(), Rgb{242, 191, 140});
  EXPECT_EQ(frame.colour[at(frame, 115, 80)], (Rgb{0, 0, 0}));  // between edges
  EXPECT_GT(lines, 200);                                        // five edges of some 70 px
  EXPECT_LT(lines, 800);
  r.settings.mode = core::Mode::kMarkers;
  frame = paper_frame(r);
  draw(scene, r, frame);
  const auto dots = std::count(frame.colour.begin(), frame.colour.end(), Rgb{242, 191, 140});
  EXPECT_GT(dots, 3);
  EXPECT_LT(dots, 40);
}

// N panes of opacity a leave (1 - a)^N of what is behind.
TEST(Composer, SemiTransparentPanesMultiply) {
  core::DrawRequest r = request_at();
  Mesh panes;
  constexpr int kPanes = 5;
  for (int n = 0; n < kPanes; ++n) {
    const auto first = static_cast<unsigned>(panes.positions_m.size());
    const float y = static_cast<float>(n);
    for (const glm::vec3 p :
         {glm::vec3(-5, y, -5), glm::vec3(5, y, -5), glm::vec3(5, y, 5), glm::vec3(-5, y, 5)})
      panes.positions_m.push_back(p);
    panes.triangles.push_back({first, first + 1, first + 2});
    panes.triangles.push_back({first, first + 2, first + 3});
  }
  panes.materials.assign(panes.triangles.size(), 0);
  panes.material_table = {{{255, 255, 255, 64}, -1, AlphaMode::kBlend}};
  const Scene scene({model_of(std::move(panes))}, {instance_before(r, {0, 0, 10})});
  core::Frame frame = paper_frame(r);
  draw(scene, r, frame);
  const double through = std::pow(1 - 64.0 / 255, kPanes);
  EXPECT_NEAR(frame.colour[at(frame, 103, 71)].r, 255 * (1 - through) + kPaper.r * through, 0.51);
  // 1 - (1 - 0.25)^3 passes a half at the third pane.
  EXPECT_NEAR(frame.range_m[at(frame, 103, 71)], 12 / ray_at(r, 103, 71).y, 1e-3);
}

TEST(Composer, MaskedTexelsAreHoles) {
  core::DrawRequest r = request_at();
  const Rgb seen = colour_of_side(r, {{255, 255, 255, 100}, -1, AlphaMode::kMask, 128});
  EXPECT_EQ(seen, kPaper);
  EXPECT_NE(colour_of_side(r, {{255, 255, 255, 130}, -1, AlphaMode::kMask, 128}), kPaper);
}

// Ground as a plane below the camera, and its light.
class FlatGround : public core::GroundLight {
 public:
  double shadow_factor(const glm::dvec3&, double) const override { return 0.25; }
  bool sees_sun(const glm::dvec3&) const override { return true; }
};

TEST(Composer, ShadowsLieWhereTheSunIsHidden) {
  core::DrawRequest r = request_at(10);
  r.settings.mode = core::Mode::kTextured;
  r.sun = glm::normalize(glm::dvec3(0.5, 0.8, 0.3));
  core::Frame frame = paper_frame(r);
  std::fill(frame.colour.begin(), frame.colour.end(), Rgb{100, 100, 100});
  const double ground_x = kRadius_m;
  for (int y = 0; y < 160; ++y) {
    for (int x = 0; x < 200; ++x) {
      const glm::dvec3 d = ray_at(r, x, y);
      if (d.x < 0) frame.range_m[at(frame, x, y)] = static_cast<float>(-10 / d.x);
    }
  }
  // A ball that hovers.
  Instance ball = instance_before(r, {1, -5, 30});
  const Scene scene({model_of(make_ellipsoid({3, 3, 3}, 160))}, {ball});
  const core::Frame before = frame;
  FlatGround ground;
  const ComposedObjects drawn = draw(scene, r, frame, &ground);
  std::int64_t dark = 0;
  for (int y = 0; y < 160; ++y) {
    for (int x = 0; x < 200; ++x) {
      const std::size_t n = at(frame, x, y);
      if (std::isinf(before.range_m[n]) || frame.range_m[n] != before.range_m[n]) continue;
      const glm::dvec3 place =
          r.view.camera.position_m + static_cast<double>(before.range_m[n]) * ray_at(r, x, y);
      ASSERT_NEAR(place.x, ground_x, 0.01);
      const glm::dvec3 to = ball.position_m - place;
      const double along = glm::dot(to, r.sun);
      const double beside = glm::length(to - along * r.sun);
      if (along > 0 && beside < 2.97) {
        ++dark;
        EXPECT_EQ(frame.colour[n], (Rgb{25, 25, 25})) << x << " " << y;
      } else if (along < 0 || beside > 3.001) {
        EXPECT_EQ(frame.colour[n], (Rgb{100, 100, 100})) << x << " " << y;
      }
    }
  }
  EXPECT_GT(dark, 100);
  EXPECT_GE(drawn.shaded, dark);
  // Without light there is no shadow.
  r.settings.mode = core::Mode::kUnlit;
  frame = before;
  EXPECT_EQ(draw(scene, r, frame, &ground).shaded, 0);
}

TEST(Composer, ObjectsShadeEachOther) {
  core::DrawRequest r = request_at();
  r.settings.mode = core::Mode::kTextured;
  r.sun = glm::normalize(glm::dvec3(0.2, -1, 0));
  const auto box = model_of(make_box({4, 1, 4}));
  const auto roof = model_of(make_box({30, 1, 30}));
  core::Frame open = paper_frame(r);
  draw(Scene({box}, {instance_before(r, {0, -2, 10})}), r, open);
  core::Frame shaded = paper_frame(r);
  Instance behind = instance_before(r, {0, -12, -5});  // between the sun and the box, behind the camera
  behind.model = 1;
  draw(Scene({box, roof}, {instance_before(r, {0, -2, 10}), behind}), r, shaded);
  EXPECT_GT(open.colour[at(open, 100, 80)].g, 3 * shaded.colour[at(shaded, 100, 80)].g);
}

}  // namespace
}  // namespace objects
