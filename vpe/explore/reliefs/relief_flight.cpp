#include "vpe/explore/reliefs/relief_flight.h"

#include <algorithm>
#include <set>
#include <stdexcept>
#include <string>

#include "relief/spec_line.h"
#include "vpe/base/number.h"
#include "vpe/explore/reliefs/relief_editor.h"

namespace vpe::explore {

scripts::Flight flight_at(const mars::Pose& pose, double fov_deg, double seconds) {
  scripts::Flight flight;
  flight.view.fov_deg = fov_deg;
  scripts::Waypoint& place = flight.waypoints.emplace_back();
  place.lon_deg = pose.lon_deg;
  place.lat_deg = pose.lat_deg;
  place.up_m = pose.alt_m;
  place.yaw_deg = pose.yaw_deg;
  place.pitch_deg = pose.pitch_deg;
  place.roll_deg = pose.roll_deg;
  flight.end_s = seconds;
  return flight;
}

scripts::Flight with_forming(scripts::Flight flight, std::span<const relief::ReliefSpec> reliefs,
                             double begin_s, double end_s) {
  if (!(begin_s >= 0 && begin_s < end_s)) throw std::invalid_argument("reliefs: expected begin_s below end_s");
  std::set<std::string> taken;
  for (const scripts::ReliefCommand& command : flight.reliefs) taken.insert(command.name);
  for (relief::ReliefSpec relief : reliefs) {
    const std::string title = relief_title(relief);
    std::string name = title;
    for (int n = 2; !taken.insert(name).second; ++n) name = title + " " + std::to_string(n);
    const std::string strength = "strength=" + base::format_number(relief.strength);
    relief.name.clear();
    relief.strength = 0;
    flight.reliefs.push_back({begin_s, name, relief::to_line(relief), std::nullopt});
    flight.reliefs.push_back({end_s, name, strength, std::nullopt});
  }
  std::ranges::stable_sort(flight.reliefs, {}, &scripts::ReliefCommand::time_s);
  if (flight.end_s) flight.end_s = std::max(*flight.end_s, end_s);
  const scripts::ParsedFlight parsed = scripts::parse_flight(scripts::to_text(flight), "flight");
  if (!parsed.flight) throw std::runtime_error(scripts::to_string(parsed.errors.at(0)));
  return *parsed.flight;
}

}  // namespace vpe::explore
