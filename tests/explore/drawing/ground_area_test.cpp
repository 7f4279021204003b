// Tests of areas on the reference surface: a sphere, a plane and a spiral ramp, whose areas are known.
#include "vpe/explore/drawing/ground_area.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lod/tree/posts.h"
#include "tests/explore/terrain_fixture.h"
#include "vpe/explore/drawing/drawing_measures.h"
#include "vpe/explore/drawing/facet_walk.h"
#include "vpe/explore/drawing/sphere_polygon.h"

namespace vpe::explore {
namespace {

constexpr double kRadius_m = mars::kMarsRadius_m;
const mars::LonLat kMiddle{-35, 20};  // of test_support::kPatch

class SphereAreas : public test_support::GroundTest<test_support::SmoothGround> {};
class PlaneAreas : public test_support::GroundTest<test_support::PlaneGround> {};
class BumpyAreas : public test_support::GroundTest<test_support::BumpyGround> {};

std::vector<mars::LonLat> ring(mars::LonLat centre, double radius_rad, int corners, double from_deg = 10) {
  std::vector<mars::LonLat> places;
  for (int n = 0; n < corners; ++n)
    places.push_back(mars::destination(centre, from_deg + 360.0 * n / corners, radius_rad));
  return places;
}

// Facets are a little below the sphere and tilted against it: together by less than the square of the angle
// between posts. Many facets are smaller than the sphere.
TEST_F(SphereAreas, AreThoseOfTheSphere) {
  test_support::Random random(41);
  for (int n = 0; n < 60; ++n) {
    const mars::LonLat centre = n == 0   ? mars::LonLat{0, 90}
                                : n == 1 ? mars::LonLat{180, 0}
                                : n < 12 ? kMiddle
                                         : mars::lon_lat(random.direction());
    const double reach_rad = n < 12 ? random.log_uniform(1e-3, 0.02) : random.log_uniform(0.02, 1.3);
    const std::vector<glm::dvec3> polygon = directions_of(ring(centre, reach_rad, random.integer(3, 40)));
    const auto area = ground_area(surface(), polygon);
    ASSERT_TRUE(area);
    EXPECT_TRUE(area->is_exact);
    const double sphere_m2 = std::abs(signed_sphere_area(polygon)) * kRadius_m * kRadius_m;
    const double spacing_rad = 100000.0 / kRadius_m;
    EXPECT_LT(area->area_m2, sphere_m2 * (1 + spacing_rad * spacing_rad / 4)) << n;
    if (reach_rad > 0.5) {
      EXPECT_LT(area->area_m2, sphere_m2) << n;
    }
    EXPECT_GT(area->area_m2, sphere_m2 * (1 - spacing_rad * spacing_rad)) << n;
  }
}

TEST_F(SphereAreas, LargePolygonsAndTheirOutsidesAddUp) {
  const auto of = [](const std::vector<mars::LonLat>& places) {
    return ground_area(surface(), directions_of(places))->area_m2;
  };
  // Two halves of the planet, cut by a jagged outline.
  std::vector<mars::LonLat> jagged;
  for (int n = 0; n < 24; ++n) jagged.push_back({15.0 * n - 170, n % 2 == 0 ? 12.0 : -10.0});
  class Sum : public FacetVisitor {
   public:
    void block(const paging::SurfaceTile&, int i0, int i1, int j0, int j1, int winding) override {
      cells += winding * (i1 - i0) * (j1 - j0);
    }
    void part(const paging::SurfaceTile&, int, int, std::span<const glm::dvec3>) override { ADD_FAILURE(); }
    int cells = 0;
  } all;
  ASSERT_TRUE(walk_all_facets(surface(), surface().planet().meta().finest_level, all, {}));
  EXPECT_GT(all.cells, 6 * 32 * 32);
  const double north_m2 = of(jagged);
  // The same outline in parts that are each smaller than half of the planet.
  double parts_m2 = 0;
  for (int n = 0; n < 24; ++n) {
    const mars::LonLat& a = jagged[static_cast<std::size_t>(n)];
    const mars::LonLat& b = jagged[static_cast<std::size_t>((n + 1) % 24)];
    parts_m2 += of({a, b, {0, 90}});
  }
  const double whole_m2 = 4 * mars::kPi * kRadius_m * kRadius_m;
  const double smaller_m2 = std::min(parts_m2, whole_m2 - parts_m2);
  EXPECT_NEAR(north_m2, smaller_m2, whole_m2 * 1e-3);
  std::reverse(jagged.begin(), jagged.end());
  EXPECT_NEAR(of(jagged), north_m2, north_m2 * 1e-12);
}

// All facets of a plane lie in it, so the area is that of the polygon of the points above its vertices.
TEST_F(PlaneAreas, AreThoseOfThePlane) {
  test_support::Random random(42);
  double worst = 0;
  for (int n = 0; n < 40; ++n) {
    const mars::LonLat centre = mars::destination(kMiddle, random.uniform(0, 360), random.uniform(0, 0.006));
    std::vector<mars::LonLat> places;
    const int corners = random.integer(3, 30);
    for (int k = 0; k < corners; ++k)
      places.push_back(mars::destination(centre, 360.0 * k / corners, random.uniform(0.001, 0.008)));
    if (n % 2 == 0) std::reverse(places.begin(), places.end());
    const std::vector<glm::dvec3> polygon = directions_of(places);
    glm::dvec3 twice_m2{0, 0, 0};
    const auto on_plane = [](const glm::dvec3& d) {
      return d * (test_support::PlaneGround::offset_m() / glm::dot(test_support::PlaneGround::normal(), d));
    };
    for (std::size_t k = 2; k < polygon.size(); ++k)
      twice_m2 += glm::cross(on_plane(polygon[k - 1]) - on_plane(polygon[0]),
                             on_plane(polygon[k]) - on_plane(polygon[0]));
    const double expected_m2 = glm::length(twice_m2) / 2;
    const auto area = ground_area(surface(), polygon);
    ASSERT_TRUE(area);
    // Heights are stored in steps, which move the outline along the plane and roughen it.
    const double step_m = surface().planet().meta().quantum_m;
    const double outline_m = outline_length_rad(polygon) * kRadius_m;
    EXPECT_NEAR(area->area_m2, expected_m2, 0.5 * step_m * outline_m * std::sin(20 * mars::kRadiansPerDegree))
        << n;
    EXPECT_NEAR(area->area_m2, expected_m2, expected_m2 * 1e-5) << n;
    worst = std::max(worst, std::abs(area->area_m2 - expected_m2) / expected_m2);
    const double sphere_m2 = std::abs(signed_sphere_area(polygon)) * kRadius_m * kRadius_m;
    EXPECT_GT(area->area_m2, 1.04 * sphere_m2);  // 1 / cos(20 degrees) = 1.064
  }
  EXPECT_GT(worst, 0);
}

// Parts of a polygon have its area together, however it is cut.
TEST_F(BumpyAreas, PartsAddUp) {
  const auto of = [](const std::vector<glm::dvec3>& polygon) {
    const auto area = ground_area(surface(), polygon);
    EXPECT_TRUE(area && area->is_exact);
    return area->area_m2;
  };
  test_support::Random random(43);
  for (int n = 0; n < 12; ++n) {
    const double reach_rad = random.log_uniform(0.002, 0.3);
    const std::vector<glm::dvec3> polygon = directions_of(ring(kMiddle, reach_rad, 12));
    const double whole_m2 = of(polygon);
    const glm::dvec3 inside =
        mars::direction(mars::destination(kMiddle, 77, reach_rad * random.uniform(0, 0.8)));
    double parts_m2 = 0;
    for (std::size_t k = 0; k < polygon.size(); ++k)
      parts_m2 += of({polygon[k], polygon[(k + 1) % polygon.size()], inside});
    EXPECT_NEAR(parts_m2, whole_m2, whole_m2 * 1e-11) << reach_rad;
    EXPECT_GT(whole_m2, std::abs(signed_sphere_area(polygon)) * kRadius_m * kRadius_m * 0.99);
  }
}

// A brute-force oracle: the mean of 1 / cos(slope) times the squared radius, over many directions.
TEST_F(BumpyAreas, AgreesWithSampledSlopes) {
  const std::vector<glm::dvec3> polygon = directions_of(ring(kMiddle, 0.2, 4));
  const double exact_m2 = ground_area(surface(), polygon)->area_m2;
  test_support::Random random(44);
  double sum = 0;
  int inside = 0;
  const double cap = 2 * mars::kPi * (1 - std::cos(0.2));
  constexpr int kSamples = 200'000;
  const glm::dvec3 middle = mars::direction(kMiddle);
  for (int n = 0; n < kSamples; ++n) {
    const double z = random.uniform(std::cos(0.2), 1);
    const glm::dvec3 east = mars::any_perpendicular(middle);
    const glm::dvec3 north = glm::cross(middle, east);
    const double angle = random.uniform(0, 2 * mars::kPi);
    const double r = std::sqrt(1 - z * z);
    const glm::dvec3 d = middle * z + east * (r * std::cos(angle)) + north * (r * std::sin(angle));
    bool is_inside = true;
    for (std::size_t k = 0; k < polygon.size(); ++k)
      is_inside = is_inside && glm::dot(glm::cross(polygon[k], polygon[(k + 1) % polygon.size()]), d) < 0;
    if (!is_inside) continue;
    ++inside;
    const paging::SurfacePoint point = surface().at(d);
    sum += point.radius_m * point.radius_m / glm::dot(point.normal, d);
  }
  ASSERT_GT(inside, kSamples / 3);
  EXPECT_NEAR(sum / kSamples * cap, exact_m2, exact_m2 * 0.005);
}

TEST_F(BumpyAreas, LargePolygonsAreMeasuredOnCoarserPosts) {
  const std::vector<glm::dvec3> polygon = directions_of(ring(kMiddle, 0.02, 6));
  const auto exact = ground_area(surface(), polygon);
  const auto coarse = ground_area(surface(), polygon, {.most_cells = 2000, .progress = {}});
  ASSERT_TRUE(exact && coarse);
  EXPECT_TRUE(exact->is_exact);
  EXPECT_EQ(exact->coarser_area_m2, exact->area_m2);
  EXPECT_FALSE(coarse->is_exact);
  EXPECT_GT(coarse->spacing_m, 1.9 * exact->spacing_m);
  EXPECT_NE(coarse->coarser_area_m2, coarse->area_m2);
  EXPECT_NEAR(coarse->area_m2, exact->area_m2, exact->area_m2 * 0.01);
}

TEST_F(BumpyAreas, StopAndTellHowFarTheyAre) {
  const std::vector<glm::dvec3> polygon = directions_of(ring(kMiddle, 1.0, 6));
  std::stop_source stop;
  std::vector<double> shares;
  GroundAreaOptions options;
  options.progress = [&](double share) { shares.push_back(share); };
  ASSERT_TRUE(ground_area(surface(), polygon, options, stop.get_token()));
  EXPECT_GT(shares.size(), 10U);
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_GT(shares.back(), 0.9);
  EXPECT_LE(shares.back(), 1);
  options.progress = [&](double share) {
    if (share > 0.3) stop.request_stop();
  };
  EXPECT_FALSE(ground_area(surface(), polygon, options, stop.get_token()));
  EXPECT_FALSE(ground_area(surface(), polygon, {}, stop.get_token()));
}

TEST_F(BumpyAreas, MeasuresOfDrawings) {
  Drawing drawing;
  drawing.kind = DrawingKind::kPoint;
  drawing.vertices = {kMiddle};
  EXPECT_EQ(sphere_measures(drawing, kRadius_m).length_m, 0);
  const auto at = ground_measures(surface(), drawing);
  ASSERT_TRUE(at);
  EXPECT_EQ(at->lowest_m, surface().at(test_support::kPatch).height_m);
  EXPECT_EQ(at->lowest_m, at->highest_m);
  drawing.kind = DrawingKind::kLine;
  drawing.vertices = {{-36, 19}, {-35, 20}, {-33, 24}};
  const double line_m = sphere_measures(drawing, kRadius_m).length_m;
  EXPECT_NEAR(line_m,
              (mars::distance_rad({-36, 19}, {-35, 20}) + mars::distance_rad({-35, 20}, {-33, 24})) * kRadius_m,
              1e-6);
  const auto line = ground_measures(surface(), drawing);
  ASSERT_TRUE(line);
  EXPECT_GT(line->length_m, line_m * 0.99);
  EXPECT_LT(line->lowest_m, line->highest_m);
  EXPECT_FALSE(line->area);
  drawing.kind = DrawingKind::kPolygon;
  const SphereMeasures flat = sphere_measures(drawing, kRadius_m);
  EXPECT_GT(flat.length_m, line_m);
  ASSERT_TRUE(flat.area_m2);
  const auto ground = ground_measures(surface(), drawing);
  ASSERT_TRUE(ground && ground->area);
  EXPECT_NEAR(ground->area->area_m2, *flat.area_m2, *flat.area_m2 * 0.1);
  ASSERT_TRUE(ground->statistics);
  EXPECT_NEAR(ground->statistics->sphere_area_m2, *flat.area_m2, 1e-6 * *flat.area_m2);
  std::vector<double> shares;
  GroundAreaOptions options;
  options.progress = [&](double share) { shares.push_back(share); };
  ASSERT_TRUE(ground_measures(surface(), drawing, options));
  EXPECT_TRUE(std::ranges::is_sorted(shares));
  drawing.vertices = {{0, 0}, {80, 0}, {40, 60}};
  const auto large = ground_measures(surface(), drawing);
  ASSERT_TRUE(large && large->area);
  EXPECT_FALSE(large->statistics);
  drawing.vertices = {{0, 0}, {1, 1}, {1, 0}, {0, 1}};
  const SphereMeasures crossed = sphere_measures(drawing, kRadius_m);
  EXPECT_FALSE(crossed.area_m2);
  EXPECT_EQ(crossed.no_area, "the outline crosses itself: edges 1 and 3");
  EXPECT_FALSE(ground_measures(surface(), drawing)->area);
  std::stop_source stop;
  stop.request_stop();
  EXPECT_FALSE(ground_measures(surface(), drawing, {}, stop.get_token()));
}

TEST(MeasuredVolumeText, HasFiveDigits) {
  EXPECT_EQ(measured_volume_text(0), "0 m³");
  EXPECT_EQ(measured_volume_text(1234.5678), "1234.6 m³");
  EXPECT_EQ(measured_volume_text(12345678901), "12.346 km³");
}

TEST(MeasuredAreaText, HasFiveDigits) {
  EXPECT_EQ(measured_area_text(0.4212345), "0.42123 m²");
  EXPECT_EQ(measured_area_text(9500), "9500 m²");
  EXPECT_EQ(measured_area_text(12345678), "12.346 km²");
}

}  // namespace
}  // namespace vpe::explore
