// The camera of a photograph: which direction each of its pixels shows.
#pragma once

#include <glm/vec3.hpp>
#include <optional>

#include "mars/geodesy/pose.h"
#include "panorama/projection.h"

namespace panorama {

// Describes a photograph. Without a map it is a perspective image with its principal point in the middle and
// square pixels, without distortion. With a map it is a panorama; the map's azimuths are counted from the yaw of
// its pose, so that the pose of a panorama that is placed rightly is 0, 0, 0.
struct PhotoShape {
  int width_px = 0;
  int height_px = 0;
  std::optional<PanoramaMap> map;
};

// Holds the attitude of a photograph as mars::Pose has it, and its vertical field of view (not used with a map).
struct PhotoPose {
  double yaw_deg = 0;
  double pitch_deg = 0;
  double roll_deg = 0;
  double fov_deg = 0;
};

// Returns the pixels per radian in the middle of the image (of a map: along the horizon).
double pixels_per_radian(const PhotoShape& shape, double fov_deg);

// Returns the unit ray of a place of the image in the camera's axes: right, up, forward.
glm::dvec3 camera_ray(const PhotoShape& shape, double fov_deg, double x_px, double y_px);

// Finds the directions that the places of one posed image show. Azimuths are in (-180, 180]. Immutable: may be used
// from any thread.
class DirectionFinder {
 public:
  DirectionFinder(const PhotoShape& shape, const PhotoPose& pose);
  Direction at(double x_px, double y_px) const;

 private:
  PhotoShape shape_;
  double fov_deg_;
  mars::Axes axes_;
};

// Returns the place where the image shows a direction, which may lie outside of it; nullopt for directions that
// are behind a perspective camera or on no place of the map.
std::optional<glm::dvec2> photo_place(const PhotoShape& shape, const PhotoPose& pose,
                                      const Direction& direction);

}  // namespace panorama
