#include "vpe/voxel/range_caster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>

#include "vpe/voxel/column_walk.h"
#include "vpe/voxel/facet_finder.h"
#include "vpe/voxel/fan.h"

namespace vpe::voxel {

namespace {

constexpr double kSurfaceShare = 0.25;

std::size_t part(std::size_t bytes, double share) {
  return static_cast<std::size_t>(share * static_cast<double>(bytes));
}

// Tilt up to which a round picture's columns count as vertical: below a thousandth of a pixel.
constexpr double kLevel = 1e-8;

bool upright(const core::View& view, const glm::dvec3& up) {
  return view.projection != core::Projection::kPerspective && glm::length(view.eye.axes.up - up) < kLevel;
}

// Neighbouring groups that one thread casts in turn.
constexpr int kTaskGroups = 6;
constexpr int kBlockRows = 32;

// Between the lines of a perspective picture's fans.
constexpr double kFanSpacing_px = 1.0;

// Larger pictures are written past the caches.
constexpr std::size_t kCachedBytes = std::size_t{4} << 20;

// Rows of a round picture from its lowest one, with their tables.
struct PictureRows {
  Rows rows;
  std::vector<double> exact;
  std::vector<float> rounded;
  std::vector<float> length;
};

PictureRows picture_rows(const core::View& view, const core::SubRectangle& part) {
  PictureRows p;
  p.rows.count = part.height;
  const auto finish = [&] {
    for (int r = 0; r < part.height; ++r) {
      const double slope =
          p.exact.empty() ? (r - p.rows.centre) * p.rows.step : p.exact[static_cast<std::size_t>(r)];
      p.length.push_back(static_cast<float>(std::hypot(1.0, slope)));
    }
    p.rows.length = p.length.data();
  };
  const double centre_y = 0.5 * view.height + view.principal_offset_px.y;
  const double lowest = centre_y - (part.y + part.height - 0.5);  // of row 0, upward from the principal row
  const double focal = core::focal_px(view);
  if (view.projection == core::Projection::kCylinder) {
    p.rows.kind = RowKind::kEven;
    p.rows.centre = -lowest;
    p.rows.step = 1.0 / focal;
    finish();
    return p;
  }
  p.rows.kind = RowKind::kTable;
  p.rows.first_elevation = lowest / focal;
  p.rows.elevation_step = 1.0 / focal;
  // A row that looks straight up or down still has a slope.
  constexpr double kSteepest = 1e12;
  for (int r = 0; r < part.height; ++r)
    p.exact.push_back(std::clamp(std::tan((lowest + r) / focal), -kSteepest, kSteepest));
  p.exact.push_back(std::numeric_limits<double>::infinity());
  p.rounded.assign(p.exact.begin(), p.exact.end());
  p.rows.slope = p.rounded.data();
  p.rows.slope_exact = p.exact.data();
  finish();
  return p;
}

}  // namespace

struct alignas(64) LaneFloats {
  float lane[kMaxLanes];
};

// What a thread works with; kept for the next task of the picture.
struct RangeCaster::Desk {
  Desk(const LatticeStore& store, int rows, double exaggeration)
      : shelf(store, exaggeration),
        buffers(2 * static_cast<std::size_t>(kTaskGroups) * static_cast<std::size_t>(rows)) {
    for (std::size_t g = 0; g < groups.size(); ++g) {
      groups[g].start = buffers[2 * g * static_cast<std::size_t>(rows)].lane;
      groups[g].gain = buffers[(2 * g + 1) * static_cast<std::size_t>(rows)].lane;
    }
  }

  LatticeShelf shelf;
  std::vector<LaneFloats> buffers;  // zero between tasks
  std::vector<float> hints;
  std::vector<int> open;
  std::array<ColumnGroup, kTaskGroups> groups{};
  std::array<LaneFloats, static_cast<std::size_t>(kTaskGroups) * kBlockRows> block{};  // of expanded rows

