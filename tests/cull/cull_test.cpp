// Visible ground is never culled, and distances are tight lower bounds, for random and hostile views.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "cull/bounding_region.h"
#include "cull/frustum.h"
#include "cull/horizon.h"
#include "mars/geodesy/sphere.h"
#include "tests/support/support.h"
#include "vpe/core/view.h"

namespace {

using cull::BoundingRegion;
using test_support::Random;
namespace core = vpe::core;

constexpr double kRadius_m = mars::kMarsRadius_m;
constexpr double kLowest_m = kRadius_m - 8200.0;

glm::dvec3 region_point(const mars::ChartRect& rect, double s, double t, double radius_m) {
  return radius_m *
         mars::chart_direction(rect.face, rect.u0 + s * (rect.u1 - rect.u0), rect.v0 + t * (rect.v1 - rect.v0));
}

// Returns a rectangle of `size` that contains a chart point, clipped at the face's borders.
mars::ChartRect rect_around(Random& random, const mars::ChartPoint& point, double size) {
  const double u = point.u - random.uniform(0, size);
  const double v = point.v - random.uniform(0, size);
  mars::ChartRect rect{point.face, std::max(-1.0, u), std::min(1.0, u + size), std::max(-1.0, v),
                       std::min(1.0, v + size)};
  rect.u1 = std::max(rect.u1, std::nextafter(rect.u0, 2.0));
  rect.v1 = std::max(rect.v1, std::nextafter(rect.v0, 2.0));
  // Sometimes the point is on the rectangle's own border.
  if (random.integer(0, 4) == 0 && point.u < rect.u1) rect.u0 = point.u;
  if (random.integer(0, 4) == 0 && point.v < rect.v1) rect.v0 = point.v;
  return rect;
}

mars::ChartRect random_rect(Random& random) {
  const mars::ChartPoint centre = mars::chart_point(random.direction());
  return rect_around(random, centre, random.log_uniform(1e-6, 2.0));
}

// Returns critical directions: random ones, poles, the antimeridian, the cube's edges and corners.
glm::dvec3 hostile_direction(Random& random) {
  glm::dvec3 d = random.direction();
  switch (random.integer(0, 5)) {
    case 0: d = {0, 0, random.integer(0, 1) == 0 ? 1.0 : -1.0}; break;
    case 1: d = glm::normalize(glm::dvec3{-1, random.uniform(-1e-9, 1e-9), random.uniform(-1, 1)}); break;
    case 2: d = glm::normalize(glm::dvec3{1, random.integer(0, 1) * 2 - 1, random.uniform(-1, 1)}); break;
    case 3: d = glm::normalize(glm::dvec3(1, -1, random.integer(0, 1) * 2 - 1)); break;
    default: break;
  }
  return d;
}

// Returns heights from below the datum, over half a metre above ground, to ten radii.
double hostile_radius(Random& random) {
  const double ground = kRadius_m + random.uniform(-8000, 21000);
  return random.integer(0, 3) == 0 ? ground + 0.5 : ground + random.log_uniform(0.1, 10 * kRadius_m);
}

core::View random_view(Random& random, const glm::dvec3& camera_m) {
  core::View view;
  const glm::dvec3 up = glm::normalize(camera_m);
  const glm::dvec3 east = mars::any_perpendicular(up);
  view.camera.position_m = camera_m;
  const glm::dvec3 turn_deg{random.uniform(-180, 180), random.uniform(-90, 90), random.uniform(-180, 180)};
  view.camera.axes = mars::oriented_axes({east, glm::cross(up, east), up}, turn_deg.x, turn_deg.y, turn_deg.z);
  view.fov_deg = random.integer(0, 2) == 0 ? random.uniform(1, 170) : 60.0;
  view.width = random.integer(16, 1920);
  view.height = random.integer(16, 1080);
  return view;
}

TEST(Volume, ContainsItsRegion) {
  Random random(21);
  for (int trial = 0; trial < 20000; ++trial) {
    const double low = kRadius_m + random.uniform(-1e5, 1e4);
    const BoundingRegion region{random_rect(random), low, low + random.log_uniform(1e-3, 1e6)};
    const cull::BoundingHexahedron volume = cull::bounding_hexahedron(region);
    const double radius = random.integer(0, 1) == 0 ? region.min_radius_m : region.max_radius_m;
    const glm::dvec2 at{random.integer(0, 2) * 0.5, random.uniform(0, 1)};
    const glm::dvec3 point = region_point(region.rect, at.x, at.y, radius);
    const double along = glm::dot(volume.centre, point);
    for (std::size_t k = 0; k < 4; ++k) {
      ASSERT_LE(glm::dot(volume.centre, volume.corners_m[k]), along + 1e-8);
      ASSERT_GE(glm::dot(volume.centre, volume.corners_m[k + 4]), along - 1e-8);
      const double u = (k & 1) != 0 ? region.rect.u1 : region.rect.u0;
      const double v = (k & 2) != 0 ? region.rect.v1 : region.rect.v0;
      const glm::dvec3 corner = volume.corners_m[k + 4];
      ASSERT_LE(glm::length(corner - mars::chart_direction(region.rect.face, u, v) * glm::length(corner)),
                cull::kVolumeError * glm::length(corner));
    }
  }
}

// Returns the squared chord to the rectangle's border by search along its four sides, independent of
// bounding_region.cpp.
double searched_chord2(const mars::ChartRect& rect, const glm::dvec3& d) {
  double best = 4.0;
  for (int side = 0; side < 4; ++side) {
    const auto chord2 = [&](double t) {
      const double s = side % 2;
      const glm::dvec3 delta = (side < 2 ? region_point(rect, s, t, 1.0) : region_point(rect, t, s, 1.0)) - d;
      return glm::dot(delta, delta);
    };
    int nearest = 0;
    constexpr int kSteps = 64;
    for (int k = 1; k <= kSteps; ++k) {
      if (chord2(double(k) / kSteps) < chord2(double(nearest) / kSteps)) nearest = k;
    }
    double low = std::max(0.0, (nearest - 1.0) / kSteps);
    double high = std::min(1.0, (nearest + 1.0) / kSteps);
    for (int step = 0; step < 60; ++step) {
      const double a = low + (high - low) / 3;
      const double b = high - (high - low) / 3;
      (chord2(a) < chord2(b) ? high : low) = chord2(a) < chord2(b) ? b : a;
    }
    best = std::min({best, chord2(low), chord2(0.0), chord2(1.0)});
  }
  return best;
}

bool inside(const mars::ChartRect& rect, const glm::dvec3& d) {
  if (glm::dot(mars::face_axes(rect.face).out, d) <= 0.0) return false;
  const mars::ChartPoint p = mars::chart_on(rect.face, d);
  return p.u >= rect.u0 && p.u <= rect.u1 && p.v >= rect.v0 && p.v <= rect.v1;
}

TEST(Chord, NearestAndFarthestAgreeWithASearch) {
  Random random(22);
  int on_side = 0;
  for (int trial = 0; trial < 10000; ++trial) {
    const mars::ChartRect rect = random_rect(random);
    glm::dvec3 d = hostile_direction(random);
    if (random.integer(0, 1) == 0) {
      const double span = random.log_uniform(1e-9, 3.0);
      const glm::dvec2 at{random.uniform(0, 1), random.uniform(0, 1)};
      d = glm::normalize(region_point(rect, at.x, at.y, 1.0) + span * random.direction());
    }
    const double border = searched_chord2(rect, d);
    const double expected = inside(rect, d) ? 0.0 : border;
    const double nearest = cull::nearest_chord2(rect, d);
    on_side += nearest > 0.0 ? 1 : 0;
    ASSERT_NEAR(std::sqrt(nearest), std::sqrt(expected), cull::kChordError + 1e-9 * std::sqrt(expected));
    // Sampled: at least as far as every point, and the bound is reached.
    const double far = std::sqrt(cull::farthest_chord2(rect, d));
    double sampled = inside(rect, -d) ? 2.0 : 0.0;
    for (int k = 0; k <= 64; ++k) {
      for (const double side : {0.0, 1.0}) {
        sampled = std::max(sampled, glm::length(region_point(rect, k / 64.0, side, 1.0) - d));
        sampled = std::max(sampled, glm::length(region_point(rect, side, k / 64.0, 1.0) - d));
      }
    }
    ASSERT_LE(sampled, far + cull::kChordError);
    ASSERT_GE(sampled, far * (1 - 1e-3));
  }
  EXPECT_GT(on_side, 5000);
}

TEST(Distance, IsATightLowerBoundOverTheRegion) {
  Random random(23);
  int in_the_region = 0;
  for (int trial = 0; trial < 10000; ++trial) {
    const glm::dvec3 away = hostile_direction(random);
    const glm::dvec3 camera_m = away * hostile_radius(random);
    const cull::Camera camera = cull::make_camera(camera_m);
    mars::ChartRect rect = random_rect(random);
    if (random.integer(0, 1) == 0) {
      const glm::dvec3 aside = random.direction();
      const mars::ChartPoint near = mars::chart_point(camera_m + aside * random.log_uniform(0.1, 1e6));
      rect = rect_around(random, near, random.log_uniform(1e-6, 1.0));
    }
    const double low = kRadius_m + random.uniform(-8200, 15000);
    const double high = low + random.log_uniform(0.1, 1e4);
    const double nearest2 = cull::nearest_chord2(rect, camera.direction);
    const double bound = cull::min_distance_m(camera, nearest2, low, high);
    const double upper = cull::max_distance_m(camera, cull::farthest_chord2(rect, camera.direction), low, high);
    double brute = 1e300;
    for (int a = 0; a <= 8; ++a) {
      for (int b = 0; b <= 8; ++b) {
        for (int c = 0; c <= 2; ++c) {
          const double distance =
              glm::length(region_point(rect, a / 8.0, b / 8.0, low + (high - low) * c / 2) - camera_m);
          ASSERT_GE(distance, bound);
          ASSERT_LE(distance, upper);
          brute = std::min(brute, distance);
        }
      }
    }
    // The nearest point itself: clamp the camera's chart point by the search, and its radius.
    const double chord2 = inside(rect, camera.direction) ? 0.0 : searched_chord2(rect, camera.direction);
    for (int step = 0; step <= 1000; ++step) {
      const double r = low + (high - low) * step / 1000.0;
      brute = std::min(brute,
                       std::sqrt((camera.radius_m - r) * (camera.radius_m - r) + camera.radius_m * r * chord2));
    }
    ASSERT_GE(bound, 0.9 * brute - (high - low) / 1000.0 - 1e-7) << trial;
    in_the_region += bound == 0.0 ? 1 : 0;
  }
  EXPECT_GT(in_the_region, 20);
  const cull::Camera centre = cull::make_camera({0, 0, 0});
  EXPECT_NEAR(cull::min_distance_m(centre, 0.0, 5.0, 7.0), 5.0, 1e-12);
  EXPECT_NEAR(cull::max_distance_m(centre, 4.0, 5.0, 7.0), 7.0, 1e-12);
}

TEST(Frustum, NeverRejectsARegionWithAPointInTheImage) {
  Random random(24);
  int crossed = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const glm::dvec3 away = hostile_direction(random);
    const glm::dvec3 camera_m = away * hostile_radius(random);
    core::View view = random_view(random, camera_m);
    if (random.integer(0, 3) == 0)
      view.part = {view.width / 4, view.height / 3, view.width / 2, view.height / 2};
    const int x0 = view.part.width > 0 ? view.part.x : 0;
    const int y0 = view.part.width > 0 ? view.part.y : 0;
    const glm::ivec2 size = core::drawn_size(view);
    // Half of the points lie on the image's border.
    double x = random.uniform(0, size.x);
    double y = random.uniform(0, size.y);
    if (random.integer(0, 3) == 0) x = random.integer(0, 1) * size.x;
    if (random.integer(0, 3) == 0) y = random.integer(0, 1) * size.y;
    const glm::dvec3 ray = core::pixel_ray(view, x0 + x, y0 + y);
    const glm::dvec3 point = camera_m + ray * random.log_uniform(0.01, 2 * glm::length(camera_m));
    const double r = glm::length(point);
    const mars::ChartRect rect = rect_around(random, mars::chart_point(point), random.log_uniform(1e-16, 1.0));
    // Rounding of the point itself may put it just outside its rectangle or region: give that much.
    const auto margin_m = [&] { return random.integer(0, 1) == 0 ? 0 : random.log_uniform(0.01, 1e4); };
    const BoundingRegion region{rect, r * (1 - 1e-15) - margin_m(), r * (1 + 1e-15) + margin_m()};
    if (region.min_radius_m < 0.0) continue;
    const cull::Frustum frustum = cull::make_frustum(view);
    const auto mask =
        cull::planes_crossed(frustum, cull::bounding_hexahedron(region), cull::all_planes(frustum));
    ASSERT_TRUE(mask.has_value()) << "trial " << trial;
    crossed += *mask != 0 ? 1 : 0;
    // Planes that do not intersect a volume do not intersect its parts.
    mars::ChartRect part = rect;
    part.u1 = 0.5 * (rect.u0 + rect.u1);
    const auto part_mask = cull::planes_crossed(
        frustum, cull::bounding_hexahedron({part, region.min_radius_m, region.max_radius_m}),
        cull::all_planes(frustum));
    const auto inherited = cull::planes_crossed(
        frustum, cull::bounding_hexahedron({part, region.min_radius_m, region.max_radius_m}), *mask);
    if (part_mask) {
      ASSERT_TRUE(inherited.has_value());
      ASSERT_EQ(*inherited, *part_mask & *mask);
    } else {
      ASSERT_TRUE(!inherited || *mask != cull::all_planes(frustum));
    }
  }
  EXPECT_GT(crossed, 5000);
}

