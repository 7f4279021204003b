#include "objects/sticks/stick_spans.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace objects {

namespace {

constexpr double kEver = std::numeric_limits<double>::infinity();

// A line along an axis, in voxels. Neighbours share the t of the side between them to the bit.
struct LineAxis {
  double origin = 0;
  double step = 0;  // for a unit of t

  double t_of(int side) const { return (side - origin) / step; }
  // Where the line enters and leaves cells: a stretch that is empty if it runs beside them.
  SolidSpan within(int begin, int end) const {
    if (step == 0) return origin >= begin && origin < end ? SolidSpan{-kEver, kEver} : SolidSpan{kEver, -kEver};
    return step > 0 ? SolidSpan{t_of(begin), t_of(end)} : SolidSpan{t_of(end), t_of(begin)};
  }
  int cell_at(double t, int cells) const {
    const double at = std::floor(step == 0 ? origin : origin + step * t);
    return static_cast<int>(std::clamp(at, 0.0, static_cast<double>(cells - 1)));
  }
};

SolidSpan common(const SolidSpan& a, const SolidSpan& b) {
  return {std::max(a.begin, b.begin), std::min(a.end, b.end)};
}

// A stretch in one column.
struct ColumnSpan {
  SolidSpan span;
  std::size_t column = 0;
};

class SpanWalk {
 public:
  SpanWalk(const StickModel::Level& level, const ModelLine& line, double step_voxels)
      : level_(level), step_voxels_(step_voxels) {
    const auto edge_m = static_cast<double>(level.grid.voxel_m);
    for (int k = 0; k < 3; ++k) {
      axes_[static_cast<std::size_t>(k)] = {
          (line.origin_m[k] - static_cast<double>(level.grid.corner_m[k])) / edge_m,
          line.direction[k] / edge_m};
      is_finite_ = is_finite_ && std::isfinite(line.origin_m[k]) && std::isfinite(line.direction[k]);
    }
    voxels_per_t_ = glm::length(line.direction) / edge_m;
  }

  std::vector<SolidSpan> run() {
    if (!is_finite_ || !(voxels_per_t_ > 0)) return {};
    const StickGrid& g = level_.grid;
    const SolidSpan in_grid = common(common(axes_[0].within(0, g.columns_x), axes_[1].within(0, g.columns_y)),
                                     axes_[2].within(0, g.height));
    if (in_grid.begin < in_grid.end) walk(in_grid);
    return joined_columns();
  }

 private:
  // Goes from column to column.
  void walk(const SolidSpan& in_grid) {
    const StickGrid& g = level_.grid;
    int x = axes_[0].cell_at(in_grid.begin, g.columns_x);
    int y = axes_[1].cell_at(in_grid.begin, g.columns_y);
    double t = in_grid.begin;
    while (x >= 0 && x < g.columns_x && y >= 0 && y < g.columns_y) {
      const double leave_x = axes_[0].within(x, x + 1).end;
      const double leave_y = axes_[1].within(y, y + 1).end;
      const double leave = std::min({leave_x, leave_y, in_grid.end});
      if (leave > t) {
        column_ =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(g.columns_x) + static_cast<std::size_t>(x);
        climb(level_.sticks[level_.columns[column_]], {t, leave});
        t = leave;
      }
      if (leave >= in_grid.end) return;
      if (leave_x <= leave_y) {
        x += axes_[0].step > 0 ? 1 : -1;
      } else {
        y += axes_[1].step > 0 ? 1 : -1;
      }
    }
  }

  // Adds what is solid of a stick on a stretch of the line.
  void climb(const StickModel::Stick& stick, const SolidSpan& stretch) {
    for (std::size_t n = 0; n < stick.runs; ++n) {
      const StickModel::Run& run = level_.runs[stick.first_run + n];
      const SolidSpan in_run = common(stretch, axes_[2].within(run.begin, run.begin + run.length));
      if (!(in_run.begin < in_run.end)) continue;
      if (run.is_opaque || run.is_uniform) {
        if (is_solid(run, 0)) spans_.push_back({in_run, column_});
        continue;
      }
      for (int z = 0; z < run.length; ++z) {
        const SolidSpan in_voxel = common(stretch, axes_[2].within(run.begin + z, run.begin + z + 1));
        if (in_voxel.begin < in_voxel.end && is_solid(run, z)) spans_.push_back({in_voxel, column_});
      }
    }
  }

  bool is_solid(const StickModel::Run& run, int z) const {
    const std::size_t voxel = run.first_voxel + (run.is_uniform ? 0U : static_cast<unsigned>(z));
    return run.is_opaque || static_cast<float>(level_.voxels[voxel].colour.a) >= kSolidOpacity;
  }

  std::vector<SolidSpan> joined_columns() {
    std::sort(spans_.begin(), spans_.end(),
              [](const ColumnSpan& a, const ColumnSpan& b) { return a.span.begin < b.span.begin; });
    const double touch = kStickTouch_voxels / voxels_per_t_;
    const double step = std::max(touch, step_voxels_ / voxels_per_t_);
    std::vector<SolidSpan> out;
    std::size_t last_column = 0;
    for (const ColumnSpan& s : spans_) {
      const double most = s.column == last_column ? touch : step;
      if (!out.empty() && s.span.begin - out.back().end <= most) {
        out.back().end = std::max(out.back().end, s.span.end);
      } else {
        out.push_back(s.span);
      }
      last_column = s.column;
    }
    std::erase_if(out, [&](const SolidSpan& s) { return s.end - s.begin <= touch; });
    return out;
  }

  const StickModel::Level& level_;
  double step_voxels_ = 0;
  std::array<LineAxis, 3> axes_;
  double voxels_per_t_ = 0;
  bool is_finite_ = true;
  std::size_t column_ = 0;
  std::vector<ColumnSpan> spans_;
};

}  // namespace

std::vector<SolidSpan> stick_spans(const StickModel::Level& level, const ModelLine& line, double step_voxels) {
  return SpanWalk(level, line, step_voxels).run();
}

}  // namespace objects
