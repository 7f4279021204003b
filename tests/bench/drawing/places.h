// Views of the embedded Mars that benchmarks of drawing share: those of `vpe report error-time`.
#pragma once

#include <array>
#include <string>

#include "mars/geodesy/pose.h"
#include "mars/geodesy/sun.h"
#include "paging/surface/surface.h"
#include "vpe/core/frame.h"

namespace bench {

struct PlaceOfView {
  const char* name;
  mars::Pose pose;  // its altitude is above the ground
};

inline constexpr std::array kPlaces{PlaceOfView{"orbit", {-65, -12, 400'000, 20, -70, 0}},
                                    PlaceOfView{"oblique", {-66, -14.5, 25'000, 330, -30, 0}},
                                    PlaceOfView{"floor", {-64.2, -12.9, 200, 281, 2, 0}},
                                    PlaceOfView{"rim", {-59.2, -13.7, 800, 90, -8, 0}}};

// Returns a request with hard edges, before black, in the light of a sun 40 degrees up.
inline vpe::core::DrawRequest request_at(const PlaceOfView& place, const paging::Surface& surface, int width,
                                         int height) {
  mars::Pose pose = place.pose;
  pose.alt_m += surface.at(mars::direction({pose.lon_deg, pose.lat_deg})).height_m;
  vpe::core::DrawRequest request;
  request.view.camera = mars::to_camera(pose, surface.planet().radius_m());
  request.view.width = width;
  request.view.height = height;
  request.settings.smooth_edges = false;
  request.settings.background = vpe::core::Background::kBlack;
  request.sun = mars::sun_direction({pose.lon_deg, pose.lat_deg}, 315, 40);
  request.want_range = true;
  return request;
}

}  // namespace bench
