// Paints an image of given ranges by its definition, one pixel after the other, with TerrainShader::colour_at,
// haze and sky. The reference for tests and benchmarks of vpe/voxel/paint/image_painter.h.
#pragma once

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <memory>
#include <vector>

#include "paging/shading/terrain_shader.h"
#include "vpe/base/parallel.h"
#include "vpe/core/appearance/shading.h"
#include "vpe/core/appearance/sky.h"
#include "vpe/core/frame.h"

namespace test_support {

class PaintedByPoint {
 public:
  PaintedByPoint(std::shared_ptr<const paging::PlanetFile> planet, std::size_t memory_bytes)
      : planet_(std::move(planet)), shader_(planet_, memory_bytes) {}

  std::vector<vpe::base::Rgb> paint(const vpe::core::DrawRequest& request, const std::vector<float>& range_m,
                                    vpe::base::ThreadPool& pool) const {
    namespace core = vpe::core;
    const core::Appearance& appearance = request.settings;
    const bool has_image = planet_->meta().finest_image_level >= 0;
    std::shared_ptr<const core::ColourScale> scale;
    if (paging::needs_scale(appearance, has_image))
      scale = std::make_shared<const core::ColourScale>(appearance);
    const paging::ShadingParams shading = paging::shading_params(appearance, request.sun, has_image, scale);
    const core::View& view = request.view;
    const core::SubRectangle part = core::drawn_part(view);
    const auto width = static_cast<std::size_t>(part.width);
    std::vector<vpe::base::Rgb> out(width * static_cast<std::size_t>(part.height));
    pool.run(static_cast<std::size_t>(part.height), [&](std::size_t y) {
      paging::TerrainShader::Cursor cursor;
      for (std::size_t x = 0; x < width; ++x) {
        const glm::dvec3 ray =
            core::pixel_ray(view, part.x + static_cast<double>(x) + 0.5, part.y + static_cast<double>(y) + 0.5);
        const glm::dvec3 c =
            colour(request, shading, ray, static_cast<double>(range_m[y * width + x]), cursor) + 0.5;
        out[y * width + x] = {static_cast<std::uint8_t>(std::min(c.x, 255.0)),
                              static_cast<std::uint8_t>(std::min(c.y, 255.0)),
                              static_cast<std::uint8_t>(std::min(c.z, 255.0))};
      }
    });
    return out;
  }

 private:
  glm::dvec3 colour(const vpe::core::DrawRequest& request, const paging::ShadingParams& shading,
                    const glm::dvec3& ray, double range_m, paging::TerrainShader::Cursor& cursor) const {
    namespace core = vpe::core;
    const glm::dvec3& camera = request.view.camera.position_m;
    const double radius = planet_->radius_m();
    const core::SkyAir& air = core::air_of(request.settings.atmosphere);
    if (std::isinf(range_m)) {
      if (request.settings.background == core::Background::kBlack) return glm::dvec3(0);
      if (request.settings.background == core::Background::kWhite) return glm::dvec3(255);
      return core::sky_colour(air, camera, ray, request.sun, radius);
    }
    const glm::dvec3 up = glm::normalize(camera + range_m * ray);
    const glm::dvec3 ground =
        glm::clamp(shader_.colour_at(up, range_m / core::focal_px(request.view), shading, cursor)
                       .value_or(glm::dvec3(105)),
                   0.0, 255.0);
    if (!(request.settings.haze_visibility_m > 0.0)) return ground;
    const double camera_radius = glm::length(camera);
    const double length_m =
        core::air_m(radius, camera_radius - radius, glm::dot(ray, camera) / camera_radius, range_m);
    return glm::mix(core::haze_colour(air.haze, glm::dot(up, request.sun)), ground,
                    core::transmittance(length_m, request.settings.haze_visibility_m));
  }

  std::shared_ptr<const paging::PlanetFile> planet_;
  paging::TerrainShader shader_;
};

}  // namespace test_support
