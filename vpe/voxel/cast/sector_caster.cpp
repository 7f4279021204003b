#include "vpe/voxel/cast/sector_caster.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "vpe/voxel/cast/facet_finder.h"
#include "vpe/voxel/cast/fixed_step_marcher.h"
#include "vpe/voxel/cast/refine.h"

namespace vpe::voxel {

namespace {

// Between the lines of fans where they are farthest apart.
constexpr double kSpacing_px = 1.0;
constexpr int kTaskRows = 32;
constexpr int kTaskColumns = 128;
// Share of a hint that a ray is cast before and behind it.
constexpr double kAround = 0.04;

// For one thread.
struct RowHints {
  explicit RowHints(int width)
      : a(static_cast<std::size_t>(width)),
        b(static_cast<std::size_t>(width)),
        share(static_cast<std::size_t>(width)) {}
  std::vector<float> a;
  std::vector<float> b;
  std::vector<float> share;
  std::vector<int> open;
};

// About the nearer hint, then from the farther one on; from the eye where either is too far (Wan 1999, section
// 4).
double cast_near(const paging::Surface& surface, const glm::dvec3& eye, const glm::dvec3& ray,
                 double exaggeration, float a, float b) {
  const auto near = static_cast<double>(std::min(a, b));
  const auto far = static_cast<double>(std::max(a, b));
  if (std::isfinite(near)) {
    const double begin = (1.0 - kAround) * near;
    const double end = (1.0 + kAround) * near;
    double range = surface.cast(eye, ray, exaggeration, {begin, end});
    if (std::isfinite(range) && range != begin) return range;
    if (range != begin && std::isfinite(far)) {
      const double beyond = std::max((1.0 - kAround) * far, end);
      range = surface.cast(eye, ray, exaggeration, {beyond, std::numeric_limits<double>::infinity()});
      if (range != beyond) return range;
    }
  }
  return surface.cast(eye, ray, exaggeration);
}

// The same over the walk's lattices, in steps.
double march_near(const ColumnWalk& walk, FacetFinder& finder, const glm::dvec3& eye, const glm::dvec3& ray,
                  float a, float b) {
  const auto near = static_cast<double>(std::min(a, b));
  const double begin = std::isfinite(near) ? (1.0 - kAround) * near : 0.0;
  const double range = march(eye, ray, begin, walk.highest_m(), finder, walk.eye().radius_m);
  return range == begin ? march(eye, ray, 0, walk.highest_m(), finder, walk.eye().radius_m) : range;
}

}  // namespace

std::size_t FanCaster::bytes() const {
  std::size_t total = 0;
  for (const auto& s : samples_) total += s.capacity() * sizeof(float);
  return total;
}

void FanCaster::cast_fans(const FanPlan& plan, const ColumnWalk& walk, Desks& desks, base::ThreadPool& pool) {
  std::vector<Sheet> sheets;
  samples_.resize(std::max(samples_.size(), plan.fans().size()));
  for (std::size_t f = 0; f < plan.fans().size(); ++f) {
    const Fan& fan = plan.fans()[f];
    samples_[f].resize(static_cast<std::size_t>(fan.steps) * static_cast<std::size_t>(fan.lines));
    Sheet& sheet = sheets.emplace_back();
    sheet.rows.kind = RowKind::kFan;
    sheet.rows.count = fan.steps;
    sheet.columns = fan.lines;
    // Stored by step.
    sheet.stride = fan.rising ? fan.lines : -static_cast<std::ptrdiff_t>(fan.lines);
    sheet.out = samples_[f].data() + (fan.rising ? 0 : std::ptrdiff_t{fan.lines} * (fan.steps - 1));
    sheet.set_column = [&plan, &fan](int column, ColumnGroup& group, int lane, glm::dvec3& azimuth) {
      const FanLine line = plan.line(fan, column);
      azimuth = line.azimuth;
      group.fan_a0[lane] = line.a0;
      group.fan_a1[lane] = line.a1;
      group.fan_b0[lane] = line.b0;
      group.fan_b1[lane] = line.b1;
      group.row[lane] = static_cast<float>(line.row_begin);
      group.row_end[lane] = static_cast<float>(line.row_end);
    };
  }
  cast_sheets(sheets, walk, desks, pool);
}

// Samples on either side of pixels [first, last) of one row, in that row or column of samples.
void FanCaster::find_hints(const FanPlan& plan, const core::SubRectangle& part, int row, int first_pixel,
                           int last_pixel, float* a, float* b, float* share) const {
  const double y = part.y + row + 0.5;
  FanPlan::Span span = plan.upright_span(row);
  span.begin = std::clamp(span.begin, first_pixel, last_pixel);
  span.end = std::clamp(span.end, span.begin, last_pixel);
  const auto none = [&](int k) {
    a[k] = std::numeric_limits<float>::infinity();
    b[k] = 0;
    share[k] = 0;
  };
  const auto samples = [&](const Fan& fan) {
    return samples_[static_cast<std::size_t>(&fan - plan.fans().data())].data();
  };
  if (span.begin < span.end) {
    if (const Fan* fan = plan.fan_of(plan.side_of(part.x + span.begin + 0.5, y))) {
      const int step = std::clamp(part.y + row - fan->first_step, 0, fan->steps - 1);
      const Fan::Map& map = fan->maps[static_cast<std::size_t>(step)];
      const double first =
          (map.stretch * (part.x + span.begin + 0.5) + map.shift - fan->first_line) / fan->spacing;
      hints_from_row(samples(*fan) + std::ptrdiff_t{step} * fan->lines, fan->lines, first,
                     map.stretch / fan->spacing, span.end - span.begin, a + span.begin, b + span.begin,
                     share + span.begin);
    } else {
      for (int k = span.begin; k < span.end; ++k) none(k);
    }
  }
  const auto beside = [&](int begin, int end) {
    if (begin >= end) return;
    const Fan* fan = plan.fan_of(plan.side_of(part.x + begin + 0.5, y));
    if (fan == nullptr) {
      for (int k = begin; k < end; ++k) none(k);
      return;
    }
    // Pixels that the fan's steps leave out have their neighbours' samples.
    const int first = std::clamp(fan->first_step - part.x, begin, end);
    const int last = std::clamp(fan->first_step + fan->steps - part.x, first, end);
    if (first == last) {
      for (int k = begin; k < end; ++k) none(k);
      return;
    }
    const auto step = static_cast<std::size_t>(part.x + first - fan->first_step);
    hints_from_columns(samples(*fan) + static_cast<std::ptrdiff_t>(step) * fan->lines, fan->lines,
                       fan->line_stretch.data() + step, fan->line_shift.data() + step,
                       static_cast<float>(y - fan->origin), last - first, a + first, b + first, share + first);
    for (int k = begin; k < end; ++k) {
      const int from = std::clamp(k, first, last - 1);
      if (from == k) continue;
      a[k] = a[from];
      b[k] = b[from];
      share[k] = share[from];
    }
  };
  beside(first_pixel, span.begin);
  beside(span.end, last_pixel);
}

void FanCaster::cast(const core::View& view, const ColumnWalk& walk, Desks& desks,
                     const paging::Surface& surface, double exaggeration, bool exact, base::ThreadPool& pool,
                     std::span<float> range_m) {
  const FanPlan plan(view, walk.eye().up, kSpacing_px);
  cast_fans(plan, walk, desks, pool);
  const core::SubRectangle part = core::drawn_part(view);
  const mars::Axes& axes = view.eye.axes;
  const double focal = core::focal_px(view);
  const double cx = 0.5 * view.width + view.principal_offset_px.x;
  const double cy = 0.5 * view.height + view.principal_offset_px.y;
  const int tasks = (part.height + kTaskRows - 1) / kTaskRows;
  pool.run(static_cast<std::size_t>(tasks), [&](std::size_t task) {
    const Desks::Use use(desks);
    FacetFinder finder(walk, use.shelf());
    FacetFinder exact_finder(walk, use.shelf());
    RowHints hints(part.width);
    const int first = static_cast<int>(task) * kTaskRows;
    const int last = std::min(first + kTaskRows, part.height);
    // In blocks, so that neighbouring rows find their samples and lattices at hand.
    for (int begin = 0; begin < part.width; begin += kTaskColumns) {
      const int end = std::min(begin + kTaskColumns, part.width);
      for (int row = first; row < last; ++row) {
        find_hints(plan, part, row, begin, end, hints.a.data(), hints.b.data(), hints.share.data());
        float* const out =
            range_m.data() + static_cast<std::size_t>(row) * static_cast<std::size_t>(part.width) + begin;
        RayRow rays;
        rays.eye_m = view.eye.eye_m;
        rays.radius_m = walk.eye().radius_m;
        rays.first = (part.x + begin + 0.5 - cx) * axes.right + (cy - (part.y + row + 0.5)) * axes.up +
                     focal * axes.forward;
        rays.step = axes.right;
        rays.count = end - begin;
        hints.open.clear();
        const float* const a = hints.a.data() + begin;
        const float* const b = hints.b.data() + begin;
        const float* const share = hints.share.data() + begin;
        refine_row(rays, a, b, share, finder, exact_finder, out, hints.open);
        for (const int k : hints.open) {
          const glm::dvec3 ray = glm::normalize(rays.first + static_cast<double>(k) * rays.step);
          out[k] = static_cast<float>(exact ? cast_near(surface, view.eye.eye_m, ray, exaggeration, a[k], b[k])
                                            : march_near(walk, finder, view.eye.eye_m, ray, a[k], b[k]));
        }
      }
    }
  });
}

}  // namespace vpe::voxel
