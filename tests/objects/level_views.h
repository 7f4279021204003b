// Random scenes of models with levels before random cameras, and how far what is drawn lies from the models.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <limits>
#include <memory>
#include <vector>

#include "objects/model/distance_tree.h"
#include "objects/sticks/build_sticks.h"
#include "objects/sticks/voxelise.h"
#include "tests/objects/composer_fixture.h"
#include "tests/support/support.h"

namespace objects::level_views {

using ::test_support::Random;

// Holds a model with the surfaces of its levels.
struct KnownModel {
  std::shared_ptr<const Model> model;
  std::vector<DistanceTree> surfaces;  // empty: of sticks
  bool is_thick = true;                // has no parts that are much thinner than the whole
};

inline KnownModel known(std::shared_ptr<const Model> model, bool is_thick) {
  KnownModel out{std::move(model), {}, is_thick};
  for (const Model::Level& level : out.model->levels()) out.surfaces.emplace_back(level.mesh);
  return out;
}

inline std::shared_ptr<const Model> levels_of(Mesh mesh) {
  for (Material& m : mesh.material_table) m.colour = {255, 255, 255, 255};
  return std::make_shared<const Model>("mesh", make_levels(std::move(mesh)));
}

inline std::shared_ptr<const Model> sticks_of(const Mesh& mesh, int voxels) {
  Mesh white = mesh;
  for (Material& m : white.material_table) m.colour = {255, 255, 255, 255};
  return std::make_shared<const Model>(
      "sticks", std::make_shared<const StickModel>(
                    build_sticks(voxelise(white, {}, {.voxels_longest = voxels, .is_tight = true}))));
}

// Returns a mast with a foot, arms and a dish: many parts, some of them thin.
inline Mesh make_mast() {
  Mesh mesh;
  const Rgba white{255, 255, 255, 255};
  const auto at = [](float x, float y, float z) { return glm::translate(glm::mat4(1), {x, y, z}); };
  append(mesh, make_box({0.8F, 0.6F, 0.2F}), at(0, 0, 0), white);
  append(mesh, make_cylinder(0.05F, 1.6F, 40), at(0, 0, 0.2F), white);
  for (int n = 0; n < 6; ++n)
    append(mesh, make_ellipsoid({0.12F, 0.12F, 0.12F}, 20),
           at(-0.35F + 0.14F * static_cast<float>(n), 0.1F * static_cast<float>(n % 2), 0.3F), white);
  append(mesh, make_torus(0.3F, 0.04F, 48, 16), at(0, 0, 1.8F), white);
  append(mesh, make_cone(0.2F, 0.3F, 40), at(0, 0, 1.5F), white);
  return mesh;
}

inline const std::vector<KnownModel>& known_models() {
  static const std::vector<KnownModel> models = [] {
    std::vector<KnownModel> out;
    out.push_back(known(levels_of(make_rock(5, 5)), true));
    out.push_back(known(levels_of(make_torus(1, 0.35F, 96, 48)), true));
    out.push_back(known(levels_of(make_mast()), false));
    out.push_back(known(sticks_of(make_rock(7, 3), 128), true));
    out.push_back(known(sticks_of(make_torus(1, 0.35F, 48, 24), 96), true));
    return out;
  }();
  return models;
}

// Returns the point of a triangle that is nearest to a place.
inline glm::dvec3 nearest_in_triangle(const glm::dvec3& p, const std::array<glm::dvec3, 3>& at) {
  const glm::dvec3 normal = glm::cross(at[1] - at[0], at[2] - at[0]);
  const double size2 = glm::dot(normal, normal);
  glm::dvec3 best = at[0];
  const auto offer = [&](const glm::dvec3& q) {
    if (glm::distance(p, q) < glm::distance(p, best)) best = q;
  };
  bool is_inside = size2 > 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::dvec3 side = at[(k + 1) % 3] - at[k];
    const double length2 = glm::dot(side, side);
    const double along = length2 > 0 ? std::clamp(glm::dot(p - at[k], side) / length2, 0.0, 1.0) : 0.0;
    offer(at[k] + along * side);
    is_inside = is_inside && glm::dot(glm::cross(side, p - at[k]), normal) >= 0;
  }
  if (is_inside) offer(p - normal * (glm::dot(p - at[0], normal) / size2));
  return best;
}

// Returns the point of a level's voxels that is nearest to a place, among those within reach_m along each axis; infinite if
// none is. Model frame.
inline glm::dvec3 nearest_in_voxels(const StickModel::Level& level, const glm::dvec3& at_m, double reach_m) {
  const StickGrid& grid = level.grid;
  const auto edge_m = static_cast<double>(grid.voxel_m);
  const glm::dvec3 at = (at_m - glm::dvec3(grid.corner_m)) / edge_m;
  const double reach = reach_m / edge_m + 1;
  glm::dvec3 best(std::numeric_limits<double>::infinity());
  double least = std::numeric_limits<double>::infinity();
  const auto first = [&](double x) { return std::max(0, static_cast<int>(std::floor(x - reach))); };
  const auto last = [&](double x, int count) {
    return std::min(count - 1, static_cast<int>(std::floor(x + reach)));
  };
  for (int y = first(at.y); y <= last(at.y, grid.columns_y); ++y) {
    for (int x = first(at.x); x <= last(at.x, grid.columns_x); ++x) {
      const auto column =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(grid.columns_x) + static_cast<std::size_t>(x);
      const StickModel::Stick& stick = level.sticks[level.columns[column]];
      for (std::size_t n = 0; n < stick.runs; ++n) {
        const StickModel::Run& run = level.runs[stick.first_run + n];
        const glm::dvec3 near =
            glm::clamp(at, glm::dvec3(x, y, run.begin), glm::dvec3(x + 1, y + 1, run.begin + run.length));
        if (glm::distance(near, at) >= least) continue;
        least = glm::distance(near, at);
        best = glm::dvec3(grid.corner_m) + edge_m * near;
      }
    }
  }
  return best;
}

// Returns the point of an object's level that is nearest to a place, body-fixed.
inline glm::dvec3 nearest_on(const KnownModel& known, const PlacedObject& placed, std::size_t level,
                             const glm::dvec3& at_m, double reach_m) {
  const glm::dvec3 local_m = placed.to_model * (at_m - placed.position_m);
  const auto scale = static_cast<double>(placed.scale);
  glm::dvec3 near_m(std::numeric_limits<double>::infinity());
  if (known.surfaces.empty()) {
    near_m = nearest_in_voxels(known.model->sticks()->levels()[level], local_m, reach_m / scale);
  } else {
    const DistanceTree& surface = known.surfaces[level];
    near_m = nearest_in_triangle(local_m, surface.corners_m(surface.nearest(local_m).triangle));
  }
  return placed.position_m + scale * (placed.to_body * near_m);
}

}  // namespace objects::level_views
