#include "mars/vector/antimeridian.h"

#include <gtest/gtest.h>
#include <ogr_geometry.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <memory>

#include "mars/geodesy/sphere.h"
#include "mars/raster/gdal/gdal_scope.h"
#include "mars/vector/ring_longitudes.h"
#include "tests/support/support.h"

namespace {

using mars::Shape;
using mars::ShapeKind;

using Ring = std::vector<glm::dvec2>;

double ring_area(const Ring& ring) {
  double sum = 0;
  for (std::size_t i = 1; i < ring.size(); ++i) sum += ring[i - 1].x * ring[i].y - ring[i].x * ring[i - 1].y;
  return sum / 2;
}

// Outlines count positive, holes negative.
double area(const std::vector<Shape>& shapes) {
  double sum = 0;
  for (const Shape& shape : shapes) {
    for (const Ring& ring : shape.rings) sum += ring_area(ring);
  }
  return sum;
}

int crossings(glm::dvec2 p, const Ring& ring) {
  int count = 0;
  for (std::size_t i = 1; i < ring.size(); ++i) {
    const glm::dvec2 a = ring[i - 1];
    const glm::dvec2 b = ring[i];
    if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) ++count;
  }
  return count;
}

bool is_inside(glm::dvec2 p, const std::vector<Shape>& shapes) {
  int count = 0;
  for (const Shape& shape : shapes) {
    for (const Ring& ring : shape.rings) count += crossings(p, ring);
  }
  return count % 2 != 0;
}

std::unique_ptr<OGRPolygon> ogr_polygon(const Shape& shape) {
  auto polygon = std::make_unique<OGRPolygon>();
  for (const Ring& ring : shape.rings) {
    auto linear = std::make_unique<OGRLinearRing>();
    for (const glm::dvec2 p : ring) linear->addPoint(p.x, p.y);
    polygon->addRingDirectly(linear.release());
  }
  return polygon;
}

void expect_in_range(const std::vector<Shape>& shapes) {
  for (const Shape& shape : shapes) {
    for (const Ring& ring : shape.rings) {
      for (const glm::dvec2 p : ring) {
        EXPECT_LE(std::abs(p.x), 180);
        EXPECT_LE(std::abs(p.y), 90);
      }
      if (shape.kind == ShapeKind::polygon) {
        EXPECT_EQ(ring.front(), ring.back());
        EXPECT_EQ(ring_area(ring) > 0, &ring == &shape.rings.front());
      }
    }
  }
}

TEST(Antimeridian, PointsAndLines) {
  const auto point = mars::cut_at_antimeridian({ShapeKind::point, {{{190, 1}}}});
  EXPECT_EQ(point.at(0).rings, (std::vector<Ring>{{{-170, 1}}}));
  const auto line = mars::cut_at_antimeridian({ShapeKind::line, {{{170, 0}, {190, 10}, {170, 20}}}});
  ASSERT_EQ(line.size(), 3U);
  EXPECT_EQ(line[0].rings[0], (Ring{{170, 0}, {180, 5}}));
  EXPECT_EQ(line[1].rings[0], (Ring{{-180, 5}, {-170, 10}, {-180, 15}}));
  EXPECT_EQ(line[2].rings[0], (Ring{{180, 15}, {170, 20}}));
  const auto whole = mars::cut_at_antimeridian({ShapeKind::line, {{{10, 0}, {20, 5}}}});
  EXPECT_EQ(whole.at(0).rings[0], (Ring{{10, 0}, {20, 5}}));
  const auto still = mars::cut_at_antimeridian({ShapeKind::line, {{{185, 0}, {185, 0}}}});
  EXPECT_EQ(still.at(0).rings[0], (Ring{{-175, 0}, {-175, 0}}));
}

TEST(Antimeridian, PolygonWithAHoleOnTheBorder) {
  const Shape shape{ShapeKind::polygon,
                    {{{170, 0}, {190, 0}, {190, 20}, {170, 20}, {170, 0}},
                     {{178, 8}, {182, 8}, {182, 12}, {178, 12}, {178, 8}},
                     {{172, 2}, {173, 2}, {173, 3}, {172, 2}}}};
  const auto parts = mars::cut_at_antimeridian(shape);
  expect_in_range(parts);
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[0].rings.size() + parts[1].rings.size(), 3U);
  EXPECT_NEAR(area(parts), 400 - 16 - 0.5, 1e-9);
}

