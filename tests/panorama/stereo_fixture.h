// Panoramas for two eyes by definition: every direction has an eye of its own.
#pragma once

#include <cmath>
#include <glm/geometric.hpp>

#include "mars/geodesy/pose.h"
#include "panorama/projection.h"
#include "panorama/stereo_eyes.h"

namespace test_support {

class TwoEyes {
 public:
  TwoEyes(const mars::Pose& middle, double radius_m, double base_m)
      : origin_m_(mars::to_camera(middle, radius_m).position_m),
        axes_(mars::local_frame({middle.lon_deg, middle.lat_deg})),
        base_m_(base_m) {}

  struct Ray {
    glm::dvec3 camera_m;
    glm::dvec3 direction;
  };
  // Body-fixed.
  Ray ray(panorama::Eye eye, const panorama::Direction& d) const {
    const glm::dvec2 place = place_of(eye, d);
    const double a = d.azimuth_deg * mars::kRadiansPerDegree;
    const double e = d.elevation_deg * mars::kRadiansPerDegree;
    return {origin_m_ + place.x * axes_.east + place.y * axes_.north,
            std::cos(e) * (std::sin(a) * axes_.east + std::cos(a) * axes_.north) + std::sin(e) * axes_.up};
  }

  // The direction whose own eye has a point straight ahead.
  panorama::Direction seen(panorama::Eye eye, const glm::dvec3& point_m) const {
    const glm::dvec3 d = point_m - origin_m_;
    const glm::dvec2 level(glm::dot(d, axes_.east), glm::dot(d, axes_.north));
    panorama::Direction at{0, 0};
    glm::dvec2 place(0, 0);
    for (int n = 0; n < 40; ++n) {
      const glm::dvec2 ahead = level - place;
      at.azimuth_deg = std::atan2(ahead.x, ahead.y) / mars::kRadiansPerDegree;
      at.elevation_deg = std::atan2(glm::dot(d, axes_.up), glm::length(ahead)) / mars::kRadiansPerDegree;
      place = place_of(eye, at);
    }
    return at;
  }

 private:
  glm::dvec2 place_of(panorama::Eye eye, const panorama::Direction& d) const {
    return panorama::eye_place_m(eye, d.azimuth_deg, panorama::faded_base_m(base_m_, d.elevation_deg));
  }

  glm::dvec3 origin_m_;
  mars::LocalFrame axes_;
  double base_m_;
};

}  // namespace test_support
