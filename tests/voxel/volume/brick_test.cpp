// Bricks in the place of terrain: arches against their triangles, a skylight over a tube, bad input.
#include "vpe/voxel/volume/brick.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <limits>
#include <stdexcept>

#include "tests/paging/planet_fixture.h"
#include "vpe/voxel/cast/range_caster.h"

namespace vpe::voxel {
namespace {

using test_support::Random;

constexpr double kNothing = std::numeric_limits<double>::infinity();
constexpr double kVoxel_m = 8;
constexpr int kIntervals = 96;
constexpr double kDeep_m = 500;

struct Box {
  glm::dvec3 low;
  glm::dvec3 high;
};

struct FlatTriangle {
  glm::dvec3 a, b, c;
};

// The world about the middle of the brick: east, north, up, metres; `up` is the distance from the sphere along the middle's
// vertical, which is within 0.1 m of the height over so small a place.
class Scene : public testing::Test {
 protected:
  Scene() {
    const mars::ChartPoint at = mars::chart_point(mars::direction({23, 11}));
    face_ = at.face;
    const double du = kVoxel_m / radius_m() * std::pow(1 + at.u * at.u + at.v * at.v, 0.75);
    frame_ = {kIntervals, at.u - 0.5 * kIntervals * du, du, at.v - 0.5 * kIntervals * du, du};
    middle_ = mars::chart_direction(face_, at.u, at.v);
    east_ = glm::normalize(glm::cross(glm::dvec3(0, 0, 1), middle_));
    north_ = glm::cross(middle_, east_);
  }

  static const std::shared_ptr<const paging::PlanetFile>& planet() {
    static const test_support::TempDir folder;
    static const auto planet = test_support::build_fake(
        folder / "ball.vpe", test_support::FakeElevation([](const glm::dvec3&) { return 0.0; }), 400000);
    return planet;
  }
  static double radius_m() { return planet()->radius_m(); }

  glm::dvec3 local(const glm::dvec3& p) const {
    return {glm::dot(p, east_), glm::dot(p, north_), glm::dot(p, middle_) - radius_m()};
  }
  glm::dvec3 world(const glm::dvec3& p) const {
    return east_ * p.x + north_ * p.y + middle_ * (p.z + radius_m());
  }

  // Casts a view of the brick.
  std::vector<float> cast(const core::View& view, const GridVolume& brick, bool is_far = false) const {
    RangeCaster caster(planet(), std::size_t{64} << 20);
    RangeOptions options;
    options.method = RangeOptions::Method::kVolume;
    options.volume.interval = 0.2;
    options.volume.bricks = {std::make_shared<const GridVolume>(brick)};
    if (is_far) options.volume.near_m = 0;
    base::ThreadPool pool(2);
    std::vector<float> range_m(static_cast<std::size_t>(view.width * view.height));
    caster.cast(view, options, pool, range_m);
    return range_m;
  }

  core::View view_from(const glm::dvec3& eye, const glm::dvec3& to) const {
    core::View view;
    view.width = 64;
    view.height = 48;
    view.fov_deg = 40;
    view.camera.position_m = world(eye);
    const glm::dvec3 forward = glm::normalize(world(to) - world(eye));
    const glm::dvec3 right = glm::normalize(glm::cross(forward, middle_));
    view.camera.axes = {right, glm::cross(right, forward), forward};
    return view;
  }

