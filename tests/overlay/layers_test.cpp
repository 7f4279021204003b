// Vector features on the ground of images.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <memory>

#include "tests/overlay/ball.h"
#include "tests/support/support.h"
#include "vpe/overlay/draped_lines.h"
#include "vpe/overlay/filled_areas.h"
#include "vpe/overlay/ground_features.h"

namespace overlay_test {
namespace {

using mars::AreaIndex;
using mars::Shape;
using mars::ShapeKind;
using vpe::overlay::DrapedRun;
using vpe::overlay::GroundFeatures;
using vpe::overlay::VisibleTerrain;

using Ring = std::vector<glm::dvec2>;

mars::FeatureLayer layer_of(std::vector<Shape> shapes,
                            std::vector<std::pair<std::string, std::string>> attributes = {}) {
  mars::FeatureLayer layer;
  layer.name = "test";
  mars::Feature feature;
  feature.number = 1;
  feature.shapes = std::move(shapes);
  for (auto& [name, value] : attributes) {
    layer.fields.push_back(name);
    feature.values.emplace_back(value);
  }
  layer.features = {feature};
  return layer;
}

std::shared_ptr<const GroundFeatures> features_of(
    std::vector<Shape> shapes, std::vector<std::pair<std::string, std::string>> attributes = {}) {
  return std::make_shared<const GroundFeatures>(layer_of(std::move(shapes), std::move(attributes)),
                                                mars::FeatureStyle{});
}

Shape line(Ring places) { return {ShapeKind::line, {std::move(places)}}; }
Shape polygon(std::vector<Ring> rings) {
  for (Ring& ring : rings) ring.push_back(ring.front());
  return {ShapeKind::polygon, std::move(rings)};
}

// Whether a place is inside by a ray to the east, for rings that go around no pole.
bool inside_by_rows(const Shape& shape, glm::dvec2 p) {
  bool inside = false;
  for (const Ring& ring : shape.rings) {
    for (std::size_t i = 1; i < ring.size(); ++i) {
      const glm::dvec2 a = ring[i - 1];
      const glm::dvec2 b = ring[i];
      if ((a.y <= p.y) == (b.y <= p.y)) continue;
      if (a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y) > p.x) inside = !inside;
    }
  }
  return inside;
}

RC_GTEST_PROP(AreaIndex, AgreesWithRaysAlongRows, ()) {
  const auto coordinate = [](double scale) { return *rc::gen::inRange(-1'000'000, 1'000'000) / 1e6 * scale; };
  std::vector<Ring> rings(static_cast<std::size_t>(*rc::gen::inRange(1, 4)));
  const double west = coordinate(180);
  for (Ring& ring : rings) {
    const int count = *rc::gen::inRange(3, 60);
    for (int i = 0; i < count; ++i) ring.emplace_back(west + coordinate(40), coordinate(80));
  }
  const Shape shape = polygon(rings);
  const AreaIndex index(shape);
  for (int k = 0; k < 50; ++k) {
    const glm::dvec2 p(west + coordinate(45), coordinate(85));
    RC_ASSERT(index.contains(p) == inside_by_rows(shape, p));
    // The same place a turn away.
    RC_ASSERT(index.contains(p + glm::dvec2(360, 0)) == index.contains(p));
    RC_ASSERT(index.contains(p - glm::dvec2(720, 0)) == index.contains(p));
  }
}

TEST(AreaIndex, KnowsRingsAroundPoles) {
  const Shape north{ShapeKind::polygon, {{{-180, 70}, {-90, 75}, {0, 70}, {90, 65}, {180, 70}}}};
  const AreaIndex cap(north);
  EXPECT_TRUE(cap.contains({12, 89.9}));
  EXPECT_TRUE(cap.contains({-179.9, 71}));
  EXPECT_FALSE(cap.contains({90, 64}));
  EXPECT_FALSE(cap.contains({0, 0}));
  const Shape south{ShapeKind::polygon, {{{0, -60}, {120, -65}, {240, -60}, {360, -60}}}};
  const AreaIndex ice(south);
  EXPECT_TRUE(ice.contains({77, -89}));
  EXPECT_TRUE(ice.contains({-10, -61}));
  EXPECT_FALSE(ice.contains({-10, -59}));
  // A hole about the pole itself.
  const Shape collar{ShapeKind::polygon, {{{-180, 70}, {0, 70}, {180, 70}}, {{-180, 80}, {0, 80}, {180, 80}}}};
  const AreaIndex band(collar);
  EXPECT_TRUE(band.contains({33, 75}));
  EXPECT_FALSE(band.contains({33, 85}));
  EXPECT_FALSE(band.contains({33, 65}));
}

TEST(GroundFeatures, PiecesHoldTheirEdges) {
  test_support::Random random(51);
  for (int k = 0; k < 40; ++k) {
    Ring ring;
    glm::dvec2 p(random.uniform(-180, 180), random.uniform(-80, 80));
    for (int i = 0; i < 200; ++i) {
      ring.push_back(p);
      p += glm::dvec2(random.uniform(-5, 5), random.uniform(-5, 5));
      p.y = std::clamp(p.y, -89.0, 89.0);
    }
    const auto features = features_of({line(ring)});
    std::size_t edges = 0;
    for (const GroundFeatures::Piece& piece : features->pieces()) {
      edges += piece.places.size() - 1;
      for (std::size_t i = 1; i < piece.places.size(); ++i) {
        for (int n = 0; n <= 8; ++n) {
          const glm::dvec2 q = piece.places[i - 1] + (piece.places[i] - piece.places[i - 1]) * (n / 8.0);
          ASSERT_LE(mars::angle_between_rad(mars::direction({q.x, q.y}), piece.centre),
                    piece.radius_rad + 1e-12);
        }
      }
    }
    EXPECT_EQ(edges, 199U);
    EXPECT_TRUE(features->pieces().front().begins);
    EXPECT_FALSE(features->pieces().back().begins);
  }
}

TEST(GroundFeatures, StylesAndLabelsAreThoseOfTheFile) {
  const auto features =
      features_of({polygon({{{0, 0}, {1, 0}, {1, 1}}}), {ShapeKind::point, {{{3, 4}}}}},
                  {{"stroke", "#ff0000"}, {"stroke-width", "5"}, {"fill", "#00ff00"}, {"title", "Here"}});
  EXPECT_EQ(features->areas().size(), 1U);
  EXPECT_EQ(features->points().size(), 1U);
  EXPECT_EQ(features->pieces().size(), 1U);
  EXPECT_EQ(features->style(0).width.value, 5);
  EXPECT_EQ(features->style(0).stroke->rgb.r, 255);
  EXPECT_TRUE(features->has_labels());
  EXPECT_EQ(features->label(0), "Here");
  EXPECT_GT(features->bytes(), sizeof(GroundFeatures));
  EXPECT_EQ(features->layer().features.size(), 1U);
  EXPECT_THROW(features_of({line({{0, 0}, {1, 1}})}, {{"stroke", "loud"}}), std::runtime_error);
}

// A scene with ground that is asked for.
struct Ground {
  Sight sight;
  Scene scene;

