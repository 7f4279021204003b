#include "vpe/voxel/cast/discrete_caster.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <stdexcept>

#include "vpe/voxel/cast/nearest_samples.h"
#include "vpe/voxel/cast/sector_batch.h"
#include "vpe/voxel/columns/pixel_lines.h"
#include "vpe/voxel/columns/view_sector.h"

namespace vpe::voxel {

namespace {

constexpr int kNearestRows = 32;

std::size_t index_of(int row, int width, int x) {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
}

void cast_sectors(const core::View& view, const ColumnWalk& walk, int rays, ScratchPool& scratches,
                  base::ThreadPool& pool, SectorSamples& samples, std::span<float> range_m) {
  const core::View fine = with_finer_pixels(view, rays);
  const SectorPlan plan(fine, walk.camera().up, rays, 1);
  samples.resize(std::max(samples.size(), plan.sectors().size()));
  std::vector<ColumnBatch> batches;
  for (std::size_t f = 0; f < plan.sectors().size(); ++f) {
    const ViewSector& sector = plan.sectors()[f];
    batches.push_back(sector_batch(plan, sector, {0, sector.lines, 0, sector.steps}, samples[f]));
    batches.back().rows.has_ranges = true;
  }
  cast_columns(batches, walk, scratches, pool);
  const core::SubRectangle part = core::drawn_part(view);
  const NearestSamples nearest(plan, samples, part, rays);
  pool.run(static_cast<std::size_t>((part.height + kNearestRows - 1) / kNearestRows), [&](std::size_t task) {
    const int first = static_cast<int>(task) * kNearestRows;
    for (int row = first; row < std::min(first + kNearestRows, part.height); ++row)
      nearest.get(row, 0, part.width, range_m.data() + index_of(rays * row, part.width, 0));
  });
}

void cast_lines(const core::View& view, const ColumnWalk& walk, ScratchPool& scratches, base::ThreadPool& pool,
                SectorSamples& samples_of_lines, std::span<float> range_m) {
  const core::SubRectangle part = core::drawn_part(view);
  const mars::Axes& axes = view.camera.axes;
  const glm::dvec3& up = walk.camera().up;
  const PixelLines lines(part.width, part.height, {glm::dot(up, axes.right), -glm::dot(up, axes.up)});
  const double focal = core::focal_px(view);
  const glm::dvec2 centre = glm::dvec2(view.width, view.height) * 0.5 + view.principal_offset_px;
  const auto ray = [&](const glm::dvec2& xy) {
    const glm::dvec2 at = glm::dvec2(part.x, part.y) + xy - centre;
    return at.x * axes.right - at.y * axes.up + focal * axes.forward;
  };
  std::vector<std::vector<PixelLines::Pixel>> pixels(static_cast<std::size_t>(lines.count()));
  std::size_t longest = 0;
  for (int n = 0; n < lines.count(); ++n) {
    lines.get(n, pixels[static_cast<std::size_t>(n)]);
    longest = std::max(longest, pixels[static_cast<std::size_t>(n)].size());
  }
  const auto of_pixel = [](const PixelLines::Pixel& p) { return glm::dvec2(p.x + 0.5, p.y + 0.5); };
  const glm::dvec2 first_step = [&] {
    for (const auto& line : pixels) {
      if (line.size() == longest && longest > 1)
        return (of_pixel(line.back()) - of_pixel(line.front())) / static_cast<double>(longest - 1);
    }
    return glm::dvec2(0, -1);
  }();
  // Rays of a line are even along it, which its pixels are within half a pixel.
  struct Column {
    glm::dvec3 azimuth;
    double a0, a1, b0, b1;
  };
  std::vector<Column> columns;
  for (const auto& line : pixels) {
    const double last = static_cast<double>(line.size()) - 1;
    const glm::dvec2 from = of_pixel(line.front());
    const glm::dvec2 step = line.size() > 1 ? (of_pixel(line.back()) - from) / last : first_step;
    const glm::dvec3 begin = ray(from);
    const glm::dvec3 per_row = step.x * axes.right - step.y * axes.up;
    const glm::dvec3 middle = begin + 0.5 * last * per_row;
    const glm::dvec3 level = middle - glm::dot(middle, up) * up;
    const glm::dvec3 azimuth = glm::normalize(level);
    const Column c{azimuth, glm::dot(begin, up), glm::dot(per_row, up), glm::dot(begin, azimuth),
                   glm::dot(per_row, azimuth)};
    constexpr double kLeast = 1e-3;  // of the focal length
    if (!(c.b0 > kLeast * focal) || !(c.b0 + last * c.b1 > kLeast * focal))
      throw std::runtime_error(
          "rays.columns=lines takes each line of pixels as one vertical plane, and here lines pass the point straight below or "
          "above the camera: use --set rays.columns=sectors");
    columns.push_back(c);
  }
  samples_of_lines.resize(std::max<std::size_t>(samples_of_lines.size(), 1));
  std::vector<float>& samples = samples_of_lines.front();
  const std::size_t needed = longest * pixels.size();
  if (samples.size() < needed) samples.resize(needed);
  ColumnBatch batch;
  batch.rows.kind = RowKind::kSector;
  batch.rows.count = static_cast<int>(longest);
  batch.rows.has_ranges = true;
  batch.columns = lines.count();
  batch.stride = lines.count();
  batch.out = samples.data();
  batch.set_column = [&](int column, ColumnGroup& group, int lane, glm::dvec3& azimuth) {
    const Column& c = columns[static_cast<std::size_t>(column)];
    azimuth = c.azimuth;
    group.sector_a0[lane] = c.a0;
    group.sector_a1[lane] = c.a1;
    group.sector_b0[lane] = c.b0;
    group.sector_b1[lane] = c.b1;
    group.row_end[lane] = static_cast<float>(pixels[static_cast<std::size_t>(column)].size());
  };
  cast_columns({&batch, 1}, walk, scratches, pool);
  for (std::size_t n = 0; n < pixels.size(); ++n) {
    for (std::size_t r = 0; r < pixels[n].size(); ++r)
      range_m[index_of(pixels[n][r].y, part.width, pixels[n][r].x)] = samples[r * pixels.size() + n];
  }
}

}  // namespace

core::View with_finer_pixels(core::View view, int rays) {
  view.width *= rays;
  view.height *= rays;
  view.principal_offset_px *= static_cast<double>(rays);
  view.part = {view.part.x * rays, view.part.y * rays, view.part.width * rays, view.part.height * rays};
  return view;
}

void cast_discretely(const core::View& view, const ColumnWalk& walk, const DiscreteForm& form,
                     ScratchPool& scratches, base::ThreadPool& pool, SectorSamples& samples,
                     std::span<float> range_m) {
  if (form.columns == core::RayColumns::kSectors)
    return cast_sectors(view, walk, form.rays, scratches, pool, samples, range_m);
  if (form.rays != 1) throw std::invalid_argument("lines of pixels have one ray a pixel");
  cast_lines(view, walk, scratches, pool, samples, range_m);
}

}  // namespace vpe::voxel
