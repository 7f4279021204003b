#include "vpe/voxel/paint/nodata_stripes.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "vpe/core/appearance/nodata_pattern.h"

namespace vpe::voxel {

namespace {

std::size_t index_of(const PaintJob& job, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(job.width) + static_cast<std::size_t>(x);
}

glm::dvec3 place_of(const PaintJob& job, int x, int y) {
  const RowRays& row = job.rays.rows[static_cast<std::size_t>(y)];
  const auto column = static_cast<std::size_t>(x);
  const glm::dvec3 ray = row.a * job.rays.c0[column] + row.b * job.rays.c1[column] + row.c;
  const auto range = static_cast<double>(job.range_m[index_of(job, x, y)]);
  return job.request->view.camera.position_m + range * glm::normalize(ray);
}

double along(const mars::ChartPoint& at) { return at.u + at.v; }

// Returns the change of u + v from a pixel to that of its neighbours on either side whose range is nearer to
// its own; 0 if both are sky or outside the image.
double change(const PaintJob& job, const mars::ChartPoint& here, int x, int y, int dx, int dy) {
  const float range = job.range_m[index_of(job, x, y)];
  float least = std::numeric_limits<float>::infinity();
  int side = 0;
  for (const int s : {1, -1}) {
    const int nx = x + s * dx, ny = y + s * dy;
    if (nx < 0 || ny < 0 || nx >= job.width || ny >= job.height) continue;
    const float off = std::abs(job.range_m[index_of(job, nx, ny)] - range);
    if (off < least) {
      least = off;
      side = s;
    }
  }
  if (side == 0) return 0;
  return along(mars::chart_on(here.face, place_of(job, x + side * dx, y + side * dy))) - along(here);
}

}  // namespace

float nodata_tone(const PaintJob& job, int x, int y) {
  const mars::ChartPoint here = mars::chart_point(place_of(job, x, y));
  const double pixel = std::hypot(change(job, here, x, y, 1, 0), change(job, here, x, y, 0, 1));
  return static_cast<float>(core::nodata_grey(along(here), pixel) / core::kMissingImagery);
}

}  // namespace vpe::voxel
