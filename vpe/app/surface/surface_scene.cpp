#include "vpe/app/surface/surface_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "mars/geodesy/cube.h"
#include "relief/cast/caster.h"
#include "relief/field/stack.h"
#include "relief/files/relief_file.h"
#include "relief/files/surface_file.h"
#include "relief/relief.h"
#include "vpe/app/surface/surface_maps.h"

namespace vpe::app {

namespace {

using ShapePointer = std::shared_ptr<const relief::Shape>;
using FaceShapes = std::array<ShapePointer, mars::kFaces>;

struct Totals {
  double facet_deviation_m = 0;
  std::size_t posts = 0;

  void add(const relief::HeightMap& map) {
    posts += static_cast<std::size_t>(map.layout().columns) * static_cast<std::size_t>(map.layout().rows);
  }
};

// Returns the shape of one plane: the only layer itself, or a stack. Null for none.
ShapePointer composed(std::vector<relief::StackLayer> layers) {
  if (layers.empty()) return nullptr;
  if (layers.size() == 1 && layers.front().compose == relief::Compose::kSum) return layers.front().shape;
  return std::make_shared<const relief::Stack>(std::move(layers));
}

FaceShapes mapped_faces(const relief::SurfaceFile& file, Totals& totals) {
  std::array<std::vector<relief::StackLayer>, mars::kFaces> layers;
  for (const relief::MapEntry& entry : file.maps) {
    const FaceMaps maps = face_maps(entry, file);
    const FaceMaps masks = entry.mask.empty() ? FaceMaps{} : face_maps(entry, file, true);
    double deviation_m = 0;
    for (std::size_t face = 0; face < layers.size(); ++face) {
      layers[face].push_back({maps[face], entry.compose, masks[face]});
      deviation_m = std::max(deviation_m, maps[face]->facet_deviation_m());
      totals.add(*maps[face]);
    }
    totals.facet_deviation_m += deviation_m;
  }
  FaceShapes shapes;
  for (std::size_t face = 0; face < layers.size(); ++face) shapes[face] = composed(std::move(layers[face]));
  return shapes;
}

// Returns the shapes after the changes of reliefs, sampled at posts. Neighbours have the same posts on their edge.
FaceShapes changed_faces(const relief::SurfaceFile& file, const FaceShapes& below,
                         std::vector<relief::ReliefSpec> specs, Totals& totals) {
  const auto height_m = [&](mars::Face face, double u, double v) {
    const ShapePointer& shape = below[static_cast<std::size_t>(face)];
    return shape != nullptr ? shape->height_m(u * file.radius_m, v * file.radius_m) : 0.0;
  };
  const auto height_towards_m = [&](const glm::dvec3& d) {
    const mars::ChartPoint at = mars::chart_point(d);
    return height_m(at.face, at.u, at.v);
  };
  const relief::Relief all = relief::place(
      std::move(specs), [&](const glm::dvec3& d) { return base_radius_m(file.base, d); }, height_towards_m);
  const FaceGrid grid(file.radius_m, file.relief_posts);
  FaceShapes shapes;
  double deviation_m = 0;
  for (int n = 0; n < mars::kFaces; ++n) {
    const auto face = static_cast<mars::Face>(n);
    std::vector<float> heights_m;
    std::vector<double> ground_m(static_cast<std::size_t>(grid.side()));
    std::vector<relief::ReliefChange> changes(ground_m.size());
    for (int j = 0; j < grid.side(); ++j) {
      const std::vector<glm::dvec3> directions = grid.row(face, j);
      for (int i = 0; i < grid.side(); ++i) {
        const auto n_th = static_cast<std::size_t>(i);
        const double u = grid.coordinate(i);
        const double v = grid.coordinate(j);
        // Beyond the face the ground is that of its neighbour: a finer map ends nearer to the edge than this ring.
        const bool is_beyond = std::abs(u) > 1 || std::abs(v) > 1;
        ground_m[n_th] = is_beyond ? height_towards_m(directions[n_th]) : height_m(face, u, v);
      }
      all.change(directions, ground_m, changes);
      for (const relief::ReliefChange& change : changes)
        heights_m.push_back(static_cast<float>(change.height_m));
    }
    const auto map = std::make_shared<relief::HeightMap>(grid.layout(), std::move(heights_m),
                                                         relief::Interpolation::kBicubic);
    deviation_m = std::max(deviation_m, map->facet_deviation_m());
    totals.add(*map);
    shapes[static_cast<std::size_t>(n)] = map;
  }
  totals.facet_deviation_m = deviation_m;
  return shapes;
}

SurfaceScene round_scene(const relief::SurfaceFile& file) {
  Totals totals;
  FaceShapes shapes = mapped_faces(file, totals);
  std::size_t count = 0;
  if (!file.reliefs.empty()) {
    std::vector<relief::ReliefSpec> specs = relief::read_relief_file(file.reliefs);
    count = specs.size();
    if (count > 0) shapes = changed_faces(file, shapes, std::move(specs), totals);
  }
  const relief::Rect face{-file.radius_m, -file.radius_m, file.radius_m, file.radius_m};
  double highest_m = 0;
  for (const ShapePointer& shape : shapes)
    if (shape != nullptr) highest_m = std::max(highest_m, shape->bounds_m(face).high);
  return {relief::cube_surface(file.base, file.radius_m, shapes),
          true,
          {0, 0, 0},
          file.radius_m + highest_m,
          totals.facet_deviation_m,
          totals.posts,
          count};
}

// Finds the ball around the ground over the area, by rays from far above.
void find_extent(const relief::SurfaceFile& file, SurfaceScene& scene) {
  constexpr int kRays = 17;  // a side
  const relief::Rect& area = file.area_m;
  const double above_m = 1e3 * std::max(area.x1_m - area.x0_m, area.y1_m - area.y0_m);
  std::vector<glm::dvec3> ground_m;
  for (int j = 0; j < kRays; ++j) {
    for (int i = 0; i < kRays; ++i) {
      // The rays stay within the border.
      const double x_m = area.x0_m + (i + 0.5) / kRays * (area.x1_m - area.x0_m);
      const double y_m = area.y0_m + (j + 0.5) / kRays * (area.y1_m - area.y0_m);
      const double range_m = relief::cast_ray(scene.surface, {x_m, y_m, above_m}, {0, 0, -1}, 0, 2 * above_m);
      if (range_m < relief::kNoHit) ground_m.emplace_back(x_m, y_m, above_m - range_m);
    }
  }
  if (ground_m.empty())
    throw std::runtime_error(
        file.path.string() +
        ": there is no ground over its size_m, as seen against z; check matrix, linear and constant");
  glm::dvec3 low_m = ground_m.front();
  glm::dvec3 high_m = low_m;
  for (const glm::dvec3& p_m : ground_m) {
    low_m = glm::min(low_m, p_m);
    high_m = glm::max(high_m, p_m);
  }
  scene.middle_m = 0.5 * (low_m + high_m);
  // The outer rays are half a step within the border.
  scene.radius_m = 0.5 * glm::length(high_m - low_m) * kRays / (kRays - 1);
}

SurfaceScene plane_scene(const relief::SurfaceFile& file) {
  Totals totals;
  std::vector<relief::StackLayer> layers;
  for (const relief::MapEntry& entry : file.maps) {
    const auto map = plane_map(entry, file);
    layers.push_back({map, entry.compose, entry.mask.empty() ? nullptr : plane_map(entry, file, true)});
    totals.facet_deviation_m += map->facet_deviation_m();
    totals.add(*map);
  }
  SurfaceScene scene{relief::parallel_surface(file.base, {0, 0, 0}, {1, 0, 0}, {0, 1, 0},
                                              composed(std::move(layers)), file.area_m),
                     false,
                     {0, 0, 0},
                     0,
                     totals.facet_deviation_m,
                     totals.posts,
                     0};
  find_extent(file, scene);
  return scene;
}

}  // namespace

SurfaceScene open_surface(const std::filesystem::path& path) {
  const relief::SurfaceFile file = relief::read_surface_file(path);
  return relief::is_round(file.base) ? round_scene(file) : plane_scene(file);
}

}  // namespace vpe::app
