// Rays, cones and solid angles of squares of pixels.
#include "objects/draw/pixel_square.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/ext/scalar_constants.hpp>

namespace objects {
namespace {

namespace core = vpe::core;

core::View any_view(core::Projection projection) {
  core::View view;
  view.camera = mars::to_camera({30, -20, 4000, 70, -15, 8}, mars::kMarsRadius_m);
  view.projection = projection;
  view.width = 640;
  view.height = 360;
  view.fov_deg = 65;
  view.principal_offset_px =
      projection == core::Projection::kPerspective ? glm::dvec2(11.5, -7.25) : glm::dvec2(0);
  view.part = {64, 32, 320, 256};
  return view;
}

constexpr core::Projection kAll[] = {core::Projection::kPerspective, core::Projection::kCylinder,
                                     core::Projection::kEquirectangular};

TEST(PixelSquare, RaysAreThoseOfTheView) {
  for (const core::Projection projection : kAll) {
    const core::View view = any_view(projection);
    const ViewRays rays(view);
    for (double y = -3; y < 370; y += 13.7) {
      for (double x = -5; x < 650; x += 17.3)
        EXPECT_LT(glm::distance(rays.at(x, y), core::pixel_ray(view, x, y)), 2e-15) << x << " " << y;
    }
  }
}

TEST(PixelSquare, ConesHoldTheirRays) {
  for (const core::Projection projection : kAll) {
    const core::View view = any_view(projection);
    const ViewRays rays(view);
    for (const PixelSquare& square : {PixelSquare{0, 0, 64, 64}, PixelSquare{192, 128, 256, 192},
                                      PixelSquare{312, 248, 320, 256}, PixelSquare{100, 0, 108, 8}}) {
      const ViewCone cone = cone_of(view, rays, square, 1);
      for (double y = square.y0 - 1.0; y <= square.y1 + 1.0; y += 0.5) {
        for (double x = square.x0 - 1.0; x <= square.x1 + 1.0; x += 0.5)
          EXPECT_GE(glm::dot(cone.axis, rays.at(view.part.x + x, view.part.y + y)), cone.cosine - 1e-15);
      }
    }
  }
}

// The solid angles of all pixels of a round image, and of a perspective one, sum to those of their closed forms.
TEST(PixelSquare, SolidAnglesSumToTheWhole) {
  for (const core::Projection projection : kAll) {
    core::View view = any_view(projection);
    view.principal_offset_px = {0, 0};
    view.part = {};
    const ViewRays rays(view);
    double sum = 0;
    for (int y = 0; y < view.height; ++y) {
      for (int x = 0; x < view.width; ++x) sum += pixel_solid_angle(view, rays.at(x + 0.5, y + 0.5));
    }
    const double half = 0.5 * view.fov_deg * mars::kRadiansPerDegree;
    double whole = 4 * glm::pi<double>() * std::sin(half);
    if (projection == core::Projection::kPerspective) {
      const double a = std::tan(half);
      const double b = a * view.width / view.height;
      whole = 4 * std::asin(a * b / std::sqrt((1 + a * a) * (1 + b * b)));
    }
    EXPECT_NEAR(sum, whole, 1e-4 * whole);
  }
}

TEST(PixelSquare, GroundBesideAPixelIsOnItsPlane) {
  core::Frame frame;
  frame.width = 5;
  frame.height = 5;
  // 1 / range is linear over a plane; one column shows something nearer.
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 5; ++x)
      frame.range_m.push_back(x == 4 ? 2.0F : 1.0F / (0.01F + 0.001F * static_cast<float>(x + 2 * y)));
  }
  frame.range_m[0] = core::kSkyRange;
  const GroundRanges ground(frame, {0, 0, 5, 5});
  EXPECT_NEAR(ground.beside(2, 2, {0.25, -0.5}), 1 / (0.016 + 0.00025 - 0.001), 1e-3);
  EXPECT_NEAR(ground.beside(3, 2, {0.4, 0}), 1 / 0.017, 1e-3);  // no part of what is nearer
  EXPECT_TRUE(std::isinf(ground.beside(0, 0, {0.1, 0.1})));
  EXPECT_TRUE(std::isinf(ground.farthest_m()));
  EXPECT_NEAR(ground.nearest_m(), 2, 1e-6);
  EXPECT_NEAR(ground.farthest_ground_m(), 1 / 0.011, 1e-3);
  EXPECT_EQ(ground.at(-1, 2), ground.at(0, 2));
}

}  // namespace
}  // namespace objects
