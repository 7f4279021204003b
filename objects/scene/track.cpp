#include "objects/scene/track.h"

#include <optional>
#include <stdexcept>
#include <string>

namespace objects {

TrackTarget track_target(const SceneFile& scene, const vpe::core::ObjectTrack& track) {
  const auto fail = [&](const std::string& found) {
    return std::runtime_error(scene.path.string() + ": expected one object or path with the name \"" +
                              track.name + "\", which the flight moves, found " + found);
  };
  std::optional<TrackTarget> target;
  const auto take = [&](bool is_path, std::size_t entry) {
    if (target) throw fail("several");
    target = {is_path, entry};
  };
  for (std::size_t n = 0; n < scene.objects.size(); ++n) {
    if (scene.objects[n].name != track.name) continue;
    take(false, n);
    if (scene.objects[n].places.size() != 1) throw fail("one with several places");
    if (scene.objects[n].ground.kind != GroundRole::Kind::kNone) throw fail("one that is part of the ground");
  }
  for (std::size_t n = 0; n < scene.paths.size(); ++n) {
    if (scene.paths[n].name == track.name) take(true, n);
  }
  if (!target) throw fail("none");
  return *target;
}

std::vector<PathPoint> path_points(const vpe::core::ObjectTrack& track) {
  std::vector<PathPoint> points;
  points.reserve(track.points.size());
  for (const vpe::core::ObjectTrack::Point& point : track.points)
    points.push_back({point.time_s,
                      {point.place.lon_deg, point.place.lat_deg},
                      point.place.heading_deg,
                      point.place.height_m});
  return points;
}

}  // namespace objects
