// What the tests of objects in images share: a camera before an empty frame, and models.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <utility>
#include <vector>

#include "objects/draw/composer.h"
#include "objects/levels/mesh_levels.h"
#include "objects/model/shapes.h"

namespace objects {

namespace core = vpe::core;
using vpe::base::Rgb;

inline constexpr double kRadius_m = 3.4e6;
inline constexpr Rgb kPaper{10, 20, 30};

inline std::shared_ptr<const Model> model_of(Mesh mesh) {
  Model::Level level;
  level.mesh = std::move(mesh);
  level.tree = TriangleTree(level.mesh);
  std::vector<Model::Level> levels;
  levels.push_back(std::move(level));
  return std::make_shared<const Model>("model", std::move(levels));
}

// The camera looks along +y from above the equator's meridian 0; up is +x (away from the planet), right is -z... the
// axes only have to be right-handed.
inline core::DrawRequest request_at(double height_m = 1000) {
  core::DrawRequest r;
  r.view.camera.position_m = {kRadius_m + height_m, 0, 0};
  r.view.camera.axes.forward = {0, 1, 0};
  r.view.camera.axes.up = {1, 0, 0};
  r.view.camera.axes.right = glm::cross(r.view.camera.axes.forward, r.view.camera.axes.up);
  r.view.width = 200;
  r.view.height = 160;
  r.view.fov_deg = 50;
  r.settings.mode = core::Mode::kUnlit;
  r.settings.smooth_edges = false;
  r.settings.lod_tolerance_px = 0;
  r.sun = glm::normalize(glm::dvec3(1, -1, 0.3));
  return r;
}

inline core::Frame paper_frame(const core::DrawRequest& r) {
  core::Frame f;
  const glm::ivec2 size = core::drawn_size(r.view);
  f.width = size.x;
  f.height = size.y;
  f.colour.assign(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y), kPaper);
  f.range_m.assign(f.colour.size(), core::kSkyRange);
  return f;
}

inline Instance instance_before(const core::DrawRequest& r, const glm::dvec3& right_up_forward) {
  Instance i;
  const mars::Axes& a = r.view.camera.axes;
  i.position_m = r.view.camera.position_m + right_up_forward.x * a.right + right_up_forward.y * a.up +
                 right_up_forward.z * a.forward;
  // Model axes: x right, y forward, z up.
  const glm::dmat3 m(a.right, a.forward, a.up);
  i.rotation = glm::quat(glm::normalize(glm::quat_cast(m)));
  return i;
}

inline ComposedObjects draw(const Scene& scene, const core::DrawRequest& r, core::Frame& frame,
                            const core::GroundLight* ground = nullptr, int threads = 1,
                            std::span<const std::uint8_t> only = {}) {
  vpe::base::ThreadPool pool(threads);
  return compose(scene, {r, kRadius_m, ground}, level_rule(r, false), pool, frame, only);
}

inline glm::dvec3 ray_at(const core::DrawRequest& r, int x, int y) {
  const core::SubRectangle part = core::drawn_part(r.view);
  return core::pixel_ray(r.view, part.x + x + 0.5, part.y + y + 0.5);
}

inline std::size_t at(const core::Frame& f, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(f.width) + static_cast<std::size_t>(x);
}

}  // namespace objects
