#include "vpe/voxel/range_caster.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <array>
#include <exception>
#include <limits>

#include "vpe/voxel/column_walk.h"

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
      const double slope = p.exact.empty() ? (r - p.rows.centre) * p.rows.step : p.exact[static_cast<std::size_t>(r)];
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

void RangeCaster::cast(const core::View& view, double exaggeration, core::ThreadPool& pool,
                       std::span<float> range_m) {
  const double distance = glm::length(view.eye.eye_m);
  if (distance > 0) {
    const glm::dvec3 up = view.eye.eye_m / distance;
    const double ground = surface_.at(up, exaggeration).radius_m;
    if (upright(view, up) && distance > ground) return cast_upright(view, exaggeration, ground, pool, range_m);
  }
  cast_each(view, exaggeration, pool, range_m);
}

void RangeCaster::cast_upright(const core::View& view, double exaggeration, double ground_m,
                               core::ThreadPool& pool, std::span<float> range_m) {
  const core::SubRectangle part = core::drawn_part(view);
  const PictureRows picture = picture_rows(view, part);
  const double distance = glm::length(view.eye.eye_m);
  const ColumnEye eye{view.eye.eye_m / distance, distance, surface_.planet_radius_m(), ground_m};
  const ColumnWalk walk(surface_.planet(), eye, exaggeration);
  const int lanes = column_lanes();
  const int task_columns = lanes * kTaskGroups;
  const auto tasks = static_cast<std::size_t>((part.width + task_columns - 1) / task_columns);
  const bool stream = range_m.size_bytes() > kCachedBytes;
  const double level_y = 0.5 * view.height + view.principal_offset_px.y;
  pool.run(tasks, [&](std::size_t task) {
    const Desk::Use desk(*this, part.height, exaggeration);
    const int begin = static_cast<int>(task) * task_columns;
    const int columns = std::min(task_columns, part.width - begin);
    int groups = 0;
    for (int first = 0; first < columns; first += lanes, ++groups) {
      ColumnGroup& group = desk->groups[static_cast<std::size_t>(groups)];
      group.columns = std::min(lanes, columns - first);
      std::array<glm::dvec3, kMaxLanes> azimuth{};
      for (int lane = 0; lane < kMaxLanes; ++lane) {
        group.row[lane] = 0;
        group.row_end[lane] = lane < group.columns ? static_cast<float>(part.height) : 0;
        if (lane >= group.columns) continue;
        const glm::dvec3 ray = core::pixel_ray(view, part.x + begin + first + lane + 0.5, level_y);
        azimuth[static_cast<std::size_t>(lane)] = glm::normalize(ray - glm::dot(ray, eye.up) * eye.up);
      }
      walk.cast(azimuth.data(), picture.rows, desk->shelf, group);
    }
    for (int row = 0; row < part.height; row += kBlockRows) {
      const int rows = std::min(kBlockRows, part.height - row);
      for (int g = 0; g < groups; ++g)
        expand_rows(picture.rows, desk->groups[static_cast<std::size_t>(g)], row, row + rows,
                    desk->block[0].lane + g * lanes, task_columns);
      float* const out = range_m.data() +
                         static_cast<std::size_t>(part.height - 1 - row) * static_cast<std::size_t>(part.width) + begin;
      copy_rows(desk->block[0].lane, task_columns, out, -static_cast<std::ptrdiff_t>(part.width), columns, rows,
                stream);
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
      const glm::dvec3 ray = core::pixel_ray(view, part.x + static_cast<double>(x) + 0.5,
                                             part.y + static_cast<double>(row) + 0.5);
      range_m[row * width + x] = static_cast<float>(surface_.cast(view.eye.eye_m, ray, exaggeration));
    }
  });
}

}  // namespace vpe::voxel
