// Tests picking of features against brute force, and by hand at poles and the antimeridian.
#include "vpe/explore/layers/feature_pick.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "vpe/core/view.h"
#include "vpe/explore/layers/pick_query.h"

namespace vpe::explore {
namespace {

using mars::Feature;
using mars::FeatureLayer;
using mars::Shape;
using mars::ShapeKind;

Shape point(double lon, double lat) { return {ShapeKind::point, {{{lon, lat}}}}; }
Shape line(std::vector<glm::dvec2> places) { return {ShapeKind::line, {std::move(places)}}; }
Shape box(glm::dvec2 low, glm::dvec2 high) {
  return {ShapeKind::polygon, {{low, {high.x, low.y}, high, {low.x, high.y}, low}}};
}
FeatureLayer layer_of(std::vector<Shape> shapes) {
  FeatureLayer layer;
  layer.name = "layer";
  for (Shape& shape : shapes) {
    Feature feature;
    feature.number = static_cast<std::int64_t>(layer.features.size());
    feature.shapes.push_back(std::move(shape));
    layer.features.push_back(std::move(feature));
  }
  return layer;
}
std::vector<PickedFeature> pick(const std::vector<FeatureLayer>& layers, const PickQuery& query) {
  std::vector<const FeatureLayer*> pointers;
  for (const FeatureLayer& layer : layers) pointers.push_back(&layer);
  return pick_features(pointers, query);
}
std::vector<std::uint32_t> numbers(const std::vector<PickedFeature>& picked) {
  std::vector<std::uint32_t> all;
  for (const PickedFeature& one : picked) all.push_back(one.feature);
  return all;
}

TEST(PickFeatures, TheTopmostComesFirst) {
  const MapView map{{0, 0}, 0.1, 400, 200};
  const FeatureLayer low = layer_of({box({-5, -5}, {5, 5}), box({-6, -6}, {6, 6}),
                                     line({{-10, 0.2}, {10, 0.2}}), point(0.1, 0), point(0.3, 0), point(9, 9)});
  const FeatureLayer high = layer_of({box({-1, -1}, {20, 20})});
  const auto picked = pick({low, high}, query_on_map(map, {0, 0}, 6));
  ASSERT_EQ(picked.size(), 6U);
  EXPECT_EQ(picked[0].layer, 1U);
  EXPECT_EQ(picked[0].kind, ShapeKind::polygon);
  // Points, the nearest first, then the line, then the areas, the last drawn first.
  EXPECT_EQ(numbers(picked), (std::vector<std::uint32_t>{0, 3, 4, 2, 1, 0}));
  EXPECT_NEAR(picked[1].distance_px, 1, 1e-9);
  EXPECT_NEAR(picked[3].distance_px, 2, 1e-9);
  EXPECT_EQ(picked[5].distance_px, 0);
}

TEST(PickFeatures, AnOutlineIsALineAndAHoleIsOutside) {
  const MapView map{{0, 0}, 0.1, 400, 200};
  Shape ring = box({-5, -5}, {5, 5});
  ring.rings.push_back(box({-2, -2}, {2, 2}).rings[0]);
  const std::vector<FeatureLayer> layers{layer_of({ring})};
  EXPECT_TRUE(pick(layers, query_on_map(map, {0, 0}, 6)).empty());
  EXPECT_EQ(pick(layers, query_on_map(map, {3.5, 0}, 6)).at(0).kind, ShapeKind::polygon);
  EXPECT_EQ(pick(layers, query_on_map(map, {5.3, 0}, 6)).at(0).kind, ShapeKind::line);
  EXPECT_TRUE(pick(layers, query_on_map(map, {5.7, 0}, 6)).empty());
  PickQuery query = query_on_map(map, {3.5, 0}, 6);
  query.is_on_ground = false;
  EXPECT_TRUE(pick(layers, query).empty());
}

TEST(PickFeatures, PolesAndTheAntimeridianAreNoEdges) {
  const MapView map{{180, 0}, 0.1, 400, 200};
  const std::vector<FeatureLayer> across{layer_of({box({170, -5}, {190, 5}), line({{-181, -3}, {-179, 3}})})};
  for (const double lon : {-175.0, 175.0, 185.0, -185.0})
    EXPECT_EQ(numbers(pick(across, query_on_map(map, {lon, 0}, 6))), std::vector<std::uint32_t>{0}) << lon;
  EXPECT_EQ(numbers(pick(across, query_on_map(map, {180, 0}, 6))), (std::vector<std::uint32_t>{1, 0}));
  // A ring around the north pole, seen from above it.
  const std::vector<FeatureLayer> cap{
      layer_of({{ShapeKind::polygon, {{{0, 80}, {90, 80}, {180, 80}, {270, 80}, {360, 80}}}}, point(123, 90)})};
  core::View view;
  view.width = 200;
  view.height = 200;
  view.camera = mars::to_camera({45, 89.999, 500'000, 0, -90, 0}, 1e6);
  const TerrainQuery ground = ball(1e6);
  const auto query = query_in_view(ground, view, {100, 100}, 6);
  ASSERT_TRUE(query);
  EXPECT_EQ(numbers(pick(cap, *query)), (std::vector<std::uint32_t>{1, 0}));
}

// Compares with distances of places that are dense on all lines, in a view of a sphere.
RC_GTEST_PROP(PickFeatures, AgreeWithBruteForce, ()) {
  const double radius_m = 3e6;
  const TerrainQuery ground = ball(radius_m);
  const auto number = [](int low, int high) { return *rc::gen::inRange(low, high) / 1000.0; };
  core::View view;
  view.width = 320;
  view.height = 240;
  const mars::Pose pose{number(-180'000, 180'000), number(-89'000, 89'000),  number(20'000, 400'000) * 1000,
                        number(0, 360'000),        number(-90'000, -10'000), number(-30'000, 30'000)};
  view.camera = mars::to_camera(pose, radius_m);
  const double spread = 0.003 * std::sqrt(pose.alt_m);
  std::vector<Shape> shapes;
  for (int n = 0; n < 12; ++n) {
    const auto place = [&] {
      return glm::dvec2(pose.lon_deg + spread * number(-1000, 1000) /
                                           std::max(0.02, std::cos(pose.lat_deg * mars::kRadiansPerDegree)),
                        std::clamp(pose.lat_deg + spread * number(-1000, 1000), -89.9, 89.9));
    };
    if (n % 2 == 0)
      shapes.push_back({ShapeKind::point, {{place()}}});
    else
      shapes.push_back(line({place(), place()}));
  }
  const FeatureLayer layer = layer_of(shapes);
  const glm::dvec2 xy{number(0, 320'000), number(0, 240'000)};
  const double reach_px = 12;
  const auto query = query_in_view(ground, view, xy, reach_px);
  std::vector<double> found(shapes.size(), 1e9);
  if (query)
    for (const PickedFeature& one : pick({layer}, *query)) found[one.feature] = one.distance_px;
  for (std::size_t n = 0; n < shapes.size(); ++n) {
    const auto& ring = shapes[n].rings[0];
    double least_px = 1e9;
    double step_px = 0;
    glm::dvec2 before(0, 0);
    bool has_before = false;
    constexpr int kSteps = 1000;
    for (int k = 0; k <= (ring.size() > 1 ? kSteps : 0); ++k) {
      const glm::dvec2 place = ring[0] + (ring.back() - ring[0]) * (static_cast<double>(k) / kSteps);
      const glm::dvec3 at_m = radius_m * mars::direction({place.x, place.y});
      const core::Projected shown = core::project(view, at_m);
      // Seen: on this side of the horizon by two pixels or so.
      const bool is_seen = !shown.behind && glm::dot(view.camera.position_m - at_m, at_m) > 0;
      if (!is_seen) {
        has_before = false;
        continue;
      }
      const double d = glm::length(shown.xy - xy);
      if (d < reach_px + 2 && has_before) step_px = std::max(step_px, glm::length(shown.xy - before));
      least_px = std::min(least_px, d);
      before = shown.xy;
      has_before = true;
    }
    const double margin_px = 0.05 + step_px;
    if (least_px < reach_px - margin_px)
      RC_ASSERT(std::abs(found[n] - least_px) < margin_px);
    else if (least_px > reach_px + margin_px)
      RC_ASSERT(found[n] == 1e9 ||
                found[n] > reach_px - 2.5);  // a place behind the horizon by less than the lift
  }
}

TEST(PickFeatures, WhatIsHiddenIsNotFound) {
  const MapView map{{0, 0}, 0.1, 400, 200};
  const std::vector<FeatureLayer> layers{layer_of({point(0, 0), line({{-1, 0.1}, {1, 0.1}})})};
  PickQuery query = query_on_map(map, {0, 0}, 6);
  query.is_seen = [](glm::dvec2 place) { return place.y != 0; };
  EXPECT_EQ(numbers(pick(layers, query)), std::vector<std::uint32_t>{1});
  query.position = [](glm::dvec2) { return std::nullopt; };
  EXPECT_TRUE(pick(layers, query).empty());
}

TEST(PickFeatures, OverTheSkyThereIsNothing) {
  core::View view;
  view.camera = mars::to_camera({0, 0, 1000, 0, 60, 0}, 1e6);
  EXPECT_FALSE(query_in_view(ball(1e6), view, {view.width / 2.0, view.height / 2.0}, 6));
  EXPECT_TRUE(pick_features({}, PickQuery{}).empty());
}

TEST(FieldTexts, ValuesAreTexts) {
  EXPECT_EQ(field_text(std::monostate()), "");
  EXPECT_EQ(field_text(std::int64_t{-7}), "-7");
  EXPECT_EQ(field_text(2.5), "2.5");
  EXPECT_EQ(field_text(std::string("Noachian")), "Noachian");
  FeatureLayer layer;
  layer.fields = {"unit", "age", "note"};
  Feature feature;
  feature.values = {std::string("mNh"), 3.7};
  EXPECT_EQ(field_texts(layer, feature),
            (std::vector<std::pair<std::string, std::string>>{{"unit", "mNh"}, {"age", "3.7"}, {"note", ""}}));
}

}  // namespace
}  // namespace vpe::explore
