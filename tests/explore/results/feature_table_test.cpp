// Tables of results as features: attributes of JSON, edges of great circles.
#include "vpe/explore/results/feature_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "mars/geodesy/sphere.h"
#include "vpe/explore/results/result_files.h"

namespace vpe::explore {
namespace {

using nlohmann::json;

mars::FieldValue value_of(const mars::FeatureLayer& layer, std::size_t feature, const std::string& field) {
  const auto found = std::ranges::find(layer.fields, field);
  EXPECT_NE(found, layer.fields.end()) << field;
  if (found == layer.fields.end()) return {};
  return layer.features.at(feature).values.at(static_cast<std::size_t>(found - layer.fields.begin()));
}

TEST(FeatureTable, JoinsNamesOfInnerObjectsAndNumbersThoseOfLists) {
  FeatureTable table("results");
  table.add("line",
            {{"length_m", 12.5},
             {"corners", 4},
             {"visible", true},
             {"plane", {{"dip_deg", 3.5}, {"error", {{"dip_deg", 0.25}}}}},
             {"steeper", {{{"limit_deg", 15}, {"share", 0.5}}, {{"limit_deg", 30}, {"share", 0.125}}}},
             {"sources", {"a", "b"}},
             {"none", nullptr},
             {"infinite", std::numeric_limits<double>::infinity()}},
            {point_shape({10, 20})});
  const mars::FeatureLayer layer = table.layer();
  ASSERT_EQ(layer.features.size(), 1U);
  EXPECT_EQ(layer.name, "results");
  EXPECT_EQ(layer.features[0].number, 1);
  EXPECT_EQ(layer.fields.front(), "part");
  EXPECT_EQ(value_of(layer, 0, "part"), mars::FieldValue("line"));
  EXPECT_EQ(value_of(layer, 0, "length_m"), mars::FieldValue(12.5));
  EXPECT_EQ(value_of(layer, 0, "corners"), mars::FieldValue(std::int64_t{4}));
  EXPECT_EQ(value_of(layer, 0, "visible"), mars::FieldValue(std::int64_t{1}));
  EXPECT_EQ(value_of(layer, 0, "plane_dip_deg"), mars::FieldValue(3.5));
  EXPECT_EQ(value_of(layer, 0, "plane_error_dip_deg"), mars::FieldValue(0.25));
  EXPECT_EQ(value_of(layer, 0, "steeper_2_share"), mars::FieldValue(0.125));
  EXPECT_EQ(value_of(layer, 0, "sources"), mars::FieldValue("a; b"));
  EXPECT_EQ(std::ranges::count(layer.fields, "none"), 0);
  EXPECT_EQ(std::ranges::count(layer.fields, "infinite"), 0);
}

TEST(FeatureTable, HasTheAttributesOfAllFeatures) {
  FeatureTable table("results");
  table.add("", {{"a", 1}}, {point_shape({0, 0})});
  table.add("", {{"b", "x,\"y\""}}, {point_shape({1, 0})});
  const mars::FeatureLayer layer = table.layer();
  EXPECT_EQ(layer.fields, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(value_of(layer, 0, "b"), mars::FieldValue());
  EXPECT_EQ(value_of(layer, 1, "a"), mars::FieldValue());
  EXPECT_EQ(csv_of_layer(layer), "a,b\n1,\n,\"x,\"\"y\"\"\"\n");
  EXPECT_TRUE(FeatureTable("empty").layer().features.empty());
}

TEST(FeatureTable, TextsThatAreNotUtf8CanBeWritten) {
  FeatureTable table("results");
  table.add("", {{"name", "\xff.tif"}}, {point_shape({0, 0})});
  EXPECT_EQ(value_of(table.layer(), 0, "name"), mars::FieldValue("\xef\xbf\xbd.tif"));
}

// Returns the largest distance of the middles of a ring's edges from the great circles through `places`, radians.
double off_rad(const std::vector<glm::dvec2>& ring, mars::LonLat a, mars::LonLat b) {
  const glm::dvec3 normal = glm::normalize(glm::cross(mars::direction(a), mars::direction(b)));
  double most = 0;
  for (std::size_t n = 1; n < ring.size(); ++n) {
    const glm::dvec2 middle = (ring[n - 1] + ring[n]) / 2.0;
    most = std::max(most, std::abs(std::asin(glm::dot(normal, mars::direction({middle.x, middle.y})))));
  }
  return most;
}

TEST(GreatCircleShapes, StayNearTheGreatCircles) {
  const std::vector<std::vector<mars::LonLat>> lines{{{0, 0}, {90, 0}},
                                                     {{10, 40}, {80, 50}},
                                                     {{-100, 60}, {100, 60}},
                                                     {{170, -30}, {-160, 20}},
                                                     {{5, 89}, {100, 85}}};
  for (const auto& places : lines) {
    const mars::Shape shape = great_circle_line(places);
    ASSERT_EQ(shape.rings.size(), 1U);
    const auto& ring = shape.rings[0];
    EXPECT_LE(off_rad(ring, places[0], places[1]), kStraightEdge_rad) << places[0].lon_deg;
    EXPECT_LT(mars::distance_rad({ring.back().x, ring.back().y}, places[1]), 1e-12);
    for (std::size_t n = 1; n < ring.size(); ++n) EXPECT_LE(std::abs(ring[n].x - ring[n - 1].x), 180);
  }
  // An edge along the equator or a meridian needs no more vertices.
  EXPECT_EQ(great_circle_line(lines[0]).rings[0].size(), 2U);
  EXPECT_EQ(great_circle_line(std::vector<mars::LonLat>{{7, -60}, {7, 60}}).rings[0].size(), 2U);
}

TEST(GreatCircleShapes, ALineOverThePoleEndsAtItsPlaces) {
  const mars::Shape shape = great_circle_line(std::vector<mars::LonLat>{{20, 80}, {-160, 80}});
  const auto& ring = shape.rings[0];
  EXPECT_EQ(ring.front(), glm::dvec2(20, 80));
  EXPECT_LT(mars::distance_rad({ring.back().x, ring.back().y}, {-160, 80}), 1e-12);
  const auto highest = std::ranges::max_element(ring, {}, [](const glm::dvec2& p) { return p.y; });
  EXPECT_GT(highest->y, 89.99);
}

TEST(GreatCircleShapes, AnOutlineIsClosed) {
  const std::vector<mars::LonLat> places{{179, 10}, {-179, 10}, {-179, 12}, {179, 12}};
  const mars::Shape shape = great_circle_polygon(places);
  EXPECT_EQ(shape.kind, mars::ShapeKind::polygon);
  const auto& ring = shape.rings[0];
  EXPECT_EQ(ring.front(), ring.back());
  const auto [west, east] = std::ranges::minmax_element(ring, {}, [](const glm::dvec2& p) { return p.x; });
  EXPECT_NEAR(east->x - west->x, 2, 1e-9);
}

}  // namespace
}  // namespace vpe::explore