  mars::Face face_{};
  HeightGridFrame frame_;
  glm::dvec3 middle_, east_, north_;
};

std::vector<FlatTriangle> triangles_of(const Box& box) {
  std::vector<FlatTriangle> out;
  for (int axis = 0; axis < 3; ++axis) {
    const int s = (axis + 1) % 3;
    const int t = (axis + 2) % 3;
    for (const double side : {box.low[axis], box.high[axis]}) {
      const auto corner = [&](bool far_s, bool far_t) {
        glm::dvec3 p;
        p[axis] = side;
        p[s] = far_s ? box.high[s] : box.low[s];
        p[t] = far_t ? box.high[t] : box.low[t];
        return p;
      };
      out.push_back({corner(false, false), corner(true, false), corner(true, true)});
      out.push_back({corner(false, false), corner(true, true), corner(false, true)});
    }
  }
  return out;
}

// Returns where a ray crosses a triangle (Moeller and Trumbore 1997).
double cross(const FlatTriangle& t, const glm::dvec3& origin, const glm::dvec3& ray) {
  const glm::dvec3 e1 = t.b - t.a;
  const glm::dvec3 e2 = t.c - t.a;
  const glm::dvec3 p = glm::cross(ray, e2);
  const double det = glm::dot(e1, p);
  if (std::abs(det) < 1e-12) return kNothing;
  const glm::dvec3 from = origin - t.a;
  const double u = glm::dot(from, p) / det;
  const glm::dvec3 q = glm::cross(from, e1);
  const double v = glm::dot(ray, q) / det;
  const double at = glm::dot(e2, q) / det;
  return u >= -1e-9 && v >= -1e-9 && u + v <= 1 + 1e-9 && at > 0 ? at : kNothing;
}

double distance_to(const FlatTriangle& t, const glm::dvec3& p) {
  // Ericson 2005, section 5.1.5, by trial: the plane's foot if it is inside, else the nearest point of an edge.
  const glm::dvec3 normal = glm::normalize(glm::cross(t.b - t.a, t.c - t.a));
  const double off = glm::dot(p - t.a, normal);
  const glm::dvec3 foot = p - off * normal;
  const glm::dvec3 corners[] = {t.a, t.b, t.c};
  bool is_inside = true;
  double nearest = kNothing;
  for (int n = 0; n < 3; ++n) {
    const glm::dvec3& a = corners[n];
    const glm::dvec3 edge = corners[(n + 1) % 3] - a;
    is_inside = is_inside && glm::dot(glm::cross(edge, foot - a), normal) >= 0;
    const double share = std::clamp(glm::dot(p - a, edge) / glm::dot(edge, edge), 0.0, 1.0);
    nearest = std::min(nearest, glm::length(p - (a + share * edge)));
  }
  return is_inside ? std::abs(off) : nearest;
}

TEST_F(Scene, AnArchIsThatOfItsTriangles) {
  // Two pillars, a slab that hangs over on all sides, and a block in the air.
  const Box boxes[] = {{{-120, -40, -20}, {-60, 40, 90}},
                       {{60, -40, -20}, {120, 40, 90}},
                       {{-170, -70, 90}, {170, 70, 130}},
                       {{-30, 150, 60}, {40, 230, 110}}};
  std::vector<FlatTriangle> mesh;
  for (const Box& box : boxes)
    for (const FlatTriangle& t : triangles_of(box)) mesh.push_back(t);
  const SolidsAt solids = [&](const glm::dvec3& up, std::vector<SolidSpan>& out) {
    out.push_back({-kDeep_m, 0});
    // Along the vertical, which is that of the middle but for 1e-4: parity of the crossings, box by box.
    for (const Box& box : boxes) {
      const glm::dvec3 at = local(radius_m() * up);
      std::vector<double> crossings;
      for (const FlatTriangle& t : triangles_of(box)) {
        const double s = cross(t, {at.x, at.y, -1000}, {0, 0, 1});
        if (s < kNothing) crossings.push_back(s - 1000);
      }
      std::sort(crossings.begin(), crossings.end());
      if (crossings.size() >= 2) out.push_back({crossings.front(), crossings.back()});
    }
  };
  const GridVolume brick = make_brick(face_, frame_, radius_m(), solids);
  EXPECT_NEAR(brick.voxel_m, kVoxel_m, 0.1);
  EXPECT_GT(brick.highest_m(radius_m()), radius_m() + 130);
  EXPECT_LT(brick.highest_m(radius_m()), radius_m() + 180);

  const auto nearest_surface = [&](const glm::dvec3& p) {
    double nearest = std::abs(glm::length(world(p)) - radius_m());
    for (const FlatTriangle& t : mesh) nearest = std::min(nearest, distance_to(t, p));
    return nearest;
  };
  Random random(21);
  int on_arch = 0;
  double farthest = 0;
  double deepest = 0;
  for (int n = 0; n < 10; ++n) {
    const double angle = random.uniform(0, 6.28);
    const glm::dvec3 eye{900 * std::cos(angle), 900 * std::sin(angle),
                         n % 2 == 0 ? random.uniform(20, 60) : random.uniform(200, 800)};
    const core::View view = view_from(eye, {random.uniform(-60, 60), random.uniform(-60, 60), 60});
    const std::vector<float> range_m = cast(view, brick);
    const std::vector<float> boundary_m = cast(view, brick, true);
    for (int k = 0; k < view.width * view.height; ++k) {
      const glm::dvec3 ray = core::pixel_ray(view, k % view.width + 0.5, k / view.width + 0.5);
      const glm::dvec3 way{glm::dot(ray, east_), glm::dot(ray, north_), glm::dot(ray, middle_)};
      double first = kNothing;
      for (const FlatTriangle& t : mesh) first = std::min(first, cross(t, eye, way));
      const auto found = static_cast<double>(range_m[static_cast<std::size_t>(k)]);
      const auto approximate = static_cast<double>(boundary_m[static_cast<std::size_t>(k)]);
      EXPECT_LE(approximate, found + 1);
      const glm::dvec3 at = eye + std::min(found, 3000.0) * way;
      const bool is_in_brick = std::max(std::abs(at.x), std::abs(at.y)) < 0.5 * kIntervals * kVoxel_m - 60;
      if (std::isfinite(found) && is_in_brick) {
        farthest = std::max(farthest, nearest_surface(at));
        on_arch += std::abs(found - first) < 2 * kVoxel_m;
      }
      // What a ray passed is not solid but for a voxel.
      for (double t = std::min(first, found); t < std::min(found, 2000.0); t += 2) {
        const glm::dvec3 p = eye + t * way;
        const bool is_solid = std::any_of(std::begin(boxes), std::end(boxes), [&](const Box& box) {
          return glm::all(glm::greaterThan(p, box.low)) && glm::all(glm::lessThan(p, box.high));
        });
        if (is_solid) deepest = std::max(deepest, nearest_surface(p));
      }
    }
  }
  std::printf(
      "%d rays on the arch; hits at most %.2f voxels from the triangles, rays at most %.2f voxels in them\n",
      on_arch, farthest / kVoxel_m, deepest / kVoxel_m);
  EXPECT_GT(on_arch, 1500);
  EXPECT_LT(farthest, kVoxel_m);
  EXPECT_LT(deepest, kVoxel_m);
}

TEST_F(Scene, ASkylightOpensATube) {
  const Box tube{{-250, -48, -120}, {250, 48, -40}};
  const Box skylight{{-32, -32, -40}, {32, 32, 0}};
  const GridVolume brick =
      make_brick(face_, frame_, radius_m(), [&](const glm::dvec3& up, std::vector<SolidSpan>& out) {
        const glm::dvec3 at = local(radius_m() * up);
        const auto is_over = [&](const Box& box) {
          return at.x > box.low.x && at.x < box.high.x && at.y > box.low.y && at.y < box.high.y;
        };
        if (!is_over(tube)) return out.push_back({-kDeep_m, 0});
        out.push_back({-kDeep_m, tube.low.z});
        if (!is_over(skylight)) out.push_back({tube.high.z, 0});
      });
  const core::View down = view_from({0, -1, 600}, {0, 0, 0});
  const std::vector<float> range_m = cast(down, brick);
  int floor = 0;
  int ground = 0;
  for (int k = 0; k < down.width * down.height; ++k) {
    const glm::dvec3 ray = core::pixel_ray(down, k % down.width + 0.5, k / down.width + 0.5);
    const glm::dvec3 way{glm::dot(ray, east_), glm::dot(ray, north_), glm::dot(ray, middle_)};
    const glm::dvec3 eye{0, -1, 600};
    const glm::dvec3 top = eye + way * (600 / -way.z);
    const double aside = std::max(std::abs(top.x), std::abs(top.y));
    const glm::dvec3 at = eye + static_cast<double>(range_m[static_cast<std::size_t>(k)]) * way;
    // Rays that come near the rim may end on it.
    if (aside < 12) {
      EXPECT_NEAR(at.z, -120, kVoxel_m);
      ++floor;
    } else if (aside > 32 + kVoxel_m) {
      EXPECT_NEAR(at.z, 0, kVoxel_m) << top.x << " " << top.y;
      ++ground;
    }
  }
  EXPECT_GT(floor, 3);
  EXPECT_GT(ground, 1000);
  // Obliquely through the opening, to the floor of the tube beside it.
  const core::View oblique = view_from({-70, 0, 110}, {20, 0, -60});
  const std::vector<float> slanted_m = cast(oblique, brick);
  const auto k = static_cast<std::size_t>(oblique.height / 2 * oblique.width + oblique.width / 2);
  const glm::dvec3 ray = core::pixel_ray(oblique, oblique.width / 2 + 0.5, oblique.height / 2 + 0.5);
  const glm::dvec3 at = local(oblique.camera.position_m + static_cast<double>(slanted_m[k]) * ray);
  EXPECT_NEAR(at.z, -120, kVoxel_m);
  EXPECT_GT(at.x, 40);  // under the roof
}

TEST_F(Scene, BadBricksAreRefused) {
  const SolidsAt flat = [](const glm::dvec3&, std::vector<SolidSpan>& out) { out.push_back({-100, 0}); };
  HeightGridFrame frame = frame_;
  frame.intervals = 0;
  EXPECT_THROW(make_brick(face_, frame, radius_m(), flat), std::invalid_argument);
  frame = frame_;
  frame.du = 0;
  EXPECT_THROW(make_brick(face_, frame, radius_m(), flat), std::invalid_argument);
  frame = frame_;
  frame.intervals = 2;
  EXPECT_THROW(make_brick(face_, frame, radius_m(), flat, {.samples = 0}), std::invalid_argument);
  EXPECT_THROW(make_brick(face_, frame, radius_m(), flat, {.samples = 17}), std::invalid_argument);
  EXPECT_THROW(make_brick(face_, frame, radius_m(), [](const glm::dvec3&, std::vector<SolidSpan>&) {}),
               std::invalid_argument);
  EXPECT_THROW(make_brick(face_, frame, radius_m(),
                          [](const glm::dvec3&, std::vector<SolidSpan>& out) {
                            out.push_back({-100, NAN});
                          }),
               std::invalid_argument);
  EXPECT_NO_THROW(make_brick(face_, frame, radius_m(), flat));
  // A roof 20 000 voxels above the ground would need them all in between.
  frame.intervals = 100;
  const SolidsAt high = [](const glm::dvec3&, std::vector<SolidSpan>& out) {
    out = {{-100, 0}, {20000 * kVoxel_m, 20001 * kVoxel_m}};
  };
  EXPECT_THROW(make_brick(face_, frame, radius_m(), high, {.samples = 1}), std::runtime_error);
}

TEST_F(Scene, EvenGroundTakesAVerticalAVoxelAndWallsTakeMore) {
  std::atomic<int> verticals{0};
  const auto count = [&](const Box& box) {
    verticals = 0;
    const SolidsAt solids = [&](const glm::dvec3& up, std::vector<SolidSpan>& out) {
      ++verticals;
      const glm::dvec3 at = local(radius_m() * up);
      out = {{-100, 0.3 * at.x}};
      if (at.x > box.low.x && at.x < box.high.x && at.y > box.low.y && at.y < box.high.y)
        out.push_back({box.low.z, box.high.z});
    };
    (void)make_brick(face_, frame_, radius_m(), solids);
    return verticals / static_cast<double>((kIntervals + 1) * (kIntervals + 1));
  };
  EXPECT_LT(count({}), 1.3);
  const double with_walls = count({{-100, -100, 200}, {100, 100, 300}});
  EXPECT_GT(with_walls, 1.5);
  EXPECT_LT(with_walls, 2.5);
}

TEST_F(Scene, BricksDoNotDependOnThreadsAndCountFromTheirGround) {
  const SolidsAt rough = [&](const glm::dvec3& up, std::vector<SolidSpan>& out) {
    const glm::dvec3 at = local(radius_m() * up);
    // Higher above the sphere than there are levels.
    const double ground_m = 40000 * kVoxel_m + 30 * std::sin(0.05 * at.x) * std::cos(0.07 * at.y);
    out = {{ground_m + 100, ground_m + 100 + at.x * at.x / 1000}, {0, ground_m}};
  };
  base::ThreadPool pool(3);
  const GridVolume alone = make_brick(face_, frame_, radius_m(), rough);
  const GridVolume together = make_brick(face_, frame_, radius_m(), rough, {}, &pool);
  ASSERT_EQ(together.voxels.bytes(), alone.voxels.bytes());
  for (int j = 0; j <= kIntervals; j += 5)
    for (int i = 0; i <= kIntervals; i += 3)
      for (int k = -20; k < 60; ++k) EXPECT_EQ(together.voxels.voxel(i, j, k), alone.voxels.voxel(i, j, k));
  // The middle's ground is level 0, and places and heights are each other's inverse.
  const glm::dvec3 middle{0.5 * kIntervals, 0.5 * kIntervals, 0};
  EXPECT_NEAR(alone.height_m(middle, radius_m()), 40000 * kVoxel_m, kVoxel_m);
  EXPECT_NEAR(alone.voxels.crossings(kIntervals / 2, kIntervals / 2).low, 0, 1);
  const glm::dvec3 place =
      (radius_m() + alone.height_m({7.25, 60.5, 12}, radius_m())) *
      mars::chart_direction(face_, frame_.u0 + 7.25 * frame_.du, frame_.v0 + 60.5 * frame_.dv);
  EXPECT_LT(glm::length(alone.voxel_of(place, radius_m()) - glm::dvec3(7.25, 60.5, 12)), 1e-4);
}

}  // namespace
}  // namespace vpe::voxel
