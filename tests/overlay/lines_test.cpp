// Tests of graticule and contours: positions of pixels, against rays cast independently.
#include <map>
#include <set>

#include "tests/overlay/ball.h"
#include "vpe/overlay/isolines.h"
#include "vpe/overlay/layer_functions.h"

namespace overlay_test {
namespace {

using vpe::overlay::Canvas;
using vpe::overlay::draw_contours;
using vpe::overlay::draw_graticule;
using vpe::overlay::Isoline;
using vpe::overlay::IsolineOptions;
using vpe::overlay::isolines;
using vpe::overlay::LabelLayout;
using vpe::overlay::VisibleTerrain;

// Draws the lines alone; labels are returned by draw_*().
template <class Draw>
Layer lines_of(const Sight& sight, const Draw& draw, std::vector<vpe::overlay::LineLabel>* labels = nullptr) {
  const Scene scene = sight.scene();
  const VisibleTerrain terrain(scene);
  Canvas canvas(sight.view.width, sight.view.height);
  LabelLayout layout(canvas);
  const auto all = draw(layout, terrain);
  if (labels != nullptr) *labels = all;
  return canvas.layer();
}

// Pixels from (x, y) to the nearest place where value(x, y) is a multiple of the step, to first order; NaN
// where lines are close enough to fade.
template <class Value>
double distance_px(double x, double y, double step, const Value& value) {
  constexpr double kApart = 0.05;
  const double here = value(x, y);
  const glm::dvec2 slope((value(x + kApart, y) - value(x - kApart, y)) / (2 * kApart),
                         (value(x, y + kApart) - value(x, y - kApart)) / (2 * kApart));
  if (step / glm::length(slope) < 8) return std::nan("");
  return std::abs(std::remainder(here, step)) / glm::length(slope);
}

template <class Value>
void expect_pixels_on_lines(const Layer& layer, double step, const std::vector<Value>& values, int border,
                            double reach_px) {
  int on = 0;
  int off = 0;
  for (int y = border; y < layer.height - border; ++y) {
    for (int x = border; x < layer.width - border; ++x) {
      double nearest = 1e9;
      bool fades = false;
      for (const Value& value : values) {
        const double distance = distance_px(x + 0.5, y + 0.5, step, value);
        fades = fades || std::isnan(distance);
        nearest = std::min(nearest, distance);
      }
      if (fades) continue;
      const int alpha = at(layer, x, y).a;
      if (nearest < 0.4) {
        EXPECT_GT(alpha, 120) << x << " " << y << " is " << nearest << " px from a line";
        ++on;
      } else if (nearest > reach_px) {
        EXPECT_EQ(alpha, 0) << x << " " << y << " is " << nearest << " px from a line";
        ++off;
      }
    }
  }
  EXPECT_GT(on, 200);
  EXPECT_GT(off, 2000);
}

TEST(Graticule, PixelsLieWithinAPixelOfTheLines) {
  for (const mars::Pose& pose :
       {mars::Pose{-70, -13, 9e5, 30, -70, 10}, mars::Pose{179.5, 40, 4e5, 0, -90, 0}}) {
    const Sight sight({}, view_at(pose, 200, 120));
    const Layer layer = lines_of(sight, [](LabelLayout& layout, const VisibleTerrain& terrain) {
      return draw_graticule(layout, terrain, 2);
    });
    const auto place = [&](double x, double y) {
      const glm::dvec3 ray = vpe::core::pixel_ray(sight.view, x, y);
      const double range_m = sight.ball.cast(sight.view.camera.position_m, ray);
      if (std::isinf(range_m)) return mars::LonLat{std::nan(""), std::nan("")};
      return mars::lon_lat(sight.view.camera.position_m + ray * range_m);
    };
    using Value = std::function<double(double, double)>;
    const std::vector<Value> values{
        [&](double x, double y) { return mars::normalize_lon_deg(place(x, y).lon_deg - 180) + 180; },
        [&](double x, double y) { return place(x, y).lat_deg; }};
    // Half of the widest halo.
    expect_pixels_on_lines(layer, 2, values, 2, 2.6);
  }
}

TEST(Contours, PixelsLieWithinAPixelOfTheirElevation) {
  for (const double exaggeration : {1.0, 2.5}) {
    const Ball ball{{20, 10}, 20000, 0.08, exaggeration};
    const Sight sight(ball, view_at({20, 9, 6e5, 0, -80, 0}, 200, 150));
    const Layer layer = lines_of(sight, [](LabelLayout& layout, const VisibleTerrain& terrain) {
      return draw_contours(layout, terrain, 5000);
    });
    const auto elevation = [&](double x, double y) {
      const glm::dvec3 ray = vpe::core::pixel_ray(sight.view, x, y);
      const glm::dvec3 p = sight.view.camera.position_m + ray * ball.cast(sight.view.camera.position_m, ray);
      const double h = (glm::length(p) - kRadius_m) / exaggeration;
      // Neither the flat ground nor the kinks at top and foot have contours that can be checked so.
      return h > 300 && h < 19700 ? h : std::nan("");
    };
    using Value = std::function<double(double, double)>;
    expect_pixels_on_lines(layer, 5000, std::vector<Value>{elevation}, 2, 3.2);
  }
}

// The image shows another ball, whose slopes are wrong by a pixel here and there.
TEST(Contours, AreThoseOfFinerRangesWhereTheImageShowsTheSameGround) {
  const Ball truth{{20, 10}, 20000, 0.08, 1};
  Ball coarse = truth;
  coarse.cone_m = 20900;
  const View view = view_at({20, 9, 6e5, 0, -80, 0}, 200, 150);
  const Sight image(coarse, view);
  const Sight exact(truth, view);
  Overlays contours;
  contours.contours = true;
  contours.contour_m = 3000;
  Scene scene = image.scene();
  scene.shift_px = 1;
  const Layer before = vpe::overlay::draw(contours, scene);
  const std::vector<float> finer = truth.range(view);
  scene.contours = {finer, 0};
  const Layer after = vpe::overlay::draw(contours, scene);
  EXPECT_EQ(after.pixels, exact.draw(contours).pixels);
  EXPECT_NE(before.pixels, after.pixels);
  scene.contours->range_m = std::span(finer).subspan(1);
  EXPECT_THROW(vpe::overlay::draw(contours, scene), std::invalid_argument);
}

// The finer ground has a hill that the image does not show: no line lies on it.
TEST(Contours, OfFinerRangesEndAtTheSilhouettesOfTheImage) {
  const View view = view_at({20, 8.6, 3000, 0, 0, 0}, 160, 120);
  const Sight flat({}, view);
  const Ball hill{{20, 10}, 9000, 0.02, 1};
  Overlays contours;
  contours.contours = true;
  contours.contour_m = 1000;
  const std::vector<float> finer = hill.range(view);
  Scene scene = flat.scene();
  scene.shift_px = 1;
  scene.contours = {finer, 0};
  const vpe::overlay::VisibleTerrain image(scene);
  const std::vector<float> shown = vpe::overlay::ranges_of_same_ground(image, *scene.contours);
  std::size_t hidden = 0;
  for (std::size_t n = 0; n < shown.size(); ++n) {
    const bool has_hill = std::isfinite(finer[n]) && !std::isfinite(scene.range_m[n]);
    hidden += has_hill && std::isinf(shown[n]) ? 1U : 0U;
  }
  EXPECT_GT(hidden, 300U);
  EXPECT_EQ(painted(vpe::overlay::draw(contours, scene)), 0U);
  // Where the image shows it, lines are drawn.
  Scene same = scene;
  same.range_m = finer;
  EXPECT_GT(painted(vpe::overlay::draw(contours, same)), 100U);
}

TEST(Contours, EveryFifthIsHeavierAndLabelledWithItsElevation) {
  const Ball ball{{20, 10}, 20000, 0.08, 1};
  const Sight sight(ball, view_at({20, 10, 5e5, 0, -90, 0}, 640, 480));
  std::vector<vpe::overlay::LineLabel> labels;
  const Layer layer = lines_of(
      sight,
      [](LabelLayout& layout, const VisibleTerrain& terrain) { return draw_contours(layout, terrain, 1000); },
      &labels);
  std::set<std::string> texts;
  for (const auto& label : labels) {
    texts.insert(label.text);
    const glm::dvec3 ray = vpe::core::pixel_ray(sight.view, label.at.x, label.at.y);
    const glm::dvec3 p = sight.view.camera.position_m + ray * ball.cast(sight.view.camera.position_m, ray);
    EXPECT_NEAR(glm::length(p) - kRadius_m, std::stod(label.text), 60);
    EXPECT_LE(std::abs(label.angle_rad), 0.5 * mars::kPi + 1e-9);  // never upside down
  }
  EXPECT_EQ(texts, (std::set<std::string>{"5000 m", "10000 m", "15000 m"}));
  // Along the row through the top, from left to right: opaque pixels of each line met, fifths are wider.
  std::map<int, double> weight;
  const int y = layer.height / 2;
  for (int x = 0; x < layer.width / 2; ++x) {
    const glm::dvec3 ray = vpe::core::pixel_ray(sight.view, x + 0.5, y + 0.5);
    const glm::dvec3 p = sight.view.camera.position_m + ray * ball.cast(sight.view.camera.position_m, ray);
    const double h = glm::length(p) - kRadius_m;
    if (h > 500) weight[static_cast<int>(std::lround(h / 1000))] += at(layer, x, y).a;
  }
  for (const int k : {4, 6, 9, 11, 14, 16})
    EXPECT_GT(weight[k - k % 5 + (k % 5 > 2 ? 5 : 0)], 1.15 * weight[k]) << k;
}

// Multiples of the step, each with the number of its lines.
std::map<std::int64_t, int> census(const VisibleTerrain& terrain, const std::vector<double>& values,
                                   double step, double period) {
  IsolineOptions options;
  options.step = step;
  options.period = period;
  std::map<std::int64_t, int> count;
  for (const Isoline& line : isolines(terrain, values, options)) ++count[line.multiple];
  return count;
}

TEST(Isolines, RunUnbrokenOverTheAntimeridian) {
  const Sight sight({}, view_at({180, 0, 6e5, 0, -90, 0}));
  const Scene scene = sight.scene();
  const VisibleTerrain terrain(scene);
  const auto count = census(terrain, terrain.longitudes_deg(), 2, 360);
  ASSERT_TRUE(count.contains(90));
  EXPECT_FALSE(count.contains(-90));  // the same line
  EXPECT_TRUE(count.contains(89));
  EXPECT_TRUE(count.contains(-89));
  // Farther out the image's border cuts them.
  for (const auto& [multiple, lines] : count) EXPECT_TRUE(lines == 1 || std::abs(multiple) < 86) << multiple;
  // A step that does not divide the full circle: multiples count from 0 on both sides, none beyond 180.
  for (const auto& [multiple, lines] : census(terrain, terrain.longitudes_deg(), 7, 360)) {
    EXPECT_LE(std::abs(multiple), 25) << multiple;
  }
}

TEST(Isolines, CloseRoundThePoles) {
  for (const double lat : {90.0, -90.0}) {
    const Sight sight({}, view_at({0, lat, 4e5, 0, -90, 0}, 240, 240));
    const Scene scene = sight.scene();
    const VisibleTerrain terrain(scene);
    IsolineOptions options;
    options.step = 1;
    int closed = 0;
    for (const Isoline& line : isolines(terrain, terrain.latitudes_deg(), options)) {
      EXPECT_EQ(line.multiple < 0, lat < 0);
      closed += line.closed ? 1 : 0;
      if (!line.closed) continue;
      for (const glm::dvec2& p : line.points) {
        const glm::dvec3 ray = vpe::core::pixel_ray(sight.view, p.x, p.y);
        const glm::dvec3 ground_m =
            sight.view.camera.position_m + ray * sight.ball.cast(sight.view.camera.position_m, ray);
        // The grid's pixels are 0.03 degrees; straight between them.
        EXPECT_NEAR(mars::lon_lat(ground_m).lat_deg, static_cast<double>(line.multiple), 2e-3);
      }
    }
    EXPECT_GE(closed, 2);
    const auto count = census(terrain, terrain.longitudes_deg(), 30, 360);
    EXPECT_EQ(count.size(), 12U);
    for (const auto& [multiple, lines] : count) EXPECT_EQ(lines, 1) << multiple;
  }
}

TEST(VisibleTerrain, PointsAreThoseOfTheViewsRays) {
  View view = view_at({20, 9, 3e4, 10, -60, 33}, 300, 200);
  view.principal_offset_px = {17, -9};
  view.part = {40, 30, 200, 120};
  const Sight sight({}, view);
  const Scene scene = sight.scene();
  const VisibleTerrain terrain(scene);
  for (const glm::ivec2 p : {glm::ivec2{0, 0}, {199, 0}, {0, 119}, {120, 60}}) {
    const glm::dvec3 ray = vpe::core::pixel_ray(view, 40 + p.x + 0.5, 30 + p.y + 0.5);
    const glm::dvec3 wanted =
        view.camera.position_m + ray * static_cast<double>(sight.range_m[terrain.index(p.x, p.y)]);
    EXPECT_LT(glm::length(terrain.point(p.x, p.y) - wanted), 1e-6);
    EXPECT_LT(glm::length(terrain.to_image(wanted).value() - glm::dvec2(p) - 0.5), 1e-6);
  }
}

TEST(Isolines, EndAtEdgesWhereNearGroundHidesFarGround) {
  // A cone seen from the side, low above the plain: its edge cuts the plain behind it.
  const Ball ball{{0, 1.5}, 25000, 0.01, 1};
  const Sight sight(ball, view_at({0, 0, 40000, 0, -25, 0}));
  const Scene scene = sight.scene();
  const VisibleTerrain terrain(scene);
  int edges = 0;
  int whole = 0;
  for (int y = 0; y + 1 < terrain.height(); ++y) {
    for (int x = 0; x + 1 < terrain.width(); ++x) {
      if (!terrain.is_ground(terrain.index(x, y)) || !terrain.is_ground(terrain.index(x, y + 1))) continue;
      const double jump = glm::length(terrain.point(x, y) - terrain.point(x, y + 1));
      const float r = sight.range_m[terrain.index(x, y)];
      const bool cone_to_plain =
          (ball.height_m(terrain.point(x, y)) > 0) != (ball.height_m(terrain.point(x, y + 1)) > 0);
      if (cone_to_plain && jump > 0.25 * static_cast<double>(r)) {
        EXPECT_FALSE(terrain.is_whole(x, y)) << x << " " << y;
        ++edges;
      } else if (terrain.is_whole(x, y)) {
        ++whole;
      }
    }
  }
  EXPECT_GT(edges, 10);
  EXPECT_GT(whole, 10000);
  IsolineOptions options;
  options.step = 0.5;
  options.densest_px = 0;
  for (const Isoline& line : isolines(terrain, terrain.latitudes_deg(), options)) {
    for (std::size_t n = 1; n < line.points.size(); ++n) {
      EXPECT_LT(glm::length(line.points[n] - line.points[n - 1]), 1.5);
    }
  }
}

TEST(Isolines, APlainIsWholeUpToItsHorizon) {
  const Sight sight({}, view_at({0, 0, 2000, 40, 0, 0}));
  const Scene scene = sight.scene();
  const VisibleTerrain terrain(scene);
  int cells = 0;
  int whole = 0;
  for (int y = 0; y + 1 < terrain.height(); ++y) {
    for (int x = 2; x + 3 < terrain.width(); ++x) {
      bool all = true;
      for (int j = -1; j < 3; ++j)
        all = all && y + j >= 0 && y + j < terrain.height() && terrain.is_ground(terrain.index(x, y + j));
      cells += all ? 1 : 0;
      whole += all && terrain.is_whole(x, y) ? 1 : 0;
    }
  }
  EXPECT_GT(cells, 20000);
  EXPECT_EQ(whole, cells);
}

TEST(Isolines, FlatGroundHasNoContours) {
  // All of it is at 0 m, a multiple of every step, but for rounding.
  const Sight sight({}, view_at({0, 0, 3e5, 0, -60, 0}));
  EXPECT_EQ(
      painted(lines_of(sight, [](LabelLayout& s, const VisibleTerrain& g) { return draw_contours(s, g, 0); })),
      0U);
  EXPECT_EQ(
      painted(lines_of(sight, [](LabelLayout& s, const VisibleTerrain& g) { return draw_contours(s, g, 10); })),
      0U);
}

TEST(Contours, FadeWhereTheDrawnGroundIsTooFarOff) {
  const Ball ball{{20, 10}, 20000, 0.08, 1};
  const Sight sight(ball, view_at({20, 9, 6e5, 0, -80, 0}, 200, 150));
  const auto with = [&](double shift_px, double step_m) {
    Scene scene = sight.scene();
    scene.shift_px = shift_px;
    const VisibleTerrain terrain(scene);
    Canvas canvas(sight.view.width, sight.view.height);
    LabelLayout layout(canvas);
    draw_contours(layout, terrain, step_m);
    return painted(canvas.layer());
  };
  // A pixel is about 4500 m there.
  const std::size_t all = with(0, 2000);
  EXPECT_GT(all, 1000U);
  EXPECT_EQ(with(0.1, 2000), all);
  EXPECT_LT(with(1, 2000), all / 2);  // the heavy ones alone, of 10 km
  EXPECT_GT(with(1, 2000), 100U);
  EXPECT_EQ(with(5, 2000), 0U);
  EXPECT_LT(with(0.5, 0), with(0, 0));  // automatic steps are larger then
  EXPECT_GT(with(0.5, 0), 100U);
}

TEST(Graticule, AutomaticStepsPutSomeLinesIntoAnyImage) {
  for (const mars::Pose& pose : {mars::Pose{10, 20, 2e7, 0, -90, 0}, mars::Pose{10, 20, 1e6, 0, -90, 0},
                                 mars::Pose{10, 20, 1e4, 0, -90, 0}, mars::Pose{10, 20, 300, 0, -90, 0},
                                 mars::Pose{10, 20, 5e4, 70, -20, 0}, mars::Pose{180, 0, 1e5, 0, -50, 0},
                                 mars::Pose{0, 90, 1e5, 0, -90, 0}}) {
    const Sight sight({}, view_at(pose));
    std::vector<vpe::overlay::LineLabel> labels;
    lines_of(
        sight, [](LabelLayout& s, const VisibleTerrain& g) { return draw_graticule(s, g, 0); }, &labels);
    std::set<std::string> meridians;
    std::set<std::string> parallels;
    for (const auto& label : labels) {
      const char last = label.text.back();
      (last == 'N' || last == 'S' ? parallels : meridians).insert(label.text);
    }
    EXPECT_GE(meridians.size() + parallels.size(), 5U) << pose.alt_m;
    EXPECT_LE(meridians.size(), 14U) << pose.alt_m;
    EXPECT_LE(parallels.size(), 14U) << pose.alt_m;
  }
}

TEST(Graticule, AbsurdStepsDrawNothingAndEndSoon) {
  const Sight sight({}, view_at({10, 20, 1e6, 0, -60, 0}));
  for (const double step : {1e-300, 1e-12, 1e-6}) {
    EXPECT_EQ(painted(lines_of(
                  sight, [&](LabelLayout& s, const VisibleTerrain& g) { return draw_graticule(s, g, step); })),
              0U);
    const Sight cone(Ball{{10, 22}, 9000, 0.05, 1}, sight.view);
    EXPECT_EQ(painted(lines_of(
                  cone, [&](LabelLayout& s, const VisibleTerrain& g) { return draw_contours(s, g, step); })),
              0U);
  }
}

}  // namespace
}  // namespace overlay_test
