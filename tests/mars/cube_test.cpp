#include "mars/geodesy/cube.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <glm/vec2.hpp>
#include <limits>
#include <set>
#include <tuple>
#include <vector>

#include "tests/mars/exact.h"
#include "tests/support/support.h"

namespace mars {
namespace {

using exact::Bound;
using exact::Real;
using exact::vec;

constexpr std::array<Face, 6> kAllFaces{Face::kPlusX,  Face::kPlusY, Face::kMinusX,
                                        Face::kMinusY, Face::kPlusZ, Face::kMinusZ};

using Bits = std::array<std::uint64_t, 3>;
Bits bits(const glm::dvec3& v) {
  return {std::bit_cast<std::uint64_t>(v.x), std::bit_cast<std::uint64_t>(v.y),
          std::bit_cast<std::uint64_t>(v.z)};
}

std::int64_t random_index(test_support::Random& random, int level) {
  const std::int64_t last = std::int64_t{1} << level;
  switch (random.integer(0, 4)) {
    case 0: return 0;
    case 1: return last;
    case 2: return last / 2;
    default: return std::uniform_int_distribution<std::int64_t>(0, last)(random.engine());
  }
}

// The warp at s in [0, 1], from the definition: knots rounded to 2^-20, even in between.
Real exact_warp(Real s) {
  const Real steps = s * kWarpKnots;
  const Real knot = std::min(std::floor(steps), static_cast<Real>(kWarpKnots - 1));
  const auto value = [](Real k) {
    return std::nearbyint(std::tan((2 * k / kWarpKnots - 1) * exact::kPi / 4) * 1048576) / 1048576;
  };
  return value(knot) + (value(knot + 1) - value(knot)) * (steps - knot);
}

TEST(Cube, AxesAreRightHandedAndFacesPartitionTheSphere) {
  std::set<std::tuple<double, double, double>> outs;
  for (const Face face : kAllFaces) {
    const FaceAxes& a = face_axes(face);
    EXPECT_EQ(glm::cross(a.right, a.up), a.out);
    EXPECT_EQ(glm::dot(a.right, a.up), 0);
    outs.insert({a.out.x, a.out.y, a.out.z});
  }
  EXPECT_EQ(outs.size(), 6U);
  for (const Face face : {Face::kPlusX, Face::kPlusY, Face::kMinusX, Face::kMinusY}) {
    EXPECT_EQ(face_axes(face).up, glm::dvec3(0, 0, 1));
  }
  EXPECT_EQ(face_axes(Face::kPlusZ).right, glm::dvec3(0, 1, 0));
  EXPECT_EQ(face_axes(Face::kMinusZ).right, glm::dvec3(0, 1, 0));
}

TEST(Cube, LinesAreTheWarpToTheBit) {
  test_support::Random random(1);
  for (int level = 0; level <= kMaxGridLevel; ++level) {
    const std::int64_t last = std::int64_t{1} << level;
    EXPECT_EQ(face_line(0, level), -1.0);
    EXPECT_EQ(face_line(last, level), 1.0);
    if (level > 0) {
      EXPECT_EQ(std::bit_cast<std::uint64_t>(face_line(last / 2, level)), 0U);
    }
    for (int n = 0; n < 300; ++n) {
      const std::int64_t i = random_index(random, level);
      const double u = face_line(i, level);
      const Real want = exact_warp(static_cast<Real>(i) / static_cast<Real>(last));
      ASSERT_EQ(static_cast<Real>(u), want) << i << " of 2^" << level;
      ASSERT_EQ(face_line(last - i, level), -u);
      // A multiple of 2^-50.
      ASSERT_EQ(std::ldexp(u, 50), std::nearbyint(std::ldexp(u, 50)));
      if (level < kMaxGridLevel) {
        ASSERT_EQ(face_line(2 * i, level + 1), u) << "posts nest";
      }
      if (i < last) {
        ASSERT_LT(u, face_line(i + 1, level));
      }
    }
  }
}

TEST(Cube, LinesAreEvenBetweenKnotsAndFollowTheTangentAtThem) {
  for (int level = 5; level <= 14; ++level) {
    const std::int64_t gap = std::int64_t{1} << (level - 5);
    for (std::int64_t i = 0; i + 1 < kWarpKnots * gap; ++i) {
      if (i % gap == gap - 1) continue;
      ASSERT_EQ(face_line(i + 2, level) - face_line(i + 1, level),
                face_line(i + 1, level) - face_line(i, level));
    }
  }
  for (int k = 0; k <= kWarpKnots; ++k) {
    EXPECT_NEAR(face_line(k, 5), std::tan((2.0 * k / kWarpKnots - 1) * kPi / 4), 0.5 / 1048576 + 1e-12);
  }
}

TEST(Cube, ParameterInvertsTheWarpWithinItsBound) {
  test_support::Random random(2);
  Bound bound("face_parameter");
  std::vector<double> places{
      0.0, -0.0, 1.0, -1.0, 5e-324, -5e-324, 1e-17, 0.999999999999999889, -0.999999999999999889};
  for (int k = 0; k <= kWarpKnots; ++k) {
    const double u = face_line(k, 5);
    EXPECT_EQ(face_parameter(u), k / 32.0);
    places.insert(places.end(), {std::nextafter(u, -1.0), std::nextafter(u, 1.0)});
  }
  for (int n = 0; n < 100000; ++n) places.push_back(random.uniform(-1, 1));
  double before = 0;
  std::sort(places.begin(), places.end());
  for (const double u : places) {
    const double s = face_parameter(u);
    ASSERT_GE(s, before) << "monotone";
    ASSERT_LE(s, 1.0);
    before = s;
    bound.add(std::abs(exact_warp(s) - u), kFaceParameterError);
  }
  EXPECT_EQ(face_parameter(1.5), 1.0);
  EXPECT_EQ(face_parameter(-1e300), 0.0);
  EXPECT_EQ(face_parameter(std::numeric_limits<double>::infinity()), 1.0);
}

// All faces on which a cube point lies, with its chart coordinates there, exact.
std::vector<ChartPoint> charts_of(const glm::dvec3& p) {
  std::vector<ChartPoint> charts;
  for (const Face face : kAllFaces) {
    const FaceAxes& a = face_axes(face);
    if (glm::dot(a.out, p) == 1.0) charts.push_back({face, glm::dot(a.right, p), glm::dot(a.up, p)});
  }
  return charts;
}

TEST(Cube, SharedPointsHaveEqualBitsFromEveryFaceAtEveryGridLevel) {
  test_support::Random random(3);
  int edges = 0;
  int corners = 0;
  for (int level = 0; level <= kMaxGridLevel; ++level) {
    const std::int64_t last = std::int64_t{1} << level;
    for (const Face face : kAllFaces) {
      for (int n = 0; n < 60; ++n) {
        const std::int64_t along = random_index(random, level);
        const double side = n % 2 == 0 ? 1.0 : -1.0;
        const double line = face_line(along, level);
        const glm::dvec2 uv = n % 4 < 2 ? glm::dvec2(side, line) : glm::dvec2(line, side);
        const glm::dvec3 p = cube_point(face, uv.x, uv.y);
        const std::vector<ChartPoint> charts = charts_of(p);
        ASSERT_EQ(charts.size(), along == 0 || along == last ? 3U : 2U);
        (charts.size() == 3 ? corners : edges) += 1;
        for (const ChartPoint& c : charts) {
          // The neighbour's own grid has a line exactly there: the same one counted from either end.
          const double other = std::abs(c.u) == 1.0 ? c.v : c.u;
          ASSERT_TRUE(other == face_line(along, level) || other == face_line(last - along, level));
          ASSERT_EQ(bits(cube_point(c.face, c.u, c.v)), bits(p));
          ASSERT_EQ(bits(chart_direction(c.face, c.u, c.v)), bits(chart_direction(face, uv.x, uv.y)));
          ASSERT_EQ(cube_length(cube_point(c.face, c.u, c.v)), cube_length(p));
        }
      }
    }
  }
  EXPECT_GT(edges, 5000);
  EXPECT_GT(corners, 3000);
}

TEST(Cube, InteriorPointsAreOnOneFace) {
  test_support::Random random(4);
  for (int n = 0; n < 1000; ++n) {
    const auto face = static_cast<Face>(random.integer(0, 5));
    const double u = random.uniform(-0.999, 0.999);
    const glm::dvec3 p = cube_point(face, u, random.uniform(-0.999, 0.999));
    ASSERT_EQ(charts_of(p).size(), 1U);
  }
}

TEST(Cube, ChartPointInvertsChartDirectionWithinItsBound) {
  test_support::Random random(5);
  Bound direction_bound("chart_direction");
  Bound round_trip("chart_point: angle");
  for (int n = 0; n < 100000; ++n) {
    const glm::dvec3 along = random.direction();
    const glm::dvec3 d = along * random.log_uniform(1e-290, 1e290);
    const ChartPoint c = chart_point(d);
    ASSERT_LE(std::abs(c.u), 1.0);
    ASSERT_LE(std::abs(c.v), 1.0);
    const int exponent = -std::ilogb(std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)}));
    const exact::Vec scaled{std::ldexp(static_cast<Real>(d.x), exponent),
                            std::ldexp(static_cast<Real>(d.y), exponent),
                            std::ldexp(static_cast<Real>(d.z), exponent)};
    const glm::dvec3 again = chart_direction(c.face, c.u, c.v);
    const exact::Vec point = vec(cube_point(c.face, c.u, c.v));
    direction_bound.add(exact::angle(vec(again), point), kChartDirectionError_rad);
    direction_bound.add(std::abs(exact::length(vec(again)) - 1), kChartDirectionError_rad);
    round_trip.add(exact::angle(point, scaled), kChartPointError_rad);
  }
}