TEST(Antimeridian, PolesAndFrames) {
  const Ring cap{{0, 80}, {120, 70}, {240, 75}, {360, 80}};
  const auto north = mars::cut_at_antimeridian({ShapeKind::polygon, {cap}});
  expect_in_range(north);
  ASSERT_EQ(north.size(), 1U);
  EXPECT_TRUE(is_inside({10, 89}, north));
  EXPECT_TRUE(is_inside({-179, 89}, north));
  EXPECT_FALSE(is_inside({10, 60}, north));
  // Between two rings around the south pole.
  const Shape band{
      ShapeKind::polygon,
      {{{10, -60}, {130, -60}, {250, -60}, {370, -60}}, {{50, -80}, {-70, -80}, {-190, -80}, {-310, -80}}}};
  const auto south = mars::cut_at_antimeridian(band);
  expect_in_range(south);
  EXPECT_NEAR(area(south), 360 * 20, 1e-6);
  EXPECT_TRUE(is_inside({100, -70}, south));
  EXPECT_FALSE(is_inside({100, -85}, south));
  Shape frame{ShapeKind::polygon, {{{-180, -90}, {180, -90}, {180, 90}, {-180, 90}}}};
  mars::unwrap_longitudes(frame);
  const auto all = mars::cut_at_antimeridian(frame);
  expect_in_range(all);
  EXPECT_NEAR(area(all), 360 * 180, 1e-6);
}

TEST(Antimeridian, VerticesOnTheBorder) {
  for (const Ring& ring : {Ring{{170, 0}, {180, 0}, {180, 10}, {170, 10}, {170, 0}},
                           Ring{{180, 0}, {190, 0}, {190, 10}, {180, 10}, {180, 0}},
                           Ring{{-180, 0}, {-170, 0}, {-170, 10}, {-180, 10}, {-180, 0}},
                           Ring{{180, 0}, {185, 5}, {180, 10}, {175, 5}, {180, 0}},
                           Ring{{170, 0}, {180, 5}, {190, 0}, {190, 10}, {180, 5}, {170, 10}, {170, 0}}}) {
    const auto parts = mars::cut_at_antimeridian({ShapeKind::polygon, {ring}});
    expect_in_range(parts);
    EXPECT_NEAR(area(parts), std::abs(ring_area(ring)), 1e-9);
  }
  // Without area.
  const auto flat = mars::cut_at_antimeridian({ShapeKind::polygon, {{{170, 0}, {190, 0}, {170, 0}, {170, 0}}}});
  ASSERT_EQ(flat.size(), 1U);
}

// Of star-shaped outlines with a hole, the cut parts are valid to GEOS and have the area of the whole.
TEST(Antimeridian, StarsStayValid) {
  const mars::GdalScope scope;
  test_support::Random random(20261127);
  int cut = 0;
  for (int n = 0; n < 300; ++n) {
    const glm::dvec2 centre(random.uniform(120, 240), random.uniform(-40, 40));
    const auto star = [&](double least, double most, int count) {
      Ring ring;
      for (int i = 0; i < count; ++i) {
        const double radius = random.uniform(least, most);
        const double angle = 2 * mars::kPi * (i + 0.1) / count;
        ring.push_back(centre + radius * glm::dvec2(std::cos(angle), std::sin(angle)));
      }
      ring.push_back(ring.front());
      return ring;
    };
    Shape shape{ShapeKind::polygon, {star(20, 48, random.integer(5, 40)), star(3, 14, random.integer(3, 12))}};
    ASSERT_TRUE(ogr_polygon(shape)->IsValid());
    const auto parts = mars::cut_at_antimeridian(shape);
    expect_in_range(parts);
    const double expected = std::abs(ring_area(shape.rings[0])) - std::abs(ring_area(shape.rings[1]));
    ASSERT_NEAR(area(parts), expected, 1e-7 * expected) << n;
    for (const Shape& part : parts) ASSERT_TRUE(ogr_polygon(part)->IsValid()) << n;
    cut += parts.size() > 1 ? 1 : 0;
  }
  EXPECT_GT(cut, 100);
}

// Whatever the rings, places are inside of the parts if and only if they are inside of the whole by the even-odd rule.
RC_GTEST_PROP(AntimeridianProperty, KeepsWhatIsInside, ()) {
  Shape shape{ShapeKind::polygon, {}};
  const int rings = *rc::gen::inRange(1, 4);
  for (int r = 0; r < rings; ++r) {
    Ring ring;
    const int count = *rc::gen::inRange(3, 12);
    for (int i = 0; i < count; ++i)
      ring.emplace_back(*rc::gen::inRange(100, 261) + 0.25, *rc::gen::inRange(-80, 81) + 0.125);
    ring.push_back(ring.front());
    shape.rings.push_back(ring);
  }
  const auto parts = mars::cut_at_antimeridian(shape);
  for (int i = 0; i < 40; ++i) {
    const glm::dvec2 p(*rc::gen::inRange(100, 261) + 0.6180339, *rc::gen::inRange(-80, 81) + 0.7071067);
    int whole = 0;
    for (const Ring& ring : shape.rings) whole += crossings(p, ring);
    const glm::dvec2 seen(p.x > 180 ? p.x - 360 : p.x, p.y);
    RC_ASSERT((whole % 2 != 0) == is_inside(seen, parts));
  }
}

}  // namespace