TEST(Frustum, RejectsWhatIsClearlyOutside) {
  Random random(25);
  int outside = 0;
  int culled = 0;
  for (int trial = 0; trial < 10000; ++trial) {
    const glm::dvec3 away = random.direction();
    const glm::dvec3 camera_m = away * (kRadius_m + random.log_uniform(100, 1e7));
    core::View view = random_view(random, camera_m);
    view.fov_deg = 60.0;
    const BoundingRegion region{rect_around(random, mars::chart_point(random.direction()), 0.05), kRadius_m,
                                kRadius_m + 5e3};
    const glm::dvec3 middle = region_point(region.rect, 0.5, 0.5, kRadius_m);
    // Its middle is farther beyond the left or right side plane than its corners are from the middle.
    const glm::dvec3 to = middle - camera_m;
    const double half = std::atan(std::tan(mars::kRadiansPerDegree * 30) * view.width / view.height);
    const double beyond = std::abs(glm::dot(view.camera.axes.right, to)) * std::cos(half) -
                          glm::dot(view.camera.axes.forward, to) * std::sin(half);
    if (beyond < 0.05 * kRadius_m) continue;
    ++outside;
    const cull::Frustum frustum = cull::make_frustum(view);
    culled +=
        cull::planes_crossed(frustum, cull::bounding_hexahedron(region), cull::all_planes(frustum)) ? 0 : 1;
  }
  EXPECT_GT(outside, 2000);
  EXPECT_EQ(culled, outside);
}