TEST(Cube, ChartOfAFaceAlsoBeyondItsBorder) {
  const ChartPoint c = chart_on(Face::kPlusX, {1, 3, -2});
  EXPECT_EQ(c.u, 3.0);
  EXPECT_EQ(c.v, -2.0);
}

TEST(Cube, TiesGoToTheFirstFace) {
  const auto face_of = [](double x, double y, double z) { return chart_point({x, y, z}).face; };
  for (const double scale : {1.0, 1e300, 1e-300, 5e-324}) {
    EXPECT_EQ(face_of(scale, scale, scale), Face::kPlusX);
    EXPECT_EQ(face_of(scale, -scale, scale), Face::kPlusX);
    EXPECT_EQ(face_of(-scale, scale, -scale), Face::kPlusY);
    EXPECT_EQ(face_of(-scale, -scale, scale), Face::kMinusX);
    EXPECT_EQ(face_of(0, -scale, scale), Face::kMinusY);
    EXPECT_EQ(face_of(0, -scale, -scale), Face::kMinusY);
    EXPECT_EQ(face_of(0, 0, scale), Face::kPlusZ);
    EXPECT_EQ(face_of(-0.0, -0.0, -scale), Face::kMinusZ);
  }
  // Every grid point of an edge is found on the first face that has it.
  test_support::Random random(6);
  for (int n = 0; n < 3000; ++n) {
    const int level = random.integer(0, kMaxGridLevel);
    const auto face = static_cast<Face>(random.integer(0, 5));
    const glm::dvec3 p = cube_point(face, n % 2 == 0 ? 1 : -1, face_line(random_index(random, level), level));
    const ChartPoint first = charts_of(p).front();
    const ChartPoint c = chart_point(p);
    ASSERT_EQ(c.face, first.face);
    ASSERT_EQ(c.u, first.u);
    ASSERT_EQ(c.v, first.v);
  }
}

