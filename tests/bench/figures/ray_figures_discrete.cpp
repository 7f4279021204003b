// Figure: a column of the discrete caster: one voxel at each grid line, and rows that climb it.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "tests/bench/figures/ray_figures.h"

namespace bench {

namespace {

namespace core = vpe::core;

constexpr CameraSpec kCamera{.north_m = 2500, .above_ground_m = 230, .yaw_deg = 192};
constexpr int kRows = 22;
constexpr int kFullRows = 40;
constexpr double kFov_deg = 48;
constexpr double kNearest_m = 330;
constexpr double kReach_m = 1230;

struct Row {
  double slope = 0;
  double distance_m = 0;
};

std::vector<Row> rows_of(const Scene& scene, const core::View& view, const SidePlane& plane) {
  vpe::voxel::RangeOptions options;
  options.method = vpe::voxel::RangeOptions::Method::kDiscrete;
  std::vector<float> range_m(kRows);
  scene.caster->cast(view, options, *scene.pool, range_m);
  std::vector<Row> rows;
  for (int row = kRows - 1; row >= 0; --row) {
    const glm::dvec3 ray = core::pixel_ray(view, 0.5, view.part.y + row + 0.5);
    rows.push_back({glm::dot(ray, plane.up) / glm::dot(ray, plane.ahead),
                    static_cast<double>(range_m[static_cast<std::size_t>(row)]) * glm::dot(ray, plane.ahead)});
  }
  return rows;
}

}  // namespace

std::string draw_discrete(const Scene& scene, const std::string& file) {
  core::View view = make_view(scene, kCamera, 1, kFullRows, kFov_deg);
  view.part = {0, kFullRows - kRows, 1, kRows};
  view.projection = core::Projection::kCylinder;
  const SidePlane plane(view, core::pixel_ray(view, 0.5, 0.5 * kFullRows));
  const std::vector<Row> rows = rows_of(scene, view, plane);
  const std::vector<glm::dvec2> ground = ground_line(scene.surface(), plane, 0.9 * kNearest_m, 1.1 * kReach_m);
  double low = 0;
  double high = -1e9;
  for (const glm::dvec2& at : ground) {
    if (at.x < kNearest_m || at.x > kReach_m) continue;
    low = std::min(low, at.y);
    high = std::max(high, at.y);
  }
  Drawing out(720, 330, "A column of the discrete caster");
  out.text(
      {14, 46},
      "Each ray ends at the first grid line whose voxel reaches it; rays that end at one line show one voxel.");
  const Panel side = square_panel(64, 62, 628, 210, {0.5 * (kNearest_m + kReach_m), 0.5 * (low + high)},
                                  kReach_m - kNearest_m);
  out.begin_clip(side);
  draw_ground(out, side, ground);
  for (const Row& row : rows) {
    const double end_m = std::min(row.distance_m, 2 * kReach_m);
    out.line(side.at({0, 0}), side.at({end_m, row.slope * end_m}), {.stroke = kGrey, .width_px = 0.7});
  }
  int voxels = 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const Row& row = rows[k];
    if (!std::isfinite(row.distance_m)) continue;
    std::size_t last = k;
    while (last + 1 < rows.size() && std::abs(rows[last + 1].distance_m - row.distance_m) < 0.1) ++last;
    // From below the ground up to the highest ray that the voxel stops.
    const glm::dvec2 foot = side.at({row.distance_m, low - 200});
    out.line(foot, side.at({row.distance_m, rows[last].slope * row.distance_m}),
             {.stroke = kBlue, .width_px = 1.6});
    for (std::size_t n = k; n <= last; ++n)
      out.circle(side.at({rows[n].distance_m, rows[n].slope * rows[n].distance_m}), 2.6, {.fill = kRed});
    ++voxels;
    k = last;
  }
  out.end_clip();
  out.axes(side, "distance from the camera, m; heights from the camera in equal scale", "", 8, 4);
  out.write(file);
  return std::to_string(rows.size()) + " rows show " + std::to_string(voxels) + " voxels";
}

}  // namespace bench
