// Stretches of lines in meshes: winding, sheets, touching parts, precision far away, against brute force.
#include "objects/model/solid_spans.h"

#include <gtest/gtest.h>

#include "tests/objects/spans/line_oracle.h"
#include "tests/support/support.h"
#include "tests/support/worst.h"

namespace objects {
namespace {

const Rgba kGrey{120, 120, 120, 255};

struct Solid {
  explicit Solid(Mesh mesh) : level{std::move(mesh), {}, 0}, ball(bounding_ball(level.mesh)) {
    level.tree = TriangleTree(level.mesh);
  }
  std::vector<SolidSpan> spans(const glm::dvec3& origin, const glm::dvec3& direction) const {
    return mesh_spans(level, {}, ball, {origin, direction});
  }
  std::vector<SolidSpan> upwards(double x, double y) const { return spans({x, y, 0}, {0, 0, 1}); }

  MeshLevel level;
  Ball ball;
};

void expect_spans(const std::vector<SolidSpan>& spans, const std::vector<SolidSpan>& expected, double error) {
  ASSERT_EQ(spans.size(), expected.size());
  for (std::size_t n = 0; n < spans.size(); ++n) {
    EXPECT_NEAR(spans[n].begin, expected[n].begin, error) << n;
    EXPECT_NEAR(spans[n].end, expected[n].end, error) << n;
  }
}

// A square at a height, seen from above or from below.
void append_square(Mesh& mesh, float half_m, float z_m, bool faces_up) {
  Mesh square;
  square.positions_m = {
      {-half_m, -half_m, z_m}, {half_m, -half_m, z_m}, {half_m, half_m, z_m}, {-half_m, half_m, z_m}};
  square.triangles = {{0, 1, 2}, {0, 2, 3}};
  if (!faces_up) square.triangles = {{0, 2, 1}, {0, 3, 2}};
  append(mesh, square, glm::mat4(1), kGrey);
}

TEST(SolidSpans, JoinsWhatOverlapsOrTouches) {
  std::vector<SolidSpan> spans{{5, 6}, {0, 1}, {0.5, 2}, {2.05, 3}, {3.2, 3.2}, {0.1, 0.2}};
  join_spans(spans, 0.1);
  expect_spans(spans, {{0, 3}, {3.2, 3.2}, {5, 6}}, 0);
  join_spans(spans, 10);
  expect_spans(spans, {{0, 6}}, 0);
  spans.clear();
  join_spans(spans, 1);
  EXPECT_TRUE(spans.empty());
}

TEST(SolidSpans, AnArchOfTouchingBoxesIsOneSolid) {
  const Solid solid(line_oracle::arch());
  expect_spans(solid.upwards(0.3, 0.4), {{10, 14}}, 1e-9);
  expect_spans(solid.upwards(9.7, -1.1), {{0, 14}}, 1e-9);  // a pier and the lintel
  EXPECT_TRUE(solid.upwards(12.1, 0).empty());
  // On lines along edges and diagonals of triangles, too.
  expect_spans(solid.upwards(0, 0), {{10, 14}}, 1e-9);
  expect_spans(solid.upwards(10, 0), {{0, 14}}, 1e-9);
  expect_spans(solid.spans({0.2, 7, 12}, {0, -2, 0}), {{2, 5}}, 1e-9);  // t counts in lengths of the direction
  expect_spans(solid.spans({0.2, 0.1, 100}, {0, 0, 1}), {{-90, -86}}, 1e-9);  // a whole line
}

TEST(SolidSpans, PartsInOneAnotherAreOneSolid) {
  Mesh mesh;
  append(mesh, make_box({4, 4, 4}), glm::mat4(1), kGrey);
  append(mesh, make_box({2, 2, 7}), glm::translate(glm::mat4(1), {0, 0, 1}), kGrey);
  append(mesh, make_box({1, 1, 1}), glm::translate(glm::mat4(1), {0, 0, 2}), kGrey);
  const Solid solid(mesh);
  expect_spans(solid.upwards(0.1, 0.2), {{0, 8}}, 1e-9);
  expect_spans(solid.upwards(1.5, 0.2), {{0, 4}}, 1e-9);
}

TEST(SolidSpans, CavitiesAreAir) {
  Mesh mesh = line_oracle::uv_sphere(10, 40, 80);
  Mesh inner = line_oracle::uv_sphere(6, 40, 80);
  for (glm::uvec3& t : inner.triangles) std::swap(t.y, t.z);
  append(mesh, inner, glm::mat4(1), kGrey);
  expect_spans(Solid(mesh).upwards(0.1, 0.05), {{-10, -6}, {6, 10}}, 0.05);
}

TEST(SolidSpans, OpenSurfacesAreSheets) {
  Mesh mesh;
  append_square(mesh, 2, 9, true);
  append_square(mesh, 2, 7, false);
  append_square(mesh, 2, 6, true);
  append(mesh, make_box({2, 2, 5}), glm::mat4(1), kGrey);
  // The square that faces down and the one above it bound a solid, as far as the line can tell.
  expect_spans(Solid(mesh).upwards(1.7, 0.1), {{6, 6}, {7, 9}}, 1e-9);
  expect_spans(Solid(mesh).upwards(0.3, 0.1), {{0, 5}, {6, 6}, {7, 9}}, 1e-9);
  Mesh below = make_box({2, 2, 5});
  append_square(below, 2, -1, false);
  append_square(below, 2, -2, true);
  expect_spans(Solid(below).upwards(0.3, 0.1), {{-2, -2}, {-1, -1}, {0, 5}}, 1e-9);
}

TEST(SolidSpans, SidesThatAreNotDrawnCountAndThinGlassDoesNot) {
  Mesh mesh = make_box({2, 2, 2});
  mesh.material_table[0].double_sided = false;
  expect_spans(Solid(mesh).upwards(0.3, 0.1), {{0, 2}}, 1e-9);
  mesh.material_table[0].alpha = AlphaMode::kBlend;
  mesh.material_table[0].colour.a = 127;
  EXPECT_TRUE(Solid(mesh).upwards(0.3, 0.1).empty());
  mesh.material_table[0].colour.a = 128;
  expect_spans(Solid(mesh).upwards(0.3, 0.1), {{0, 2}}, 1e-9);
}

TEST(SolidSpans, MeetsNothingWhereThereIsNothing) {
  const Solid solid(make_box({2, 2, 2}));
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(solid.spans({kNaN, 0, 0}, {0, 0, 1}).empty());
  EXPECT_TRUE(solid.spans({0, 0, 0}, {0, 0, 0}).empty());
  EXPECT_TRUE(solid.spans({0, 0, 0}, {0, 0, kNaN}).empty());
  EXPECT_TRUE(solid.spans({5, 0, 0}, {0, 0, 1}).empty());
  EXPECT_TRUE(mesh_spans({}, {}, {}, {}).empty());
}

// Any line through closed meshes, from near and from far, against all triangles in double precision.
TEST(SolidSpans, AgreesWithBruteForce) {
  test_support::Random random(20261127);
  double worst_m = 0;
  for (const Mesh& mesh : {line_oracle::overhang(), line_oracle::arch(), line_oracle::uv_sphere(12, 20, 30),
                           make_torus(9, 3, 40, 20), make_rock(5, 4)}) {
    const Solid solid(mesh);
    const std::vector<line_oracle::Triangle> triangles =
        line_oracle::placed(mesh, glm::dmat3(1), glm::dvec3(0));
    const auto radius_m = static_cast<double>(solid.ball.radius_m);
    int met = 0;
    for (int n = 0; n < 400; ++n) {
      const glm::dvec3 direction = random.direction();
      const double off_m = random.uniform(0, radius_m);
      const glm::dvec3 through = glm::dvec3(solid.ball.centre_m) + off_m * random.direction();
      const double back_m = n % 2 == 0 ? 0 : 3.4e6;
      const std::vector<SolidSpan> spans = solid.spans(through - back_m * direction, direction);
      const auto expected = line_oracle::meetings(triangles, through, direction, 1e-5 * radius_m);
      std::vector<SolidSpan> kept;  // without slivers at edges, of which rounding may find others
      for (const SolidSpan& s : spans)
        if (s.end - s.begin >= 1e-5 * radius_m) kept.push_back(s);
      ASSERT_EQ(2 * kept.size(), expected.size()) << n;
      if (!kept.empty()) ++met;
      for (std::size_t k = 0; k < kept.size(); ++k) {
        EXPECT_FALSE(expected[2 * k].is_top);
        worst_m = std::max({worst_m, std::abs(kept[k].begin - back_m - expected[2 * k].t),
                            std::abs(kept[k].end - back_m - expected[2 * k + 1].t)});
      }
    }
    EXPECT_GT(met, 100);
  }
  test_support::record_worst("Spans of meshes against all triangles", worst_m, 1e-5, "m");
}

}  // namespace
}  // namespace objects
