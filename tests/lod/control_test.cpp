// The three level control functions of Hitchner 1992, computed by hand.
#include "lod/control.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "tests/lod/control_fixture.h"

namespace {

using namespace control_fixture;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(ControlFunctions, ByDistanceFromTheCamera) {
  // A thousand kilometres over x, and three more.
  const ControlFunction f{1e6, 3, 1, {}};
  EXPECT_EQ(lod::levels(f, 1e5), 13.0);
  EXPECT_EQ(lod::levels(f, 4e5), 5.5);
  EXPECT_EQ(lod::levels(f, 1e7), 3.1);
  EXPECT_EQ(lod::levels(f, 0), kInfinity);
  EXPECT_EQ(lod::wanted_level_count(lod::levels(f, 1e5)), 13);
  EXPECT_EQ(lod::wanted_level_count(lod::levels(f, 4e5)), 5);  // (int) 5.5
  EXPECT_EQ(lod::wanted_level_count(lod::levels(f, 1e7)), 3);
  EXPECT_EQ(lod::wanted_level_count(kInfinity), lod::kMaxLevel + 1);
  EXPECT_EQ(lod::wanted_level_count(0.9), 1);  // nothing is coarser than the roots
  EXPECT_EQ(lod::wanted_level_count(-7), 1);
  // The scale changes the reach, the offset changes all levels.
  EXPECT_EQ(lod::levels({2e6, 3, 1, {}}, 4e5), 8.0);
  EXPECT_EQ(lod::levels({1e6, 4, 1, {}}, 4e5), 6.5);
  EXPECT_EQ(lod::levels({0, 4, 1, {}}, 0), 4.0);
  // A time budget doubles the distance.
  EXPECT_EQ(lod::levels({1e6, 3, 1, {}, 2}, 4e5), 4.25);
}

TEST(ControlFunctions, ByLookupTable) {
  const ControlFunction f{1e6, 3, 1, {{0, 12}, {1e4, 9}, {1e5, 6}, {1e6, 3.5}}};
  EXPECT_EQ(lod::levels(f, 0), 12.0);
  EXPECT_EQ(lod::levels(f, 9999.9), 12.0);
  EXPECT_EQ(lod::levels(f, 1e4), 9.0);
  EXPECT_EQ(lod::levels(f, 5e5), 6.0);
  EXPECT_EQ(lod::levels(f, 1e9), 3.5);
  EXPECT_EQ(lod::levels(f, kInfinity), 3.5);
  EXPECT_EQ(lod::levels({0, 0, 1, {{10, 2}, {20, 1}}}, 5), 2.0);  // the first row holds below its x
  EXPECT_EQ(lod::levels({0, 0, 1, {{10, 2}, {20, 1}}, 3}, 5), 2.0);
  EXPECT_EQ(lod::levels({0, 0, 1, {{10, 2}, {20, 1}}, 4}, 5), 1.0);
}

TEST(ControlFunctions, ByDistanceFromTheCentre) {
  // At 90 degrees, half the image's height is a tangent of 1.
  core::View view = view_at(0, 0, 1e5, 0, -90);
  view.fov_deg = 90;
  const lod::CentreOfView centre = lod::centre_of_view(view);
  EXPECT_EQ(lod::centre_distance(centre, 0), 0.0);
  EXPECT_NEAR(lod::centre_distance(centre, std::atan(0.5)), 0.5, 1e-15);
  EXPECT_NEAR(lod::centre_distance(centre, mars::kPi / 4), 1.0, 1e-15);  // the upper edge
  EXPECT_EQ(lod::centre_distance(centre, mars::kPi / 2), kInfinity);
  const ControlFunction f{0.25, -1, 1, {}};
  EXPECT_EQ(lod::levels(f, 0.05), 4.0);
  EXPECT_EQ(lod::levels(f, 0.25), 0.0);
  EXPECT_EQ(lod::levels(f, 1), -0.75);
  EXPECT_EQ(lod::levels(f, kInfinity), -1.0);
  // The same in an image of another size and field of view.
  view.fov_deg = 20;
  view.width = view.height = 99;
  EXPECT_NEAR(lod::centre_distance(lod::centre_of_view(view), 10 * mars::kRadiansPerDegree), 1.0, 1e-15);
  // Parts, and images that are shifted for stereo, have the centre of the whole image.
  view.part = {3, 4, 5, 6};
  view.principal_offset_px = {7, 8};
  EXPECT_EQ(lod::centre_of_view(view).forward, view.camera.axes.forward);
  view.projection = core::Projection::kEquirectangular;
  view.fov_deg = 180;
  EXPECT_NEAR(lod::centre_distance(lod::centre_of_view(view), mars::kPi / 4), 0.5, 1e-15);
}

TEST(ControlFunctions, ByInterest) {
  // A circle of 1000 km about the middle of +X, whose tiles of level 2 are 22.5 degrees or 1330 km wide.
  const lod::ControlRegion finer = lod::control_region({0, 0, 1e6, 2}, fake::kRadius_m);
  const lod::ControlRegion coarser = lod::control_region({0, 0, 1e6, -1}, fake::kRadius_m);
  const mars::ChartRect touched = lod::chart_rect({mars::Face::kPlusX, 2, 2, 2});
  const mars::ChartRect inside = lod::chart_rect({mars::Face::kPlusX, 4, 8, 8});
  const mars::ChartRect outside = lod::chart_rect({mars::Face::kPlusX, 2, 3, 3});
  const auto levels = [](std::vector<lod::ControlRegion> regions, const mars::ChartRect& rect) {
    return lod::interest_levels(regions, rect);
  };
  EXPECT_EQ(levels({finer}, touched), 2);
  EXPECT_EQ(levels({finer}, inside), 2);
  EXPECT_EQ(levels({finer}, outside), 0);
  EXPECT_EQ(levels({coarser}, touched), 0);  // a part of it is not to be coarser
  EXPECT_EQ(levels({coarser}, inside), -1);
  EXPECT_EQ(levels({finer, coarser, coarser}, inside), 0);  // they add up
  EXPECT_EQ(levels({finer, finer}, touched), 4);
  // A radius beyond the antipode is the whole planet; none is a point.
  EXPECT_EQ(levels({lod::control_region({10, 20, 1e8, -3}, fake::kRadius_m)}, outside), -3);
  EXPECT_EQ(levels({lod::control_region({0, 0, 0, 1}, fake::kRadius_m)}, inside), 1);
  EXPECT_EQ(levels({lod::control_region({0, 0, 0, 1}, fake::kRadius_m)}, outside), 0);
}

TEST(ControlFunctions, TheSumIsWeightedAndCutToAWholeNumberOnce) {
  // 400 km above the corner of a flat tile: the distance is 400 km. The view is horizontal, so the centre is
  // not at 0 and all three terms are finite.
  const TileTree ball = fake::tree(fake::uniform(5));
  SelectOptions options = by_distance({1e6, 3, 1, {}}, {0.25, -1, 2, {}});
  options.control.interest_weight = 0.5;
  options.control.regions = {lod::control_region({0, 0, 1e6, 3}, fake::kRadius_m)};
  core::View view = view_at(0, 0, 4e5, 0, 0);
  const lod::ControlTerms t = terms_of(options, ball, view, {mars::Face::kPlusX, 5, 16, 16});
  // Distance: the region's outer rim is at the mesh's error above the ground at the most.
  EXPECT_NEAR(t.distance.x, 4e5, 1);
  EXPECT_NEAR(t.distance.levels, 5.5, 1e-4);
  // Straight ahead is horizontal: the tile's nearest direction lies below it by some 67 degrees, that is
  // tan(67) / tan(30) = 4 halves of the height off.
  const double share = std::tan(t.centre_angle_rad) / std::tan(30 * mars::kRadiansPerDegree);
  EXPECT_EQ(t.centre.x, share);
  EXPECT_GT(t.centre_angle_rad, 1.1);
  EXPECT_LT(t.centre_angle_rad, 1.3);
  EXPECT_EQ(t.centre.levels, 0.25 / share - 1);
  EXPECT_EQ(t.interest.levels, 3.0);
  EXPECT_EQ(t.sum, t.distance.levels + 2 * t.centre.levels + 0.5 * 3);
  EXPECT_EQ(lod::wanted_level_count(t.sum), static_cast<int>(t.sum));
  // The metric kError counts the last two.
  options.control.metric = core::LodMetric::kError;
  EXPECT_EQ(terms_of(options, ball, view, {mars::Face::kPlusX, 5, 16, 16}).sum, 2 * t.centre.levels + 1.5);
}

// Compares with directions to dense samples of the volume: never more than the least of them, and not much
// less.
TEST(ControlFunctions, TheNearestPointToTheCentreIsFound) {
  Random random(61);
  int inside = 0;
  int aside = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const core::View view = random_view(random);
    const lod::CentreOfView centre = lod::centre_of_view(view);
    const int level = random.integer(0, 9);
    const double away = random.uniform(0, 1);
    const glm::dvec3 near =
        glm::normalize(view.camera.position_m / fake::kRadius_m + away * random.direction());
    const lod::TileKey key = lod::tile_at(mars::chart_point(near), level);
    const cull::BoundingRegion region{lod::chart_rect(key), fake::kRadius_m - random.uniform(0, 5000),
                                      fake::kRadius_m + 3000};
    const cull::BoundingHexahedron v = cull::bounding_hexahedron(region);
    const double angle = lod::least_angle_rad(centre, v);
    double least = kInfinity;
    double steps = 0;
    constexpr int kSteps = 60;
    glm::dvec3 last(0);
    for (int a = 0; a <= kSteps; ++a) {
      for (int b = 0; b <= kSteps; ++b) {
        for (int h = 0; h <= 4; ++h) {
          const double x = a / double{kSteps};
          const double y = b / double{kSteps};
          const auto at = [&](std::size_t k) {
            return (1 - y) * ((1 - x) * v.corners_m[k] + x * v.corners_m[k + 1]) +
                   y * ((1 - x) * v.corners_m[k + 2] + x * v.corners_m[k + 3]);
          };
          const glm::dvec3 d = (1 - h / 4.0) * at(0) + h / 4.0 * at(4) - centre.camera_m;
          least = std::min(least, mars::angle_between_rad(d, centre.forward));
          if (b > 0 && h == 4) steps = std::max(steps, mars::angle_between_rad(d, last));
          if (h == 4) last = d;
        }
      }
    }
    ASSERT_LE(angle, least + 1e-7) << trial;
    if (angle == 0.0) {
      ++inside;
    } else {
      ++aside;
      ASSERT_GE(angle, least - 2 * steps - 1e-7) << trial << " " << lod::to_string(key);
    }
  }
  EXPECT_GT(inside, 10);
  EXPECT_GT(aside, 100);
}

}  // namespace
