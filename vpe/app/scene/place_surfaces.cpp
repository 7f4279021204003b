#include "vpe/app/scene/place_surfaces.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>

#include "objects/draw/object_spans.h"
#include "objects/draw/single_ray.h"
#include "vpe/app/scene/scene_library.h"

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

std::vector<PlaceSurface> surfaces_at(const objects::Scene* scene, const mars::LonLat& place,
                                      const PlaceGround& ground, double planet_radius_m) {
  std::vector<PlaceSurface> surfaces;
  if (scene != nullptr) {
    // From the centre, so that heights do not depend on how high other objects are.
    std::vector<objects::ObjectSpan> spans = objects::object_spans(
        *scene, {glm::dvec3(0), mars::direction(place)}, std::numeric_limits<double>::infinity());
    std::sort(spans.begin(), spans.end(), [](const objects::ObjectSpan& a, const objects::ObjectSpan& b) {
      if (a.end_m != b.end_m) return a.end_m > b.end_m;
      return a.begin_m != b.begin_m ? a.begin_m > b.begin_m : a.instance < b.instance;
    });
    for (const objects::ObjectSpan& s : spans) {
      const std::string name = object_name(*scene, s.instance);
      surfaces.push_back({name, true, s.end_m - planet_radius_m, s.geometric_error_m, false});
      surfaces.push_back({name, false, s.begin_m - planet_radius_m, s.geometric_error_m, false});
    }
  }
  const PlaceSurface own{std::nullopt, true, ground.height_m, ground.geometric_error_m, ground.nodata};
  if (!ground.nodata) surfaces.push_back(own);
  // Equal heights keep their order, in which a span's underside is before the top of the next one.
  std::stable_sort(surfaces.begin(), surfaces.end(),
                   [](const PlaceSurface& a, const PlaceSurface& b) { return a.height_m > b.height_m; });
  if (ground.nodata) surfaces.push_back(own);
  return surfaces;
}

}  // namespace vpe::app