  // A desk for one task. Not handed back when the task throws.
  class Use {
   public:
    Use(RangeCaster& caster, int rows, double exaggeration)
        : caster_(caster), thrown_(std::uncaught_exceptions()) {
      const std::lock_guard lock(caster_.desks_mutex_);
      if (!caster_.desks_.empty()) {
        desk_ = std::move(caster_.desks_.back());
        caster_.desks_.pop_back();
      } else {
        desk_ = std::make_unique<Desk>(caster_.store_, rows, exaggeration);
      }
    }
    ~Use() {
      if (std::uncaught_exceptions() != thrown_) return;
      const std::lock_guard lock(caster_.desks_mutex_);
      caster_.desks_.push_back(std::move(desk_));
    }
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;
    Desk* operator->() const { return desk_.get(); }

   private:
    RangeCaster& caster_;
    int thrown_;
    std::unique_ptr<Desk> desk_;
  };
};

RangeCaster::~RangeCaster() = default;

RangeCaster::RangeCaster(std::shared_ptr<const paging::PlanetFile> planet, std::size_t budget_bytes)
    : surface_(planet, vpe::voxel::part(budget_bytes, kSurfaceShare)),
      store_(planet, vpe::voxel::part(budget_bytes, 1.0 - kSurfaceShare)) {}

// Columns side by side that share their rows.
struct RangeCaster::Sheet {
  Rows rows;
  int columns = 0;
  float* out = nullptr;       // of row 0, column 0
  std::ptrdiff_t stride = 0;  // floats from a row to the next
  bool stream = false;
  // Sets a column's azimuth, its rows, and its part of a fan.
  std::function<void(int column, ColumnGroup& group, int lane, glm::dvec3& azimuth)> set_column;
};

void RangeCaster::cast(const core::View& view, double exaggeration, core::ThreadPool& pool,
                       std::span<float> range_m) {
  const double distance = glm::length(view.eye.eye_m);
  if (distance > 0) {
    const glm::dvec3 up = view.eye.eye_m / distance;
    const ColumnEye eye{up, distance, surface_.planet_radius_m(), surface_.at(up, exaggeration).radius_m};
    if (eye.distance_m > eye.ground_m) {
      if (upright(view, up)) return cast_upright(view, eye, exaggeration, pool, range_m);
      if (view.projection == core::Projection::kPerspective)
        return cast_fans(view, eye, exaggeration, pool, range_m);
    }
  }
  cast_each(view, exaggeration, pool, range_m);
}

void RangeCaster::cast_sheets(std::span<const Sheet> sheets, const ColumnEye& eye, double exaggeration,
                              core::ThreadPool& pool) {
  const ColumnWalk walk(surface_.planet(), eye, exaggeration);
  const int lanes = column_lanes();
  const int task_columns = lanes * kTaskGroups;
  struct Task {
    const Sheet* sheet;
    int begin;
  };
  std::vector<Task> tasks;
  int most_rows = 0;
  for (const Sheet& sheet : sheets) {
    most_rows = std::max(most_rows, sheet.rows.count);
    for (int begin = 0; begin < sheet.columns; begin += task_columns) tasks.push_back({&sheet, begin});
  }
  pool.run(tasks.size(), [&](std::size_t t) {
    const Desk::Use desk(*this, most_rows, exaggeration);
    const Sheet& sheet = *tasks[t].sheet;
    const int begin = tasks[t].begin;
    const int columns = std::min(task_columns, sheet.columns - begin);
    int groups = 0;
    float lowest = static_cast<float>(sheet.rows.count);
    float highest = 0;
    for (int first = 0; first < columns; first += lanes, ++groups) {
      ColumnGroup& group = desk->groups[static_cast<std::size_t>(groups)];
      group.columns = std::min(lanes, columns - first);
      std::array<glm::dvec3, kMaxLanes> azimuth{};
      for (int lane = 0; lane < kMaxLanes; ++lane) {
        group.row[lane] = 0;
        group.row_end[lane] = 0;
        group.run_start[lane] = 1;
        group.run_gain[lane] = 0;
        group.run_slope[lane] = 0;
        if (lane >= group.columns) continue;
        sheet.set_column(begin + first + lane, group, lane, azimuth[static_cast<std::size_t>(lane)]);
        lowest = std::min(lowest, group.row[lane]);
        highest = std::max(highest, group.row_end[lane]);
      }
      walk.cast(azimuth.data(), sheet.rows, desk->shelf, group);
    }
    const int end = static_cast<int>(highest);
    for (int row = static_cast<int>(lowest); row < end; row += kBlockRows) {
      const int rows = std::min(kBlockRows, end - row);
      for (int g = 0; g < groups; ++g)
        expand_rows(sheet.rows, desk->groups[static_cast<std::size_t>(g)], row, row + rows,
                    desk->block[0].lane + g * lanes, task_columns);
      copy_rows(desk->block[0].lane, task_columns, sheet.out + row * sheet.stride + begin, sheet.stride,
                columns, rows, sheet.stream);
    }
  });
  desks_.clear();
}

void RangeCaster::cast_upright(const core::View& view, const ColumnEye& eye, double exaggeration,
                               core::ThreadPool& pool, std::span<float> range_m) {
  const core::SubRectangle part = core::drawn_part(view);
  const PictureRows picture = picture_rows(view, part);
  const double level_y = 0.5 * view.height + view.principal_offset_px.y;
  Sheet sheet;
  sheet.rows = picture.rows;
  sheet.columns = part.width;
  sheet.stride = -static_cast<std::ptrdiff_t>(part.width);
  sheet.out = range_m.data() - sheet.stride * (part.height - 1);
  sheet.stream = range_m.size_bytes() > kCachedBytes;
  sheet.set_column = [&](int column, ColumnGroup& group, int lane, glm::dvec3& azimuth) {
    const glm::dvec3 ray = core::pixel_ray(view, part.x + column + 0.5, level_y);
    azimuth = glm::normalize(ray - glm::dot(ray, eye.up) * eye.up);
    group.row_end[lane] = static_cast<float>(part.height);
  };
  cast_sheets({&sheet, 1}, eye, exaggeration, pool);
}

void RangeCaster::cast_fans(const core::View& view, const ColumnEye& eye, double exaggeration,
                            core::ThreadPool& pool, std::span<float> range_m) {
  const FanPlan plan(view, eye.up, kFanSpacing_px);
  std::vector<Sheet> sheets;
  fans_.resize(std::max(fans_.size(), plan.fans().size()));
  for (std::size_t f = 0; f < plan.fans().size(); ++f) {
    const Fan& fan = plan.fans()[f];
    fans_[f].resize(static_cast<std::size_t>(fan.steps) * static_cast<std::size_t>(fan.lines));
    Sheet& sheet = sheets.emplace_back();
    sheet.rows.kind = RowKind::kFan;
    sheet.rows.count = fan.steps;
    sheet.columns = fan.lines;
    // Stored by step.
    sheet.stride = fan.rising ? fan.lines : -static_cast<std::ptrdiff_t>(fan.lines);
    sheet.out = fans_[f].data() + (fan.rising ? 0 : std::ptrdiff_t{fan.lines} * (fan.steps - 1));
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
  cast_sheets(sheets, eye, exaggeration, pool);

  resample(view, plan, eye, exaggeration, pool, range_m);
}

// Samples on either side of each pixel of one row, in that row or column of samples.
void RangeCaster::find_hints(const FanPlan& plan, const core::SubRectangle& part, int row, float* a,
                             float* b, float* share) const {
  const double y = part.y + row + 0.5;
  const FanPlan::Span span = plan.upright_span(row);
  const auto none = [&](int k) {
    a[k] = std::numeric_limits<float>::infinity();
    b[k] = 0;
    share[k] = 0;
  };
  const auto samples = [&](const Fan& fan) {
    return fans_[static_cast<std::size_t>(&fan - plan.fans().data())].data();
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
    const float* from = fan != nullptr ? samples(*fan) : nullptr;
    for (int k = begin; k < end; ++k) {
      if (fan == nullptr) {
        none(k);
        continue;
      }
      const int step = std::clamp(part.x + k - fan->first_step, 0, fan->steps - 1);
      const Fan::Map& map = fan->maps[static_cast<std::size_t>(step)];
      const double line = (map.stretch * y + map.shift - fan->first_line) / fan->spacing;
      const int before = std::clamp(static_cast<int>(line), 0, fan->lines - 2);
      a[k] = from[std::ptrdiff_t{step} * fan->lines + before];
      b[k] = from[std::ptrdiff_t{step} * fan->lines + before + 1];
      share[k] = static_cast<float>(std::clamp(line - before, 0.0, 1.0));
    }
  };
  beside(0, span.begin);
  beside(span.end, part.width);
}

void RangeCaster::resample(const core::View& view, const FanPlan& plan, const ColumnEye& eye,
                           double exaggeration, core::ThreadPool& pool, std::span<float> range_m) {
  const core::SubRectangle part = core::drawn_part(view);
  const mars::Axes& axes = view.eye.axes;
  const double focal = core::focal_px(view);
  const double cx = 0.5 * view.width + view.principal_offset_px.x;
  const double cy = 0.5 * view.height + view.principal_offset_px.y;
  const int blocks = (part.height + kBlockRows - 1) / kBlockRows;
  pool.run(static_cast<std::size_t>(blocks), [&](std::size_t block) {
    const Desk::Use desk(*this, 0, exaggeration);
    FacetFinder finder(surface_.planet().tree(), eye, desk->shelf);
    const auto width = static_cast<std::size_t>(part.width);
    desk->hints.resize(3 * width);
    float* const a = desk->hints.data();
    float* const b = a + width;
    float* const share = b + width;
    const int first = static_cast<int>(block) * kBlockRows;
    for (int row = first; row < std::min(first + kBlockRows, part.height); ++row) {
      find_hints(plan, part, row, a, b, share);
      float* const out = range_m.data() + static_cast<std::size_t>(row) * width;
      RayRow rays;
      rays.eye_m = view.eye.eye_m;
      rays.radius_m = eye.radius_m;
      rays.first =
          (part.x + 0.5 - cx) * axes.right + (cy - (part.y + row + 0.5)) * axes.up + focal * axes.forward;
      rays.step = axes.right;
      rays.count = part.width;
      desk->open.clear();
      refine_row(rays, a, b, share, finder, out, desk->open);
      for (const int k : desk->open) {
        const glm::dvec3 ray = glm::normalize(rays.first + static_cast<double>(k) * rays.step);
        out[k] = static_cast<float>(surface_.cast(view.eye.eye_m, ray, exaggeration));
      }
    }
  });
  desks_.clear();
}

void RangeCaster::cast_each(const core::View& view, double exaggeration, core::ThreadPool& pool,
                            std::span<float> range_m) {
  const core::SubRectangle part = core::drawn_part(view);
  pool.run(static_cast<std::size_t>(part.height), [&](std::size_t row) {
    const auto width = static_cast<std::size_t>(part.width);
    for (std::size_t x = 0; x < width; ++x) {
      const glm::dvec3 ray =
          core::pixel_ray(view, part.x + static_cast<double>(x) + 0.5, part.y + static_cast<double>(row) + 0.5);
      range_m[row * width + x] = static_cast<float>(surface_.cast(view.eye.eye_m, ray, exaggeration));
    }
  });
}

}  // namespace vpe::voxel
