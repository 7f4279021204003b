#include "vpe/app/scene/place_surfaces.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "objects/draw/object_spans.h"
#include "objects/draw/single_ray.h"

namespace vpe::app {

std::optional<ObjectTop> highest_object(const objects::Scene& scene, const mars::LonLat& place,
                                        double planet_radius_m) {
  if (scene.is_empty()) return std::nullopt;
  const objects::SceneBall all = scene.ball();
  const double from_m = glm::length(all.centre_m) + all.radius_m;
  const glm::dvec3 up = mars::direction(place);
  const auto top = objects::first_object(scene, {from_m * up, -up}, from_m);
  if (!top) return std::nullopt;
  return ObjectTop{object_name(scene, top->instance), from_m - top->range_m - planet_radius_m};
}

namespace {

// A stretch of solid ground on a vertical, with the bounds of the errors of its ends.
struct GroundStretch {
  double low_m = -std::numeric_limits<double>::infinity();
  double low_error_m = 0;
  double high_m = 0;
  double high_error_m = 0;
};

// Returns the ground without what is cut out of it, from the highest stretch to the lowest.
std::vector<GroundStretch> ground_stretches(const PlacedScene& placed, const glm::dvec3& up,
                                            const PlaceGround& ground, double planet_radius_m) {
  std::vector<GroundStretch> left{{.high_m = ground.height_m, .high_error_m = ground.geometric_error_m}};
  if (!placed.parts) return left;
  for (const PlacedPart& part : *placed.parts) {
    if (part.role.kind != objects::GroundRole::Kind::kCut) continue;
    for (const objects::ObjectSpan& span : part_spans(part, up)) {
      const double low_m = span.begin_m - planet_radius_m;
      const double high_m = span.end_m - planet_radius_m;
      std::vector<GroundStretch> next;
      for (const GroundStretch& solid : left) {
        if (high_m <= solid.low_m || low_m >= solid.high_m || !(low_m < high_m)) {
          next.push_back(solid);
          continue;
        }
        if (high_m < solid.high_m)
          next.push_back({high_m, span.geometric_error_m, solid.high_m, solid.high_error_m});
        if (low_m > solid.low_m)
          next.push_back({solid.low_m, solid.low_error_m, low_m, span.geometric_error_m});
      }
      left = std::move(next);
    }
  }
  return left;
}

std::vector<PlaceSurface> ground_surfaces(const std::vector<GroundStretch>& stretches, bool nodata) {
  std::vector<PlaceSurface> surfaces;
  for (const GroundStretch& solid : stretches) {
    surfaces.push_back({std::nullopt, true, solid.high_m, solid.high_error_m, nodata});
    if (std::isfinite(solid.low_m))
      surfaces.push_back({std::nullopt, false, solid.low_m, solid.low_error_m, nodata});
  }
  return surfaces;
}

}  // namespace

std::vector<PlaceSurface> surfaces_at(const PlacedScene& placed, const mars::LonLat& place,
                                      const PlaceGround& ground, double planet_radius_m) {
  std::vector<PlaceSurface> surfaces;
  const glm::dvec3 up = mars::direction(place);
  if (placed.scene != nullptr) {
    // From the centre, so that heights do not depend on how high other objects are.
    std::vector<objects::ObjectSpan> spans =
        objects::object_spans(*placed.scene, {glm::dvec3(0), up}, std::numeric_limits<double>::infinity());
    std::sort(spans.begin(), spans.end(), [](const objects::ObjectSpan& a, const objects::ObjectSpan& b) {
      if (a.end_m != b.end_m) return a.end_m > b.end_m;
      return a.begin_m != b.begin_m ? a.begin_m > b.begin_m : a.instance < b.instance;
    });
    for (const objects::ObjectSpan& s : spans) {
      const std::string name = object_name(*placed.scene, s.instance);
      surfaces.push_back({name, true, s.end_m - planet_radius_m, s.geometric_error_m, false});
      surfaces.push_back({name, false, s.begin_m - planet_radius_m, s.geometric_error_m, false});
    }
  }
  const std::vector<PlaceSurface> own =
      ground_surfaces(ground_stretches(placed, up, ground, planet_radius_m), ground.nodata);
  if (!ground.nodata) surfaces.insert(surfaces.end(), own.begin(), own.end());
  // Equal heights keep their order, in which a span's underside is before the top of the next one.
  std::stable_sort(surfaces.begin(), surfaces.end(),
                   [](const PlaceSurface& a, const PlaceSurface& b) { return a.height_m > b.height_m; });
  if (ground.nodata) surfaces.insert(surfaces.end(), own.begin(), own.end());
  return surfaces;
}

}  // namespace vpe::app
