#include "tests/bench/figures/ray_figures_samples.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>

#include "vpe/voxel/cast/facet_finder.h"
#include "vpe/voxel/cast/sector_batch.h"
#include "vpe/voxel/columns/refine.h"

namespace bench {

namespace {

namespace core = vpe::core;
namespace voxel = vpe::voxel;

voxel::ColumnCamera column_camera(const Scene& scene, const core::View& view) {
  const double distance_m = glm::length(view.camera.position_m);
  const glm::dvec3 up = view.camera.position_m / distance_m;
  return {up, distance_m, scene.surface().planet_radius_m(), scene.surface().at(up).radius_m};
}

// Casts the columns of a sector. Returns its samples, step by step.
std::vector<float> cast_sector(const Scene& scene, const voxel::SectorPlan& plan,
                               const voxel::ViewSector& sector, const voxel::ColumnWalk& walk) {
  std::vector<float> samples;
  const voxel::ColumnBatch batch =
      voxel::sector_batch(plan, sector, {0, sector.lines, 0, sector.steps}, samples);
  voxel::ScratchPool scratches = voxel::make_scratch_pool(scene.caster->store(), 1);
  voxel::cast_columns({&batch, 1}, walk, scratches, *scene.pool);
  return samples;
}

}  // namespace

std::vector<HintedPixel> hinted_pixels(const Scene& scene, const core::View& view) {
  const voxel::ColumnWalk walk(scene.surface(), column_camera(scene, view), 1, {0, core::focal_px(view)});
  const voxel::SectorPlan plan(view, walk.camera().up, 1);
  const voxel::ViewSector* const sector = plan.sector_of({true, false});
  if (sector == nullptr) throw std::runtime_error("the image has no sector above V");
  const std::vector<float> samples = cast_sector(scene, plan, *sector, walk);
  const std::vector<float> finished = cast_image(scene, view);
  voxel::ThreadLocalTiles tiles(scene.caster->store(), 1, nullptr);
  voxel::FacetFinder finder(walk, tiles);
  voxel::FacetFinder exact_finder(walk, tiles);
  const mars::Axes& axes = view.camera.axes;
  std::vector<HintedPixel> pixels;
  for (int step = 0; step < sector->steps; ++step) {
    const int y = sector->first_step + step;
    const voxel::SectorPlan::Span span = plan.upright_span(y);
    const int count = span.end - span.begin;
    if (count <= 0) continue;
    const auto room = static_cast<std::size_t>(count);
    std::vector<float> a(room);
    std::vector<float> b(room);
    std::vector<float> share(room);
    std::vector<float> range(room);
    std::vector<int> unresolved;
    const voxel::ViewSector::Map& map = sector->maps[static_cast<std::size_t>(step)];
    const double first = (map.scale * (span.begin + 0.5) + map.shift - sector->first_line) / sector->spacing;
    const double per_pixel = map.scale / sector->spacing;
    voxel::hints_from_row(samples.data() + std::ptrdiff_t{step} * sector->lines, sector->lines, first,
                          per_pixel, count, a.data(), b.data(), share.data());
    voxel::RayRow rays;
    rays.camera_m = view.camera.position_m;
    rays.radius_m = walk.camera().radius_m;
    rays.first = (span.begin + 0.5 - 0.5 * view.width) * axes.right +
                 (0.5 * view.height - (y + 0.5)) * axes.up + core::focal_px(view) * axes.forward;
    rays.step = axes.right;
    rays.count = count;
    voxel::refine_row(rays, a.data(), b.data(), share.data(), finder, exact_finder, range.data(), unresolved);
    for (int k = 0; k < count; ++k) {
      const auto at = static_cast<std::size_t>(k);
      if (!std::isfinite(a[at]) || !std::isfinite(b[at])) continue;
      HintedPixel pixel;
      pixel.x = span.begin + k;
      pixel.y = y;
      pixel.hint_m[0] = static_cast<double>(a[at]);
      pixel.hint_m[1] = static_cast<double>(b[at]);
      pixel.share = static_cast<double>(share[at]);
      const double line = std::floor(first + k * per_pixel);
      for (int side = 0; side < 2; ++side) {
        const double s_reference = sector->first_line + sector->spacing * (line + side);
        pixel.sample[side] = {(s_reference - map.shift) / map.scale, y + 0.5};
      }
      pixel.refined = std::find(unresolved.begin(), unresolved.end(), k) == unresolved.end();
      pixel.range_m =
          static_cast<double>(finished[static_cast<std::size_t>(y) * static_cast<std::size_t>(view.width) +
                                       static_cast<std::size_t>(pixel.x)]);
      constexpr double kRounding = 1e-5;
      if (pixel.refined && std::abs(static_cast<double>(range[at]) - pixel.range_m) > kRounding * pixel.range_m)
        throw std::runtime_error("the stages do not give the finished image");
      pixels.push_back(pixel);
    }
  }
  return pixels;
}

}  // namespace bench