TEST(Frustum, PanoramasHaveNone) {
  core::View view;
  view.camera.position_m = {kRadius_m + 10, 0, 0};
  view.projection = core::Projection::kEquirectangular;
  const cull::Frustum frustum = cull::make_frustum(view);
  EXPECT_EQ(frustum.count, 0);
  const BoundingRegion behind{{mars::Face::kMinusX, -1, 1, -1, 1}, kRadius_m, kRadius_m + 1};
  EXPECT_EQ(cull::planes_crossed(frustum, cull::bounding_hexahedron(behind), cull::all_planes(frustum)),
            cull::PlaneMask{0});
}

TEST(Horizon, NeverHidesAPointThatIsSeenOverTheLowestSphere) {
  Random random(26);
  int hides = 0;
  for (int trial = 0; trial < 30000; ++trial) {
    const double occluder = kRadius_m - random.uniform(0, 8200);
    const glm::dvec3 up = hostile_direction(random);
    const double re =
        random.integer(0, 2) == 0 ? occluder + random.log_uniform(1e-6, 10) : hostile_radius(random);
    const cull::Camera camera = cull::make_camera(up * re);
    const cull::Horizon horizon = cull::make_horizon(camera, occluder);
    if (re <= occluder) {
      ASSERT_FALSE(horizon.hides);
    }
    // The farthest point of radius rmax that is seen: on the tangent, beyond the point of contact.
    const double rmax = occluder + random.log_uniform(1e-6, 3e4);
    const long double o = occluder;
    const auto reach = [&](double r) { return std::atan2(std::sqrt((r - o) * (r + o)), o); };
    const long double limit = re > occluder ? reach(re) + reach(rmax) : 3.14L;
    const auto chord2 = [](long double angle) {
      return static_cast<double>(4 * std::pow(std::sin(angle / 2), 2));
    };
    ASSERT_FALSE(cull::hidden(horizon, chord2(limit), rmax)) << trial;
    ASSERT_FALSE(cull::hidden(horizon, chord2(limit * random.uniform(0, 1)), rmax));
    // Through the geometry too: a speck of a tile at that place.
    const glm::dvec3 side = glm::normalize(glm::cross(mars::any_perpendicular(up), random.direction()));
    const glm::dvec3 ahead = glm::normalize(side - up * glm::dot(side, up));
    const auto c = static_cast<double>(std::cos(limit));
    const auto s = static_cast<double>(std::sin(limit));
    const mars::ChartRect speck = rect_around(random, mars::chart_point(up * c + ahead * s), 1e-16);
    ASSERT_FALSE(cull::hidden(horizon, cull::nearest_chord2(speck, camera.direction), rmax)) << trial;
    // And it hides what is a hundred metres and a hundredth beyond.
    if (re > occluder + 1e-3) {
      ASSERT_TRUE(cull::hidden(horizon, chord2(limit * 1.01L + 100 / o), rmax)) << re - occluder;
      ++hides;
    }
  }
  EXPECT_GT(hides, 15000);
}

