// Fixture of the tests of the polygon backend: one context for a suite.
#pragma once

#include <memory>

#include "mars/geodesy/sun.h"
#include "tests/paging/planet_fixture.h"
#include "vpe/core/metrics.h"
#include "vpe/gl/polygon_renderer.h"

namespace test_support {

class GlTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { context_ = vpe::gl::Context::create(); }
  static void TearDownTestSuite() { context_.reset(); }

  std::unique_ptr<vpe::core::Renderer> renderer(std::shared_ptr<const paging::PlanetFile> planet,
                                                std::size_t memory = std::size_t{256} << 20) {
    return vpe::gl::make_polygon_renderer(context_, std::move(planet), {memory, 2, {}});
  }

  static std::shared_ptr<vpe::gl::Context> context_;
  TempDir dir_;
};
inline std::shared_ptr<vpe::gl::Context> GlTest::context_;

// Returns a request for one sample a pixel, coloured, lit from the northwest, with ranges.
inline vpe::core::DrawRequest request_for(const mars::Pose& pose, double radius_m, int width, int height,
                                          double fov_deg = 60) {
  vpe::core::DrawRequest request;
  request.view.camera = mars::to_camera(pose, radius_m);
  request.view.width = width;
  request.view.height = height;
  request.view.fov_deg = fov_deg;
  request.settings.samples = 1;
  request.settings.mode = vpe::core::Mode::kColoured;
  request.sun = mars::sun_direction({pose.lon_deg, pose.lat_deg}, 315, 40);
  request.want_range = true;
  return request;
}

// Returns the ranges that an exact cast of the reference surface gives.
inline std::vector<float> reference_ranges(const paging::Surface& surface, const vpe::core::View& view) {
  const glm::ivec2 size = vpe::core::drawn_size(view);
  std::vector<float> out;
  out.reserve(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y));
  for (int y = 0; y < size.y; ++y) {
    for (int x = 0; x < size.x; ++x) {
      out.push_back(static_cast<float>(surface.cast(
          view.camera.position_m, vpe::core::pixel_ray(view, view.part.x + x + 0.5, view.part.y + y + 0.5))));
    }
  }
  return out;
}

// Returns the radius of the reference surface as a function of directions.
inline vpe::core::SurfaceRadius radius_of(const paging::Surface& surface) {
  return [&surface](std::span<const glm::dvec3> directions, std::span<double> radius_m) {
    surface.radius(directions, radius_m);
  };
}

}  // namespace test_support
