// A place from where panoramas and skylines are seen: a level camera above a sphere.
#pragma once

#include "mars/geodesy/pose.h"
#include "mars/geodesy/sphere.h"

namespace panorama {

// Describes a place above the sphere that elevations are counted from, with the local frame there. Azimuths are
// counted from the frame's north (at a pole: along the meridian of the place's longitude).
struct Viewpoint {
  mars::LonLat place;
  double alt_m = 0;     // above the sphere
  double radius_m = 0;  // of the sphere
  mars::LocalFrame frame;
  glm::dvec3 position_m;  // body-fixed, from the planet's centre
};

// Returns the viewpoint at a place. Pure; any thread.
inline Viewpoint viewpoint_at(mars::LonLat place, double alt_m, double radius_m) {
  const mars::LocalFrame frame = mars::local_frame(place);
  return {place, alt_m, radius_m, frame, (radius_m + alt_m) * frame.up};
}

// Returns the viewpoint of a pose; its yaw, pitch and roll are not used.
inline Viewpoint viewpoint_of(const mars::Pose& pose, double radius_m) {
  return viewpoint_at({pose.lon_deg, pose.lat_deg}, pose.alt_m, radius_m);
}

// Returns a level camera there that looks towards an azimuth.
inline mars::CameraPose level_camera(const Viewpoint& viewpoint, double azimuth_deg) {
  return mars::to_camera(
      mars::Pose{viewpoint.place.lon_deg, viewpoint.place.lat_deg, viewpoint.alt_m, azimuth_deg, 0.0, 0.0},
      viewpoint.radius_m);
}

}  // namespace panorama