TEST(Horizon, NeverHidesATileWithAVisiblePoint) {
  Random random(27);
  int hidden = 0;
  int seen = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const glm::dvec3 away = hostile_direction(random);
    const glm::dvec3 camera_m = away * hostile_radius(random);
    const cull::Camera camera = cull::make_camera(camera_m);
    const double low = kLowest_m + random.uniform(0, 20000);
    const BoundingRegion region{random_rect(random), low, low + random.log_uniform(0.1, 10000)};
    const cull::Horizon horizon = cull::make_horizon(camera, kLowest_m);
    const bool gone =
        cull::hidden(horizon, cull::nearest_chord2(region.rect, camera.direction), region.max_radius_m);
    hidden += gone ? 1 : 0;
    for (int sample = 0; sample < 8; ++sample) {
      const glm::dvec2 at{random.integer(0, 4) / 4.0, random.integer(0, 4) / 4.0};
      const glm::dvec3 point =
          region_point(region.rect, at.x, at.y, random.uniform(region.min_radius_m, region.max_radius_m));
      const glm::dvec3 step = point - camera_m;
      const double t = std::clamp(-glm::dot(camera_m, step) / glm::dot(step, step), 0.0, 1.0);
      const bool visible = glm::length(camera_m + t * step) >= kLowest_m + 1e-6;
      seen += visible ? 1 : 0;
      ASSERT_FALSE(gone && visible) << trial;
    }
  }
  EXPECT_GT(hidden, 2000);
  EXPECT_GT(seen, 5000);
}

