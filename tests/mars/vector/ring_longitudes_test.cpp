#include "mars/vector/ring_longitudes.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>

namespace {

using mars::RingPole;
using mars::Shape;
using mars::ShapeKind;

using Ring = std::vector<glm::dvec2>;

Ring unwrapped(ShapeKind kind, const Ring& ring) {
  Shape shape{kind, {ring}};
  mars::unwrap_longitudes(shape);
  return shape.rings[0];
}

double extent(const Ring& ring) {
  const auto [low, high] = std::ranges::minmax_element(ring, {}, &glm::dvec2::x);
  return high->x - low->x;
}

TEST(RingLongitudes, LinesOverTheAntimeridian) {
  EXPECT_EQ(unwrapped(ShapeKind::line, {{179, 1}, {-179, 2}, {-178, 3}}), (Ring{{179, 1}, {181, 2}, {182, 3}}));
  EXPECT_EQ(unwrapped(ShapeKind::line, {{350, 1}, {10, 2}}), (Ring{{-10, 1}, {10, 2}}));
  EXPECT_EQ(unwrapped(ShapeKind::line, {{181, 1}, {179, 2}}), (Ring{{-179, 1}, {-181, 2}}));
  EXPECT_EQ(unwrapped(ShapeKind::point, {{190, 1}}), (Ring{{-170, 1}}));
}

TEST(RingLongitudes, KeepsBits) {
  const Ring ring{{-180, 0.1}, {0, 0.3}, {180, 0.7}, {1e-300, 90}, {-180, 0.1}};
  EXPECT_EQ(unwrapped(ShapeKind::polygon, ring), ring);
}

TEST(RingLongitudes, ClosesRings) {
  EXPECT_EQ(unwrapped(ShapeKind::polygon, {{0, 0}, {1, 0}, {1, 1}}), (Ring{{0, 0}, {1, 0}, {1, 1}, {0, 0}}));
  // The same place in another turn is not repeated.
  const Ring around = unwrapped(ShapeKind::polygon, {{-180, 60}, {-90, 60}, {0, 60}, {90, 60}, {180, 60}});
  EXPECT_EQ(around.size(), 5U);
  EXPECT_EQ(mars::pole_of(around), RingPole::north);
}

TEST(RingLongitudes, PoleRings) {
  const Ring south = unwrapped(ShapeKind::polygon, {{0, -80}, {120, -70}, {-120, -75}, {0, -80}});
  EXPECT_EQ(south.back(), glm::dvec2(360, -80));
  EXPECT_EQ(mars::pole_of(south), RingPole::south);
  const Ring west = unwrapped(ShapeKind::polygon, {{0, 80}, {240, 70}, {120, 75}});
  EXPECT_EQ(west.back(), glm::dvec2(-360, 80));
  EXPECT_EQ(mars::pole_of(west), RingPole::north);
  EXPECT_EQ(mars::pole_of({{0, 0}, {1, 0}, {1, 1}, {0, 0}}), RingPole::none);
  EXPECT_EQ(mars::pole_of({}), RingPole::none);
}

TEST(RingLongitudes, FramesOfTheWholePlanet) {
  const std::vector<Ring> frames{
      {{-180, -90}, {180, -90}, {180, 90}, {-180, 90}, {-180, -90}},
      {{0, -90}, {360, -90}, {360, 90}, {0, 90}, {0, -90}},
      {{-180, -90}, {0, -90}, {180, -90}, {180, 90}, {-180, 90}, {-180, -90}},
      {{-180, 30}, {-180, -30}, {180, -30}, {180, 30}, {-180, 30}},
      {{-180, 60}, {-90, 62}, {0, 65}, {90, 60}, {180, 60}, {180, 90}, {-180, 90}, {-180, 60}}};
  for (const Ring& frame : frames) {
    const Ring ring = unwrapped(ShapeKind::polygon, frame);
    EXPECT_NEAR(extent(ring), 360, 1e-9);
    EXPECT_EQ(ring.front(), ring.back());
    for (std::size_t i = 1; i < ring.size(); ++i) EXPECT_LE(std::abs(ring[i].x - ring[i - 1].x), 180);
  }
  EXPECT_NEAR(extent(unwrapped(ShapeKind::line, {{-180, 0}, {180, 0}})), 360, 1e-9);
  // A polygon over the antimeridian whose writer has put vertices on both of its sides is no frame.
  const Ring crossing =
      unwrapped(ShapeKind::polygon,
                {{170, 0}, {180, 0}, {-180, 0}, {-170, 0}, {-170, 9}, {-180, 9}, {180, 9}, {170, 9}, {170, 0}});
  EXPECT_EQ(crossing.size(), 9U);
  EXPECT_EQ(extent(crossing), 20);
}

TEST(RingLongitudes, HolesLieBesideTheirOutline) {
  Shape shape{
      ShapeKind::polygon,
      {{{170, 0}, {-160, 0}, {-160, 9}, {170, 9}, {170, 0}}, {{-175, 2}, {-172, 2}, {-172, 4}, {-175, 2}}}};
  mars::unwrap_longitudes(shape);
  EXPECT_EQ(shape.rings[0][1], glm::dvec2(200, 0));
  EXPECT_EQ(shape.rings[1][0], glm::dvec2(185, 2));
}

// A way of short steps, seen in any turn of longitudes, unwraps to itself.
RC_GTEST_PROP(RingLongitudesProperty, AnyTurnsGiveTheSameWay, ()) {
  const auto steps = *rc::gen::container<std::vector<int>>(rc::gen::inRange(-1790, 1791));
  const auto turns = *rc::gen::container<std::vector<int>>(steps.size() + 1, rc::gen::inRange(-3, 4));
  Ring way{{*rc::gen::inRange(-1800, 1800) / 10.0, 0}};
  for (std::size_t i = 0; i < steps.size(); ++i)
    way.emplace_back(way.back().x + steps[i] / 10.0, static_cast<double>(i + 1));
  Ring seen = way;
  for (std::size_t i = 0; i < seen.size(); ++i) seen[i].x += 360.0 * turns[i];
  Shape shape{ShapeKind::line, {seen}};
  mars::unwrap_longitudes(shape);
  const Ring& got = shape.rings[0];
  RC_ASSERT(got.size() == way.size());
  RC_ASSERT(std::abs(got[0].x) <= 180);
  const double offset = got[0].x - way[0].x;
  RC_ASSERT(std::abs(std::remainder(offset, 360)) < 1e-9);
  for (std::size_t i = 0; i < got.size(); ++i) {
    RC_ASSERT(std::abs(got[i].x - way[i].x - offset) < 1e-6);
    RC_ASSERT(got[i].y == way[i].y);
    RC_ASSERT(i == 0 || std::abs(got[i].x - got[i - 1].x) <= 180);
  }
}

// Unwrapping twice is unwrapping once.
RC_GTEST_PROP(RingLongitudesProperty, Idempotent, ()) {
  const auto lons = *rc::gen::container<std::vector<int>>(rc::gen::inRange(-3600, 3601));
  RC_PRE(lons.size() >= 3);
  Ring ring;
  for (const int lon : lons) ring.emplace_back(lon / 10.0, *rc::gen::inRange(-90, 91));
  for (const ShapeKind kind : {ShapeKind::line, ShapeKind::polygon}) {
    Shape once{kind, {ring}};
    mars::unwrap_longitudes(once);
    for (std::size_t i = 1; i < once.rings[0].size(); ++i)
      RC_ASSERT(std::abs(once.rings[0][i].x - once.rings[0][i - 1].x) <= 180 + 1e-9);
    Shape twice = once;
    mars::unwrap_longitudes(twice);
    RC_ASSERT(twice.rings == once.rings);
  }
}

}  // namespace
