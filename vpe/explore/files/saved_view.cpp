#include "vpe/explore/files/saved_view.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "scripts/flight.h"
#include "vpe/base/number.h"
#include "vpe/core/view.h"

namespace vpe::explore {

bool same(const SavedView& a, const SavedView& b) {
  return a.pose.lon_deg == b.pose.lon_deg && a.pose.lat_deg == b.pose.lat_deg && a.pose.alt_m == b.pose.alt_m &&
         a.pose.yaw_deg == b.pose.yaw_deg && a.pose.pitch_deg == b.pose.pitch_deg &&
         a.pose.roll_deg == b.pose.roll_deg && a.fov_deg == b.fov_deg;
}

ViewDifference difference(const SavedView& a, const SavedView& b, double radius_m) {
  const mars::CameraPose p = mars::to_camera(a.pose, radius_m);
  const mars::CameraPose q = mars::to_camera(b.pose, radius_m);
  const double rotation_rad = std::max(mars::angle_between_rad(p.axes.forward, q.axes.forward),
                                       mars::angle_between_rad(p.axes.up, q.axes.up));
  return {glm::length(p.position_m - q.position_m), rotation_rad / mars::kRadiansPerDegree,
          std::max(a.fov_deg, b.fov_deg) / std::min(a.fov_deg, b.fov_deg)};
}

std::string problem_of(const SavedView& view) {
  using Limits = scripts::FlightLimits;
  struct Range {
    const char* name;
    double value;
    double min;
    double max;
  };
  for (const Range& r :
       {Range{"lon", view.pose.lon_deg, -360, 360}, Range{"lat", view.pose.lat_deg, -90, 90},
        Range{"alt", view.pose.alt_m, Limits::kMinAlt_m, Limits::kMaxAlt_m},
        Range{"yaw", view.pose.yaw_deg, -360, 360}, Range{"pitch", view.pose.pitch_deg, -90, 90},
        Range{"roll", view.pose.roll_deg, -360, 360},
        Range{"fov", view.fov_deg, core::ViewLimits::kMinFov_deg, core::ViewLimits::kMaxFov_deg}}) {
    if (!(r.value >= r.min && r.value <= r.max)) {
      return std::string(r.name) + " must be from " + base::format_number(r.min) + " to " +
             base::format_number(r.max) + ", not " + base::format_number(r.value);
    }
  }
  return "";
}

}  // namespace vpe::explore
