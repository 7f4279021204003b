#include "vpe/app/panorama/horizon_objects.h"

#include "objects/draw/object_skyline.h"
#include "objects/draw/single_ray.h"
#include "vpe/app/scene/scene_library.h"

namespace vpe::app {

double HorizonObjects::range_m(const glm::dvec3& ray, double ground_m) const {
  const auto met = objects::first_object(*scene, {camera.position_m, ray}, ground_m);
  return met ? met->range_m : ground_m;
}

std::vector<std::string> HorizonObjects::raise(std::vector<panorama::GroundPoint>& skyline,
                                               base::ThreadPool& pool) const {
  const objects::ObjectSkyline tops(*scene, camera.position_m, camera.frame);
  std::vector<std::string> names(skyline.size());
  pool.run(skyline.size(), [&](std::size_t n) {
    panorama::GroundPoint& point = skyline[n];
    const auto top = tops.above(point.direction.azimuth_deg, point.direction.elevation_deg);
    if (!top) return;
    point = panorama::ground_point(camera, {point.direction.azimuth_deg, top->elevation_deg}, top->range_m);
    names[n] = object_name(*scene, top->instance);
  });
  return names;
}

void HorizonObjects::name_hiders(std::vector<panorama::Landmark>& landmarks) const {
  constexpr double kBeyond = 1 + 1e-9;
  for (panorama::Landmark& l : landmarks) {
    if (!l.hidden_by) continue;
    const glm::dvec3 ray = panorama::ray_of(camera, l.centre.direction);
    const auto met = objects::first_object(*scene, {camera.position_m, ray}, kBeyond * l.hidden_by->range_m);
    if (met) l.hidden_by_name = object_name(*scene, met->instance);
  }
}

}  // namespace vpe::app