TEST(Cube, PolesAndMeridians) {
  const ChartPoint north = chart_point({0, 0, 1});
  EXPECT_EQ(north.face, Face::kPlusZ);
  EXPECT_EQ(north.u, 0.0);
  EXPECT_EQ(north.v, 0.0);
  EXPECT_EQ(chart_point(direction({180, 0})).face, Face::kMinusX);
  EXPECT_EQ(chart_point(direction({-90, 10})).face, Face::kMinusY);
  EXPECT_EQ(chart_point(direction({0, -46})).face, Face::kMinusZ);
  EXPECT_EQ(chart_point(direction({0, -44})).face, Face::kPlusX);
}

// The figures in the header: sides and areas of small cells relative to the mean, over a whole face. All four
// are extreme at the corners of knot blocks or on the lines through the face's middle, so block corners and
// a fine grid in each block show them.
TEST(Cube, CellSizesSpreadAsStated) {
  const double nominal_side = kPi / 2;
  const double nominal_area = 4 * kPi / 6;
  double side_min = 9, side_max = 0, area_min = 9, area_max = 0, aspect_max = 0, area_sum = 0;
  constexpr int kSteps = 8;
  const auto weight = [](int step) { return step == 0 || step == kSteps ? 0.5 : 1.0; };
  for (int a = 0; a < kWarpKnots; ++a) {
    for (int b = 0; b < kWarpKnots; ++b) {
      const double du = (face_line(a + 1, 5) - face_line(a, 5)) * kWarpKnots;
      const double dv = (face_line(b + 1, 5) - face_line(b, 5)) * kWarpKnots;
      for (int i = 0; i <= kSteps; ++i) {
        for (int j = 0; j <= kSteps; ++j) {
          const double u = face_line(a, 5) + du * i / (kSteps * kWarpKnots);
          const double v = face_line(b, 5) + dv * j / (kSteps * kWarpKnots);
          const double q = 1 + u * u + v * v;
          const double side_u = du * std::sqrt(1 + v * v) / q / nominal_side;
          const double side_v = dv * std::sqrt(1 + u * u) / q / nominal_side;
          const double area = du * dv / (q * std::sqrt(q)) / nominal_area;
          side_min = std::min({side_min, side_u, side_v});
          side_max = std::max({side_max, side_u, side_v});
          area_min = std::min(area_min, area);
          area_max = std::max(area_max, area);
          aspect_max = std::max({aspect_max, side_u / side_v, side_v / side_u});
          area_sum += area * weight(i) * weight(j);
        }
      }
    }
  }
  EXPECT_NEAR(side_min, kCellSideMin, 5e-4);
  EXPECT_NEAR(side_max, kCellSideMax, 5e-4);
  EXPECT_NEAR(area_min, kCellAreaMin, 5e-4);
  EXPECT_NEAR(area_max, kCellAreaMax, 5e-4);
  EXPECT_NEAR(aspect_max, kCellAspectMax, 5e-4);
  // The cells of a face cover a sixth of the sphere.
  EXPECT_NEAR(area_sum / (kWarpKnots * kWarpKnots * kSteps * kSteps), 1.0, 1e-3);
}

}  // namespace
}  // namespace mars