  Ground(const Ball& ball, const View& view) : sight(ball, view), scene(sight.scene()) {
    scene.ground_m = [this](const glm::dvec3& d) { return sight.ball.height_m(d); };
  }
};

double distance_to(const std::vector<DrapedRun>& runs, glm::dvec2 p, bool hidden) {
  double nearest = 1e9;
  for (const DrapedRun& run : runs) {
    if (run.is_hidden != hidden) continue;
    for (std::size_t i = 1; i < run.points_px.size(); ++i) {
      const glm::dvec2 a = run.points_px[i - 1];
      const glm::dvec2 d = run.points_px[i] - a;
      const double length2 = glm::dot(d, d);
      const double t = length2 > 0 ? std::clamp(glm::dot(p - a, d) / length2, 0.0, 1.0) : 0.0;
      nearest = std::min(nearest, glm::length(p - a - d * t));
    }
  }
  return nearest;
}

// Whether a ray from the camera reaches a place on the ground, less a small share.
bool reaches(const Ground& ground, const glm::dvec3& point_m, double share) {
  const glm::dvec3 along = point_m - ground.scene.view.camera.position_m;
  return ground.sight.ball.cast(ground.scene.view.camera.position_m, glm::normalize(along)) >
         (1 - share) * glm::length(along);
}

// Compares the runs of a line with dense places on it. Returns how many of them were seen.
int check_line(const Ground& ground, const Ring& places) {
  const auto features = features_of({line(places)});
  const VisibleTerrain terrain(ground.scene);
  std::vector<DrapedRun> runs;
  drape_lines(*features, terrain, [&](const DrapedRun& run) { runs.push_back(run); });
  int seen = 0;
  constexpr int kDense = 3000;
  for (std::size_t i = 1; i < places.size(); ++i) {
    for (int n = 0; n <= kDense; ++n) {
      const glm::dvec2 q = places[i - 1] + (places[i] - places[i - 1]) * (static_cast<double>(n) / kDense);
      const glm::dvec3 up = mars::direction({q.x, q.y});
      const glm::dvec3 point_m =
          up * (kRadius_m + ground.sight.ball.height_m(up) * ground.sight.ball.exaggeration);
      const auto at = terrain.to_image(point_m);
      if (!at || at->x < 1 || at->y < 1 || at->x > terrain.width() - 1 || at->y > terrain.height() - 1)
        continue;
      if (reaches(ground, point_m, 1e-5)) {
        ++seen;
        EXPECT_LT(std::min(distance_to(runs, *at, false), distance_to(runs, *at, true)), 1.0);
      } else if (!reaches(ground, point_m, 0.01)) {
        // Well hidden: farther behind than what the neighbouring pixels show may be seen.
        const double gap = distance_to(runs, *at, true);
        EXPECT_LT(std::min(gap, distance_to(runs, *at, false)), 1.0);
      }
      if (testing::Test::HasFailure()) return seen;
    }
  }
  return seen;
}

TEST(DrapedLines, LieOnTheGroundWithinAPixelInManyViews) {
  test_support::Random random(52);
  int seen = 0;
  for (int k = 0; k < 200; ++k) {
    const Ball ball{{random.uniform(-3, 3), random.uniform(-3, 3)}, 8000, 0.03, k % 4 == 0 ? 2.0 : 1.0};
    const double alt_m = random.log_uniform(20e3, 3e6);
    const mars::Pose pose{random.uniform(-4, 4),
                          random.uniform(-4, 4),
                          alt_m,
                          random.uniform(-180, 180),
                          random.uniform(-90, alt_m > 2e5 ? -50 : -10),
                          random.uniform(-180, 180)};
    const Ground ground(ball, view_at(pose, 96, 54));
    Ring places;
    for (int i = 0; i < 4; ++i) places.emplace_back(random.uniform(-6, 6), random.uniform(-6, 6));
    seen += check_line(ground, places);
    if (HasFailure()) {
      ADD_FAILURE() << "view " << k;
      return;
    }
  }
  EXPECT_GT(seen, 20'000);
}

TEST(DrapedLines, AHillHidesWhatIsBehindIt) {
  // From the west over a cone at 0, 0: the line along its eastern side is hidden, that on its western one is seen.
  const Ball ball{{0, 0}, 8000, 0.02, 1};
  const Ground ground(ball, view_at({-3, 0, 6000, 90, -2, 0}, 320, 180, 40));
  const VisibleTerrain terrain(ground.scene);
  const auto runs_of = [&](double lon_deg) {
    std::vector<DrapedRun> runs;
    drape_lines(*features_of({line({{lon_deg, -0.2}, {lon_deg, 0.2}})}), terrain,
                [&](const DrapedRun& run) { runs.push_back(run); });
    return runs;
  };
  const auto west = runs_of(-0.3);
  ASSERT_FALSE(west.empty());
  EXPECT_TRUE(std::ranges::none_of(west, &DrapedRun::is_hidden));
  const auto east = runs_of(0.3);
  ASSERT_FALSE(east.empty());
  EXPECT_TRUE(std::ranges::all_of(east, &DrapedRun::is_hidden));
  EXPECT_FALSE(drape(terrain, {-0.3, 0})->is_hidden);
  EXPECT_TRUE(drape(terrain, {0.3, 0})->is_hidden);
  EXPECT_FALSE(drape(terrain, {-170, 0}).has_value() && !drape(terrain, {-170, 0})->is_hidden);
}

TEST(FilledAreas, HaveThePixelsWhosePlacesAreInside) {
  const Ground ground({}, view_at({0, 0, 2e5, 0, -90, 0}));
  const VisibleTerrain terrain(ground.scene);
  const Shape shape =
      polygon({{{-1, -0.7}, {1.2, -0.5}, {0.9, 0.8}, {-0.4, 0.3}}, {{-0.2, -0.2}, {0.3, -0.1}, {0.2, 0.2}}});
  const auto features = features_of({shape}, {{"fill", "#102030"}, {"fill-opacity", "1"}});
  const auto places = shown_places(terrain);
  const Layer layer = fill_areas(*features, terrain, places, 0.5);
  ASSERT_EQ(layer.pixels.size(), places.lon_deg.size());
  int full = 0;
  int partial = 0;
  for (std::size_t i = 0; i < layer.pixels.size(); ++i) {
    const bool inside = inside_by_rows(shape, {places.lon_deg[i], places.lat_deg[i]});
    const vpe::core::Rgba& p = layer.pixels[i];
    if (p.a == 128) {
      ++full;
      EXPECT_EQ(p.r, 16);
      EXPECT_EQ(p.b, 48);
    } else if (p.a > 0) {
      ++partial;
    }
    if (inside) {
      EXPECT_GT(p.a, 0);
    }
    if (!inside) {
      EXPECT_LT(p.a, 128);
    }
  }
  EXPECT_GT(full, 1000);
  EXPECT_GT(partial, 50);
  EXPECT_LT(partial, full / 4);
  // Nothing of it is in sight.
  const auto away = features_of({polygon({{{100, 0}, {110, 0}, {105, 10}}})}, {{"fill", "#ffffff"}});
  EXPECT_TRUE(fill_areas(*away, terrain, places, 1).pixels.empty());
}

TEST(FilledAreas, CrossTheAntimeridian) {
  const Ground ground({}, view_at({180, 10, 2e5, 0, -90, 0}));
  const VisibleTerrain terrain(ground.scene);
  const auto places = shown_places(terrain);
  for (const double turn : {0.0, -360.0}) {
    const auto features =
        features_of({polygon({{{179 + turn, 9.5}, {181 + turn, 9.5}, {181 + turn, 10.5}, {179 + turn, 10.5}}})},
                    {{"fill", "#ff0000"}, {"fill-opacity", "1"}});
    const Layer layer = fill_areas(*features, terrain, places, 1);
    ASSERT_FALSE(layer.pixels.empty());
    EXPECT_EQ(at(layer, 160, 90).a, 255);
    EXPECT_EQ(at(layer, 150, 90).a, 255);
    EXPECT_EQ(at(layer, 2, 2).a, 0);
  }
}

TEST(Layers, AreDrawnInTheirOrderWithTheirOpacity) {
  Ground ground({}, view_at({0, 0, 2e5, 0, -90, 0}));
  const auto square = [](const char* colour) {
    return features_of({polygon({{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}})},
                       {{"fill", colour}, {"fill-opacity", "1"}, {"stroke-opacity", "0"}});
  };
  Overlays overlays;
  overlays.layers = "a;b";
  ground.scene.layers = {{square("#ff0000"), 1}, {square("#0000ff"), 0.5}};
  const Layer layer = vpe::overlay::draw(overlays, ground.scene);
  EXPECT_NEAR(at(layer, 160, 90).r, 128, 2);
  EXPECT_NEAR(at(layer, 160, 90).b, 127, 2);
  EXPECT_EQ(at(layer, 160, 90).a, 255);
}

TEST(Layers, HiddenLinesAreLeftOutOrDashed) {
  const Ball ball{{0, 0}, 8000, 0.02, 1};
  Ground ground(ball, view_at({-3, 0, 6000, 90, -2, 0}, 320, 180, 40));
  Overlays overlays;
  overlays.layers = "a";
  ground.scene.layers = {{features_of({line({{0.3, -0.2}, {0.3, 0.2}})}), 1}};
  EXPECT_EQ(painted(vpe::overlay::draw(overlays, ground.scene)), 0U);
  overlays.hidden_lines = vpe::core::HiddenLines::kDashed;
  EXPECT_GT(painted(vpe::overlay::draw(overlays, ground.scene)), 0U);
}

TEST(Layers, PointsHaveMarkersAndLabels) {
  Ground ground({}, view_at({0, 0, 2e5, 0, -90, 0}));
  Overlays overlays;
  overlays.layers = "a";
  ground.scene.layers = {
      {features_of({{ShapeKind::point, {{{0, 0}}}}}, {{"marker-color", "#00ff00"}, {"marker-size", "40"}}), 1}};
  const Layer plain = vpe::overlay::draw(overlays, ground.scene);
  EXPECT_EQ(at(plain, 160, 90).g, 255);
  EXPECT_EQ(at(plain, 160, 90).r, 0);
  ground.scene.layers = {
      {features_of({{ShapeKind::point, {{{0, 0}}}}},
                   {{"marker-color", "#00ff00"}, {"marker-size", "40"}, {"title", "Landing"}}),
       1}};
  EXPECT_GT(painted(vpe::overlay::draw(overlays, ground.scene)), painted(plain) + 120);
}

TEST(SolarTime, IsWrittenWhereItIsKnown) {
  Ground ground({}, view_at({0, 0, 2e5, 0, -90, 0}));
  Overlays overlays;
  overlays.time_code = vpe::core::TimeCode::kSolar;
  EXPECT_TRUE(vpe::overlay::any(overlays));
  EXPECT_EQ(painted(vpe::overlay::draw(overlays, ground.scene)), 0U);
  ground.scene.solar = {14.5, 90.1};
  EXPECT_GT(painted(vpe::overlay::draw(overlays, ground.scene)), 100U);
}

}  // namespace
}  // namespace overlay_test
