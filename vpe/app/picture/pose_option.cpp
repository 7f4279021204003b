#include "vpe/app/picture/pose_option.h"

#include <cmath>

#include "paging/surface/surface.h"
#include "vpe/app/cli/parsing.h"
#include "vpe/app/cli/program.h"
#include "vpe/base/number.h"
#include "vpe/core/view.h"

namespace vpe::app {

ParsedPose parse_pose(const std::string& option, const std::string& text, std::optional<double> height_m) {
  const auto n = parse_numbers(text);
  const bool has_alt = !height_m || (n && n->size() == 6);
  const std::size_t angles = has_alt ? 3 : 2;  // index of yaw
  if (!n || n->size() < (height_m ? 2 : 3) || n->size() > angles + 3) {
    throw UsageError(option + " '" + text + "': expected " +
                     (height_m ? "LON,LAT,YAW,PITCH,ROLL (degrees; --height replaces ALT)"
                               : "LON,LAT,ALT,YAW,PITCH,ROLL (degrees; ALT in metres above the sphere)"));
  }
  const auto angle = [&](std::size_t k) { return angles + k < n->size() ? (*n)[angles + k] : 0.0; };
  ParsedPose parsed{{(*n)[0], (*n)[1], 0, angle(0), angle(1), angle(2)}, height_m};
  if (!mars::is_valid({parsed.pose.lon_deg, parsed.pose.lat_deg})) {
    throw UsageError(option + " '" + text + "': latitude must be within -90..90");
  }
  if (height_m) return parsed;
  parsed.pose.alt_m = (*n)[2];
  constexpr double kMost_m = core::ViewLimits::kMaxCameraDistance_m;
  if (std::abs(parsed.pose.alt_m) > kMost_m) {
    throw UsageError(option + " '" + text + "': ALT must be within " + base::format_number(-kMost_m) + ".." +
                     base::format_number(kMost_m) + " m");
  }
  return parsed;
}

mars::Pose resolve(const ParsedPose& parsed, const std::shared_ptr<const paging::PlanetFile>& planet,
                   double exaggeration) {
  mars::Pose pose = parsed.pose;
  if (!parsed.height_m) return pose;
  constexpr std::size_t kCacheBytes = std::size_t{8} << 20;
  const paging::Surface surface(planet, kCacheBytes);
  pose.alt_m =
      surface.at(mars::direction({pose.lon_deg, pose.lat_deg}), exaggeration).height_m + *parsed.height_m;
  return pose;
}

}  // namespace vpe::app