TEST(Horizon, WhatHasGroundBehindItIsNeverSeenAgainstTheSky) {
  Random random(17);
  int ground = 0;
  int loose = 0;
  for (int trial = 0; trial < 100000; ++trial) {
    const glm::dvec3 away = random.direction();
    const cull::Camera camera = cull::make_camera(away * (kLowest_m + random.log_uniform(1, 1e8)));
    const cull::Horizon horizon = cull::make_horizon(camera, kLowest_m);
    const double top = kLowest_m + random.log_uniform(1, 30000);
    const double angle = random.log_uniform(1e-6, 3.0);
    const double chord = 2.0 * std::sin(0.5 * angle);
    const bool sky = cull::against_sky(camera, horizon, chord * chord, top);
    const glm::dvec3 aside = glm::normalize(glm::cross(camera.direction, random.direction()));
    double passes = 0;  // how close to the planet's centre the rays come, at most
    for (int n = 0; n < 20; ++n) {
      const double a = n == 0 ? angle : random.uniform(0, angle);
      const double radius = n == 0 ? top : random.uniform(kLowest_m, top);
      const glm::dvec3 from = camera.direction * camera.radius_m;
      const glm::dvec3 to = radius * (std::cos(a) * camera.direction + std::sin(a) * aside);
      const glm::dvec3 ray = glm::normalize(to - from);
      passes = std::max(passes, glm::dot(ray, from) < 0 ? glm::length(glm::cross(from, ray)) : top);
    }
    if (sky) {
      loose += passes < kLowest_m * (1 - 1e-9) && camera.radius_m > top ? 1 : 0;
    } else {
      ++ground;
      ASSERT_LT(passes, kLowest_m) << "trial " << trial;
    }
  }
  EXPECT_GT(ground, 20000);
  EXPECT_LT(loose, 20000);
}

TEST(Horizon, BelowTheOccluderNothingIsHidden) {
  const cull::Camera camera = cull::make_camera({0, 0, kLowest_m});
  const cull::Horizon horizon = cull::make_horizon(camera, kLowest_m);
  EXPECT_FALSE(horizon.hides);
  EXPECT_FALSE(cull::hidden(horizon, 4.0, kLowest_m));
  EXPECT_FALSE(cull::make_horizon(cull::make_camera({0, 0, 1}), 0.0).hides);
  EXPECT_FALSE(cull::make_horizon(cull::make_camera({0, 0, 1}), -5.0).hides);
}

}  // namespace
