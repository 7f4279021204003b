// Bounds of patches, against what linear interpolation over triangles really does.
#include "vpe/overlook/direction_patch.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <random>

#include "mars/geodesy/sphere.h"
#include "panorama/viewer/viewer.h"
#include "tests/overlook/overlook_fixture.h"

namespace {

using namespace vpe::overlook;
using overlook_test::maps;
using panorama::MapKind;
using panorama::PanoramaMap;

constexpr unsigned kSeed = 20261127;

double angle_rad(const glm::dvec3& a, const glm::dvec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

Rectangle random_rectangle(const PanoramaMap& map, std::mt19937& random, double widest_px) {
  const auto number = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  const double width = number(1, std::min(widest_px, static_cast<double>(map.width_px)));
  const double height = number(1, std::min(widest_px, static_cast<double>(map.height_px)));
  Rectangle r;
  r.left = number(0, static_cast<double>(map.width_px) - width);
  r.right = r.left + width;
  if (map.kind == MapKind::kFacets) {
    const double facet_px = map.facet_px();
    r.left = (facet_of(map, r.left) + number(0, 0.5)) * facet_px;
    r.right = r.left + number(0.01, 0.5) * facet_px;
  }
  r.top = number(0, static_cast<double>(map.height_px) - height);
  r.bottom = r.top + height;
  return r;
}

TEST(DirectionPatch, VectorsPointToWhatTheMapShows) {
  std::mt19937 random(kSeed);
  for (const PanoramaMap& map : maps()) {
    for (int n = 0; n < 300; ++n) {
      const Rectangle r = random_rectangle(map, random, 400);
      const double x = std::lerp(r.left, r.right, 0.3);
      const double y = std::lerp(r.top, r.bottom, 0.7);
      const glm::dvec3 is = direction_vector(map, facet_of(map, x), x, y);
      EXPECT_LT(angle_rad(is, panorama::to_vector(map.to_direction(x, y))), 1e-12)
          << to_string(map.kind) << " " << x << " " << y << " seed " << kSeed;
    }
  }
}

TEST(DirectionPatch, CapsHoldTheirRectangles) {
  std::mt19937 random(kSeed);
  for (const PanoramaMap& map : maps()) {
    for (int n = 0; n < 200; ++n) {
      const Rectangle r = random_rectangle(map, random, 900);
      const int facet = facet_of(map, 0.5 * (r.left + r.right));
      const Cap cap = cap_of(map, facet, r);
      EXPECT_NEAR(glm::length(cap.axis), 1, 1e-12);
      const glm::dvec2 sides = sides_rad(map, facet, r);
      EXPECT_GT(sides.x, 0);
      EXPECT_GE(sides.x + sides.y, cap.radius_rad);
      for (int k = 0; k <= 100; ++k) {
        const glm::dvec3 d = direction_vector(map, facet, std::lerp(r.left, r.right, k % 11 / 10.0),
                                              std::lerp(r.top, r.bottom, k / 11 / 9.0));
        EXPECT_LE(angle_rad(d, cap.axis), cap.radius_rad + 1e-9) << to_string(map.kind) << " seed " << kSeed;
      }
    }
  }
}

// The pixel's direction is that of the point in a cell's triangle; what is shown is the place interpolated there.
double worst_shift_rad(const PanoramaMap& map, int facet, const Rectangle& r, const Cuts& cuts) {
  double worst = 0;
  const double dx = (r.right - r.left) / cuts.across;
  const double dy = (r.bottom - r.top) / cuts.down;
  for (int row = 0; row < cuts.down; ++row) {
    for (int half = 0; half < 2; ++half) {
      const glm::dvec2 a{r.left + (half == 0 ? 0 : dx), r.top + row * dy + (half == 0 ? 0 : dy)};
      const glm::dvec2 b{r.left + dx, r.top + row * dy};
      const glm::dvec2 c{r.left, r.top + (row + 1) * dy};
      for (int n = 0; n <= 8; ++n) {
        for (int m = 0; n + m <= 8; ++m) {
          const double s = n / 8.0;
          const double t = m / 8.0;
          const glm::dvec3 point = (1 - s - t) * direction_vector(map, facet, a.x, a.y) +
                                   s * direction_vector(map, facet, b.x, b.y) +
                                   t * direction_vector(map, facet, c.x, c.y);
          const glm::dvec2 place = (1 - s - t) * a + s * b + t * c;
          worst = std::max(worst, angle_rad(point, direction_vector(map, facet, place.x, place.y)));
        }
      }
    }
  }
  return worst;
}

TEST(DirectionPatch, ShiftsAreWithinTheirBound) {
  std::mt19937 random(kSeed);
  double closest = 0;
  for (const PanoramaMap& map : maps()) {
    for (int n = 0; n < 200; ++n) {
      const Rectangle r = random_rectangle(map, random, 500);
      const int facet = facet_of(map, 0.5 * (r.left + r.right));
      const double allowed_rad =
          std::exp(std::uniform_real_distribution(std::log(1e-7), std::log(1e-2))(random));
      const Cuts cuts = cuts_of(map, r, allowed_rad);
      const double bound = largest_shift_rad(map, r, cuts);
      EXPECT_LE(bound, allowed_rad);
      const double is = worst_shift_rad(map, facet, r, cuts);
      EXPECT_LE(is, bound + 1e-14) << to_string(map.kind) << " seed " << kSeed;
      if (bound > 0) closest = std::max(closest, is / bound);
      // Fewer cuts are not enough, or none are made.
      if (cuts.across > 2) {
        const Cuts fewer{cuts.across / 2, std::max(1, cuts.down / 2)};
        EXPECT_GT(largest_shift_rad(map, r, fewer), allowed_rad);
      }
    }
  }
  EXPECT_GT(closest, 0.3) << "the bound is far from what happens";
  RecordProperty("worst_share_of_bound", std::to_string(closest));
}

}  // namespace
