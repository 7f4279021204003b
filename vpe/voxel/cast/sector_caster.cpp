#include "vpe/voxel/cast/sector_caster.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>

#include "vpe/voxel/cast/facet_finder.h"
#include "vpe/voxel/cast/fixed_step_marcher.h"
#include "vpe/voxel/cast/nearest_samples.h"
#include "vpe/voxel/columns/refine.h"

namespace vpe::voxel {

namespace {

constexpr int kTaskRows = kRayBlockRows;
constexpr int kTaskColumns = kRayBlockColumns;

// Gives the hints of a block's rows by a function.
template <class Get>
class BlockOfHints : public BlockHints {
 public:
  explicit BlockOfHints(Get get) : get_(get) {}
  void get(int row, float* a, float* b, float* share) override { get_(row, a, b, share); }

 private:
  Get get_;
};

// Returns the blocks of pixels of `part` that a rectangle touches, as a pixel's last bits depend on those of its block.
core::SubRectangle in_whole_blocks(const core::SubRectangle& only, const core::SubRectangle& part) {
  const auto down = [](int x, int step) { return x / step * step; };
  const int x0 = std::max(only.x - part.x, 0);
  const int x1 = std::min(only.x + only.width - part.x, part.width);
  const int y0 = std::max(only.y - part.y, 0);
  const int y1 = std::min(only.y + only.height - part.y, part.height);
  if (x0 >= x1 || y0 >= y1) return {};
  const int begin = down(x0, kTaskColumns);
  const int end = std::min(down(x1 - 1, kTaskColumns) + kTaskColumns, part.width);
  const int begin_row = down(y0, kTaskRows);
  const int end_row = std::min(down(y1 - 1, kTaskRows) + kTaskRows, part.height);
  return {part.x + begin, part.y + begin_row, end - begin, end_row - begin_row};
}

// Casts about the nearer hint, over the walk's height grids in fixed steps, and from the camera if the hint lies
// too far.
double march_near(const ColumnWalk& walk, FacetFinder& finder, const glm::dvec3& camera, const glm::dvec3& ray,
                  float a, float b) {
  const auto near = static_cast<double>(std::min(a, b));
  const double begin = std::isfinite(near) ? (1.0 - kAroundRange) * near : 0.0;
  const double range = march(camera, ray, begin, walk.highest_m(), finder, walk.camera().radius_m);
  return range == begin ? march(camera, ray, 0, walk.highest_m(), finder, walk.camera().radius_m) : range;
}

}  // namespace

std::size_t SectorCaster::bytes() const {
  std::size_t total = 0;
  for (const auto& s : samples_) total += s.capacity() * sizeof(float);
  return total;
}

void SectorCaster::cast_sectors(const SectorPlan& plan, const core::SubRectangle& pixels,
                                const ColumnWalk& walk, ScratchPool& scratches, base::ThreadPool& pool) {
  std::vector<ColumnBatch> batches;
  samples_.resize(std::max(samples_.size(), plan.sectors().size()));
  for (std::size_t f = 0; f < plan.sectors().size(); ++f) {
    const ViewSector& sector = plan.sectors()[f];
    const SectorPlan::Window window = SectorPlan::window(sector, pixels);
    if (!window.is_empty()) batches.push_back(sector_batch(plan, sector, window, samples_[f]));
  }
  cast_columns(batches, walk, scratches, pool);
}

void SectorCaster::prefetch_beside(const SectorPlan& plan, const core::SubRectangle& block) const {
  const auto side = [&](int x, int y) { return plan.side_of(x + 0.5, y + 0.5); };
  const int last_x = block.x + block.width - 1;
  const int last_y = block.y + block.height - 1;
  const SectorPlan::Side corner = side(block.x, block.y);
  const auto is_alike = [&](const SectorPlan::Side& other) {
    return other.upright && other.forward == corner.forward;
  };
  // Upright samples of a row lie side by side.
  if (corner.upright && is_alike(side(last_x, block.y)) && is_alike(side(block.x, last_y)) &&
      is_alike(side(last_x, last_y)))
    return;
  for (int x = block.x; x <= last_x; ++x) {
    const SectorPlan::Side top = side(x, block.y);
    const SectorPlan::Side at = top.upright ? side(x, last_y) : top;
    const ViewSector* const sector = at.upright ? nullptr : plan.sector_of(at);
    if (sector == nullptr || x < sector->first_step || x >= sector->first_step + sector->steps) continue;
    const auto step = static_cast<std::size_t>(x - sector->first_step);
    const auto line = [&](int y) {
      const double place = static_cast<double>(sector->line_scale[step]) * (y + 0.5 - sector->origin) +
                           static_cast<double>(sector->line_shift[step]);
      return static_cast<std::ptrdiff_t>(std::clamp(place, 0.0, sector->lines - 1.0));
    };
    const auto [low, high] = std::minmax({line(block.y), line(last_y)});
    const float* const from = samples_[static_cast<std::size_t>(sector - plan.sectors().data())].data() +
                              static_cast<std::ptrdiff_t>(step) * sector->lines;
    constexpr std::ptrdiff_t kCacheLine = 16;
    for (std::ptrdiff_t k = low; k < high + kCacheLine; k += kCacheLine)
      __builtin_prefetch(from + std::min(k, high));
  }
}

void SectorCaster::find_hints(const SectorPlan& plan, const core::SubRectangle& part, int row, int first_pixel,
                              int last_pixel, float* a, float* b, float* share) const {
  const double y = part.y + row + 0.5;
  SectorPlan::Span span = plan.upright_span(row);
  span.begin = std::clamp(span.begin, first_pixel, last_pixel);
  span.end = std::clamp(span.end, span.begin, last_pixel);
  const auto none = [&](int k) {
    a[k - first_pixel] = std::numeric_limits<float>::infinity();
    b[k - first_pixel] = 0;
    share[k - first_pixel] = 0;
  };
  const auto samples = [&](const ViewSector& sector) {
    return samples_[static_cast<std::size_t>(&sector - plan.sectors().data())].data();
  };
  if (span.begin < span.end) {
    if (const ViewSector* sector = plan.sector_of(plan.side_of(part.x + span.begin + 0.5, y))) {
      const int step = std::clamp(part.y + row - sector->first_step, 0, sector->steps - 1);
      const ViewSector::Map& map = sector->maps[static_cast<std::size_t>(step)];
      const double first =
          (map.scale * (part.x + span.begin + 0.5) + map.shift - sector->first_line) / sector->spacing;
      hints_from_row(samples(*sector) + std::ptrdiff_t{step} * sector->lines, sector->lines, first,
                     map.scale / sector->spacing, span.end - span.begin, a + (span.begin - first_pixel),
                     b + (span.begin - first_pixel), share + (span.begin - first_pixel));
    } else {
      for (int k = span.begin; k < span.end; ++k) none(k);
    }
  }
  // Sets pixels whose samples are of one sector.
  const auto beside = [&](const ViewSector* sector, int begin, int end) {
    if (sector == nullptr) {
      for (int k = begin; k < end; ++k) none(k);
      return;
    }
    // Pixels outside the sector's steps take the samples of their neighbours.
    const int first = std::clamp(sector->first_step - part.x, begin, end);
    const int last = std::clamp(sector->first_step + sector->steps - part.x, first, end);
    if (first == last) {
      for (int k = begin; k < end; ++k) none(k);
      return;
    }
    const auto step = static_cast<std::size_t>(part.x + first - sector->first_step);
    hints_from_columns(samples(*sector) + static_cast<std::ptrdiff_t>(step) * sector->lines, sector->lines,
                       sector->line_scale.data() + step, sector->line_shift.data() + step,
                       static_cast<float>(y - sector->origin), last - first, a + (first - first_pixel),
                       b + (first - first_pixel), share + (first - first_pixel));
    const auto copy = [&](int from, int to_begin, int to_end) {
      for (float* const out : {a, b, share})
        std::fill(out + (to_begin - first_pixel), out + (to_end - first_pixel), out[from - first_pixel]);
    };
    copy(first, begin, first);
    copy(last - 1, last, end);
  };
  const auto all_beside = [&](int begin, int end) {
    while (begin < end) {
      const SectorPlan::Side side = plan.side_of(part.x + begin + 0.5, y);
      const int count = plan.steps_alike(side, part.x + begin, end - begin);
      beside(plan.sector_of(side), begin, begin + count);
      begin += count;
    }
  };
  all_beside(first_pixel, span.begin);
  all_beside(span.end, last_pixel);
}

void SectorCaster::take_nearest(const core::View& view, const SectorPlan& plan,
                                const core::SubRectangle& pixels, const ColumnWalk& walk,
                                ScratchPool& scratches, const SingleRays* single_rays, base::ThreadPool& pool,
                                std::span<float> range_m) const {
  const core::SubRectangle part = core::drawn_part(view);
  const NearestSamples nearest(plan, samples_, part);
  const int tasks = (pixels.height + kTaskRows - 1) / kTaskRows;
  pool.run(static_cast<std::size_t>(tasks), [&](std::size_t task) {
    std::vector<int> missed;
    const int first = pixels.y - part.y + static_cast<int>(task) * kTaskRows;
    const int last = std::min(first + kTaskRows, pixels.y - part.y + pixels.height);
    const int end_column = pixels.x - part.x + pixels.width;
    for (int begin = pixels.x - part.x; begin < end_column; begin += kTaskColumns) {
      prefetch_beside(
          plan, {part.x + begin, part.y + first, std::min(kTaskColumns, end_column - begin), last - first});
      for (int row = first; row < last; ++row) {
        float* const out =
            range_m.data() + static_cast<std::size_t>(row) * static_cast<std::size_t>(part.width);
        missed.clear();
        nearest.get(row, begin, std::min(begin + kTaskColumns, end_column), out, &missed);
        for (const int x : missed) {
          const glm::dvec3 ray = core::pixel_ray(view, part.x + x + 0.5, part.y + row + 0.5);
          std::optional<double> range;
          if (single_rays != nullptr) range = single_rays->cast(view.camera.position_m, ray);
          if (!range) {
            const ScratchPool::Lease scratch = scratches.acquire();
            FacetFinder finder(walk, scratch->tiles);
            range = march(view.camera.position_m, ray, 0, walk.highest_m(), finder, walk.camera().radius_m);
          }
          out[x] = static_cast<float>(*range);
        }
      }
    }
  });
}

void SectorCaster::cast(const core::View& view, const SectorForm& form, const ColumnWalk& walk,
                        ScratchPool& scratches, const SingleRays* single_rays, base::ThreadPool& pool,
                        std::span<float> range_m, const core::SubRectangle& only) {
  const core::SubRectangle part = core::drawn_part(view);
  const core::SubRectangle pixels = only.width > 0 ? in_whole_blocks(only, part) : part;
  if (pixels.width <= 0 || pixels.height <= 0) return;
  const SectorPlan plan(view, walk.camera().up, form.spacing_px, form.most_rings);
  cast_sectors(plan, pixels, walk, scratches, pool);
  if (form.is_nearest) return take_nearest(view, plan, pixels, walk, scratches, single_rays, pool, range_m);
  const mars::Axes& axes = view.camera.axes;
  const double focal = core::focal_px(view);
  const double cx = 0.5 * view.width + view.principal_offset_px.x;
  const double cy = 0.5 * view.height + view.principal_offset_px.y;
  const int first_row = pixels.y - part.y;
  const int end_row = first_row + pixels.height;
  const int first_column = pixels.x - part.x;
  const int tasks = (pixels.height + kTaskRows - 1) / kTaskRows;
  pool.run(static_cast<std::size_t>(tasks), [&](std::size_t task) {
    const ScratchPool::Lease scratch = scratches.acquire();
    FacetFinder finder(walk, scratch->tiles);
    FacetFinder exact_finder(walk, scratch->tiles);
    std::vector<UnresolvedPixel> unresolved;
    const int first = first_row + static_cast<int>(task) * kTaskRows;
    const int last = std::min(first + kTaskRows, end_row);
    // In blocks, so that neighbouring rows find their samples and height grids in the caches.
    for (int begin = first_column; begin < first_column + pixels.width; begin += kTaskColumns) {
      const int end = std::min(begin + kTaskColumns, first_column + pixels.width);
      prefetch_beside(plan, {part.x + begin, part.y + first, end - begin, last - first});
      RayBlock rays;
      rays.camera_m = view.camera.position_m;
      rays.radius_m = walk.camera().radius_m;
      rays.first = (part.x + begin + 0.5 - cx) * axes.right + (cy - (part.y + first + 0.5)) * axes.up +
                   focal * axes.forward;
      rays.step = axes.right;
      rays.down = -axes.up;
      rays.columns = end - begin;
      rays.rows = last - first;
      BlockOfHints hints([&](int row, float* a, float* b, float* share) {
        find_hints(plan, part, first + row, begin, end, a, b, share);
      });
      float* const out =
          range_m.data() + static_cast<std::size_t>(first) * static_cast<std::size_t>(part.width) + begin;
      unresolved.clear();
      refine_block(rays, hints, finder, exact_finder, out, part.width, unresolved);
      for (const UnresolvedPixel& pixel : unresolved) {
        const glm::dvec3 ray = glm::normalize(rays.ray(pixel.row, pixel.column));
        std::optional<double> range;
        if (single_rays != nullptr)
          range = single_rays->cast_near(view.camera.position_m, ray, pixel.a, pixel.b);
        if (!range) range = march_near(walk, finder, view.camera.position_m, ray, pixel.a, pixel.b);
        out[std::ptrdiff_t{pixel.row} * part.width + pixel.column] = static_cast<float>(*range);
      }
    }
  });
}

}  // namespace vpe::voxel
