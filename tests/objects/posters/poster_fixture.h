// Images of known colours, and places before a camera, for the tests of images in the world.
#pragma once

#include <memory>
#include <random>
#include <span>
#include <vector>

#include "objects/draw/composer.h"
#include "objects/draw/seen_posters.h"

namespace objects::test {

namespace core = vpe::core;
using vpe::base::Rgb;

inline constexpr double kRadius_m = 3.4e6;
inline constexpr Rgb kPaper{10, 20, 30};

// Returns an image whose red counts columns and whose green counts rows, as far as bytes do.
inline PosterImage ramp_image(int width, int height) {
  Texture t{width, height, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      t.texels.push_back({static_cast<std::uint8_t>(255 * x / std::max(1, width - 1)),
                          static_cast<std::uint8_t>(255 * y / std::max(1, height - 1)), 77, 255});
    }
  }
  return {std::make_shared<const TexturePyramid>(std::move(t)), width, height};
}

inline PosterImage plain_image(Rgb c, int width = 4, int height = 4) {
  Texture t{width, height, {}};
  t.texels.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), {c.r, c.g, c.b, 255});
  return {std::make_shared<const TexturePyramid>(std::move(t)), width, height};
}

inline core::DrawRequest request_of(int width = 160, int height = 120) {
  core::DrawRequest r;
  r.view.camera.position_m = {kRadius_m + 1000, 0, 0};
  r.view.camera.axes.forward = {0, 1, 0};
  r.view.camera.axes.up = {1, 0, 0};
  r.view.camera.axes.right = glm::cross(r.view.camera.axes.forward, r.view.camera.axes.up);
  r.view.width = width;
  r.view.height = height;
  r.view.fov_deg = 50;
  r.settings.mode = core::Mode::kUnlit;
  r.settings.smooth_edges = false;
  r.settings.lod_tolerance_px = 0;
  r.sun = glm::normalize(glm::dvec3(1, -1, 0.3));
  return r;
}

inline core::Frame empty_frame(const core::DrawRequest& r) {
  core::Frame f;
  const glm::ivec2 size = core::drawn_size(r.view);
  f.width = size.x;
  f.height = size.y;
  f.colour.assign(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y), kPaper);
  f.range_m.assign(f.colour.size(), core::kSkyRange);
  return f;
}

// Returns a pane that faces the camera of a request from right, up and forward of it.
inline PlacedPoster pane_before(const core::DrawRequest& r, PosterImage image, const glm::dvec3& at_m,
                                double width_m, double tall_m) {
  PlacedPoster p;
  p.form = PosterForm::kPane;
  p.image = std::move(image);
  p.axes = r.view.camera.axes;
  p.middle_m = r.view.camera.position_m + at_m.x * p.axes.right + at_m.y * p.axes.up + at_m.z * p.axes.forward;
  p.width_m = width_m;
  p.tall_m = tall_m;
  return p;
}

inline ComposedObjects draw_posters(const core::DrawRequest& r, std::span<const PlacedPoster> posters,
                                    core::Frame& frame, const Scene& scene = {}, int threads = 1) {
  vpe::base::ThreadPool pool(threads);
  return compose(scene, {r, kRadius_m, nullptr}, level_rule(r, false), pool, frame, {}, posters);
}

inline std::size_t pixel_at(const core::Frame& f, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(f.width) + static_cast<std::size_t>(x);
}

}  // namespace objects::test
