#include "objects/draw/object_spans.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>
#include <tuple>

#include "objects/model/solid_spans.h"
#include "objects/sticks/stick_spans.h"
#include "objects/volumes/volume_spans.h"

namespace objects {

namespace {

// Bounds how far rounding moves the surfaces of an object: the single precision of its rotation and of rays
// against its triangles, and the double precision of its place.
double rounding_of_m(const PlacedObject& o) {
  constexpr double kRotationError = 4e-7;
  constexpr double kPlaceError = 2e-15;
  const double reach_m = static_cast<double>(o.scale) * (glm::length(o.ball_m) + o.ball_radius_m);
  return (kRotationError + kMeshSpanError) * reach_m + kPlaceError * glm::length(o.position_m);
}

// Volumes are taken at the finest level whatever the distance, so not at that of the placed object.
std::vector<SolidSpan> spans_of_volume(const VolumeModel& volume, const ModelLine& line,
                                       double threshold_per_m) {
  constexpr double kWholeLine = std::numeric_limits<double>::infinity();
  return volume_spans(volume.levels()[0], {line.origin_m, line.direction}, -kWholeLine, kWholeLine,
                      threshold_per_m > 0 ? threshold_per_m : default_threshold_per_m(volume));
}

void append_spans(const PlacedObject& o, const ObjectRay& ray, double until_m,
                  const std::optional<double>& volume_threshold_per_m, std::vector<ObjectSpan>& out) {
  // A metre of the ray is a unit of t.
  const ModelLine line{o.to_model * (ray.origin_m - o.position_m), o.to_model * ray.direction};
  const auto scale = static_cast<double>(o.scale);
  double geometric_error_m = rounding_of_m(o);
  std::vector<SolidSpan> spans;
  if (const VolumeModel* volume = o.model->volume(); volume != nullptr) {
    if (!volume_threshold_per_m) return;
    spans = spans_of_volume(*volume, line, *volume_threshold_per_m);
    geometric_error_m += static_cast<double>(volume->levels()[0].lattice.spacing_m) * scale;
  } else if (o.level != nullptr) {
    spans = mesh_spans(*o.level, o.model->textures(), o.model->ball(), line);
  } else {
    const StickModel::Level& level = o.model->sticks()->levels()[o.level_index];
    spans = stick_spans(level, line, kStickStep_voxels);
    geometric_error_m += kStickSurfaceError_voxels * static_cast<double>(level.grid.voxel_m) * scale;
  }
  for (const SolidSpan& s : spans) {
    if (s.end >= 0 && s.begin <= until_m) out.push_back({o.instance, s.begin, s.end, geometric_error_m});
  }
}

}  // namespace

std::vector<ObjectSpan> object_spans(const Scene& scene, const ObjectRay& ray, double until_m,
                                     std::optional<double> volume_threshold_per_m) {
  if (volume_threshold_per_m && !std::isfinite(*volume_threshold_per_m))
    throw std::invalid_argument("a threshold of extinction must be finite");
  LevelRule rule;  // of the finest levels
  rule.camera_m = ray.origin_m;
  const ObjectRays rays(scene, rule);
  std::vector<ObjectSpan> out;
  scene.visit(
      [&](const SceneBall& ball) { return may_meet(ray, until_m, ball); },
      [&](std::uint32_t n) { append_spans(rays.placed(n), ray, until_m, volume_threshold_per_m, out); });
  std::sort(out.begin(), out.end(), [](const ObjectSpan& a, const ObjectSpan& b) {
    return std::tie(a.begin_m, a.end_m, a.instance) < std::tie(b.begin_m, b.end_m, b.instance);
  });
  return out;
}

}  // namespace objects
