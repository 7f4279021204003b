#include "vpe/app/picture/pose_option.h"

#include <cmath>

#include "paging/surface/surface.h"
#include "vpe/app/cli/parsing.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/places/named_places.h"
#include "vpe/base/number.h"
#include "vpe/core/view.h"

namespace vpe::app {

ParsedPose parse_pose(const std::string& option, const std::string& text, std::optional<double> height_m) {
  const auto refuse = [&](const std::string& why) -> UsageError {
    return UsageError(option + " '" + text + "': " + why);
  };
  if (is_name(text)) {
    const core::Place place = place_named(option, text);
    if (height_m) return {{place.lon_deg, place.lat_deg, 0, 0, 0, 0}, height_m, {}, place.name};
    const SightOfPlace sight = sight_of(place, mars::kMarsRadius_m);
    return {
        {sight.lon_deg, sight.lat_deg, 0, sight.yaw_deg, sight.pitch_deg, 0}, sight.height_m, {}, place.name};
  }
  const auto n = parse_numbers(text);
  if (!n || n->size() < (height_m ? 2 : 3) || n->size() > 6)
    throw refuse(
        "expected LON,LAT,ALT,YAW,PITCH,ROLL (degrees; ALT in metres above the sphere), or the name of a place");
  if (height_m && (n->size() == 3 || n->size() == 4))
    throw refuse(
        "with --height it is not clear whether this has an ALT; give LON,LAT or LON,LAT,YAW,PITCH,ROLL or "
        "LON,LAT,ALT,YAW,PITCH,ROLL");
  const std::size_t yaw = height_m && n->size() == 5 ? 2 : 3;  // index
  const auto number = [&](std::size_t k) { return k < n->size() ? (*n)[k] : 0.0; };
  ParsedPose parsed{{number(0), number(1), 0, number(yaw), number(yaw + 1), number(yaw + 2)}, height_m, {}, {}};
  if (yaw == 2) {
    const auto text_of = [&](std::size_t k) { return base::format_number(number(k)); };
    parsed.note = option + " '" + text + "' with --height is read as yaw " + text_of(2) + ", pitch " +
                  text_of(3) + ", roll " + text_of(4);
  }
  if (!(std::abs(parsed.pose.lon_deg) <= 360)) throw refuse("longitude must be within -360..360");
  if (!(std::abs(parsed.pose.lat_deg) <= 90)) throw refuse("latitude must be within -90..90");
  if (height_m) return parsed;
  parsed.pose.alt_m = (*n)[2];
  constexpr double kMost_m = core::ViewLimits::kMaxCameraDistance_m;
  if (std::abs(parsed.pose.alt_m) > kMost_m)
    throw refuse("ALT must be within " + base::format_number(-kMost_m) + ".." + base::format_number(kMost_m) +
                 " m");
  return parsed;
}

mars::Pose resolve(const ParsedPose& parsed, const std::shared_ptr<const paging::PlanetFile>& planet,
                   double exaggeration) {
  if (!parsed.name.empty()) require_mars_for_name("pose", parsed.name, planet->meta());
  mars::Pose pose = parsed.pose;
  if (!parsed.height_m) {
    if (!(planet->radius_m() + pose.alt_m > 0))
      throw UsageError("ALT " + base::format_number(pose.alt_m) + " m is not above the planet's centre, " +
                       base::format_number(planet->radius_m()) + " m below the sphere");
    return pose;
  }
  constexpr std::size_t kCacheBytes = std::size_t{8} << 20;
  const paging::Surface surface(planet, kCacheBytes);
  pose.alt_m =
      surface.at(mars::direction({pose.lon_deg, pose.lat_deg}), exaggeration).height_m + *parsed.height_m;
  return pose;
}

}  // namespace vpe::app
