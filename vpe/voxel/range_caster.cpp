#include "vpe/voxel/range_caster.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
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

struct alignas(64) LaneFloats {
  float lane[kMaxLanes];
};

// Rows of a round picture from its lowest one, with their tables.
struct PictureRows {
  Rows rows;
  std::vector<double> exact;
  std::vector<float> rounded;
};

PictureRows picture_rows(const core::View& view, const core::SubRectangle& part) {
  PictureRows p;
  p.rows.count = part.height;
  const double centre_y = 0.5 * view.height + view.principal_offset_px.y;
  const double lowest = centre_y - (part.y + part.height - 0.5);  // of row 0, upward from the principal row
  const double focal = core::focal_px(view);
  if (view.projection == core::Projection::kCylinder) {
    p.rows.kind = RowKind::kEven;
    p.rows.centre = -lowest;
    p.rows.step = 1.0 / focal;
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
  return p;
}

}  // namespace

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
  const auto groups = static_cast<std::size_t>((part.width + lanes - 1) / lanes);
  const auto row_count = static_cast<std::size_t>(part.height);
  pool.run(groups, [&](std::size_t g) {
    thread_local std::vector<LaneFloats> start;
    thread_local std::vector<LaneFloats> gain;
    start.assign(row_count, LaneFloats{});
    gain.resize(row_count);
    LatticeShelf shelf(store_, exaggeration);
    ColumnGroup group{};
    const int first = static_cast<int>(g) * lanes;
    group.columns = std::min(lanes, part.width - first);
    group.start = start.data()->lane;
    group.gain = gain.data()->lane;
    std::array<glm::dvec3, kMaxLanes> azimuth{};
    const double level_y = 0.5 * view.height + view.principal_offset_px.y;
    for (int lane = 0; lane < group.columns; ++lane) {
      const glm::dvec3 ray = core::pixel_ray(view, part.x + first + lane + 0.5, level_y);
      azimuth[static_cast<std::size_t>(lane)] = glm::normalize(ray - glm::dot(ray, eye.up) * eye.up);
      group.row_end[lane] = static_cast<float>(part.height);
    }
    walk.cast(azimuth.data(), picture.rows, shelf, group);
    float* const lowest =
        range_m.data() + static_cast<std::size_t>(part.height - 1) * static_cast<std::size_t>(part.width) + first;
    expand_rows(picture.rows, group, 0, part.height, lowest, -static_cast<std::ptrdiff_t>(part.width));
  });
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
