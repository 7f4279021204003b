#include <algorithm>
#include <array>
#include <initializer_list>
#include <utility>

#include "scripts/flight.h"
#include "vpe/base/number.h"

namespace scripts {

using vpe::base::format_number;

namespace {

using Fields = std::initializer_list<std::pair<const char*, double>>;

std::string at_line(double time_s, const char* command, Fields fields) {
  std::string line = "at " + format_number(time_s) + " " + command;
  for (const auto& [key, value] : fields) line.append(" ").append(key).append("=").append(format_number(value));
  return line + "\n";
}

// Adds quotes where the value would not be read back as one word.
std::string value_text(const std::string& text) {
  if (text.find_first_of(" \t\r\v\f#\"") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + "\"";
}

std::string size_text(int width, int height) { return std::to_string(width) + "x" + std::to_string(height); }

}  // namespace

FlightVersion version_of(const Flight& flight) {
  if (!flight.reliefs.empty() || !flight.patches.empty()) return FlightVersion::k1_3;
  if (!flight.objects.empty()) return FlightVersion::k1_2;
  return flight.views.empty() ? FlightVersion::k1 : FlightVersion::k1_1;
}

std::string version_line(FlightVersion version) {
  constexpr std::array<const char*, 4> kLines{"flight 1\n", "flight 1.1\n", "flight 1.2\n", "flight 1.3\n"};
  return kLines[static_cast<std::size_t>(version)];
}

std::string to_line(const FlightView& view) {
  return "view fov=" + format_number(view.fov_deg) + " size=" + size_text(view.width, view.height) +
         " fps=" + to_text(view.fps) + "\n";
}

std::string to_line(const Waypoint& w) {
  return at_line(w.time_s, "pose",
                 {{"lon", w.lon_deg},
                  {"lat", w.lat_deg},
                  {w.above_terrain ? "height" : "alt", w.up_m},
                  {"yaw", w.yaw_deg},
                  {"pitch", w.pitch_deg},
                  {"roll", w.roll_deg}});
}

std::string to_line(const HeadCommand& head) {
  return at_line(head.time_s, "look",
                 {{"yaw", head.yaw_deg}, {"pitch", head.pitch_deg}, {"roll", head.roll_deg}});
}

std::string to_line(const SetCommand& set) {
  return "at " + format_number(set.time_s) + " set " + set.key + "=" + value_text(set.text) + "\n";
}

std::string to_line(const InterestCommand& interest) {
  return at_line(interest.time_s, "interest",
                 {{"lon", interest.region.lon_deg},
                  {"lat", interest.region.lat_deg},
                  {"radius", interest.region.radius_m},
                  {"levels", interest.region.levels}});
}

std::string to_line(const ViewCommand& command) {
  const ViewState& view = command.view;
  std::string line = "at " + format_number(command.time_s) + " view";
  if (view.fov_deg) line += " fov=" + format_number(*view.fov_deg);
  if (view.size) line += " size=" + size_text(view.size->width, view.size->height);
  if (view.backend) line.append(" backend=").append(vpe::core::to_string(*view.backend));
  if (view.eyes)
    line.append(" eyes=").append(view.eyes->layout ? vpe::core::to_string(*view.eyes->layout) : "off");
  if (view.eye_base_m) line += " base=" + format_number(*view.eye_base_m);
  if (view.convergence_m) line += " convergence=" + format_number(*view.convergence_m);
  return line + "\n";
}

std::string to_line(const ObjectCommand& command) {
  std::string line = "at " + format_number(command.time_s) + " object " + value_text(command.name);
  if (command.place) {
    line += " lon=" + format_number(command.place->lon_deg) + " lat=" + format_number(command.place->lat_deg) +
            " height=" + format_number(command.place->height_m);
    if (command.place->heading_deg) line += " heading=" + format_number(*command.place->heading_deg);
  }
  if (command.is_shown) line += *command.is_shown ? " show=on" : " show=off";
  return line + "\n";
}

std::string to_line(const ReliefCommand& command) {
  std::string line = "at " + format_number(command.time_s) + " relief " + value_text(command.name);
  if (!command.keys.empty()) line += " " + command.keys;
  if (command.is_shown) line += *command.is_shown ? " show=on" : " show=off";
  return line + "\n";
}

std::string to_line(const PatchCommand& command) {
  return "at " + format_number(command.time_s) + " patch " + value_text(command.file) +
         " mix=" + format_number(command.mix) + "\n";
}

std::string end_line(double time_s) { return at_line(time_s, "end", {}); }

std::string to_text(const Flight& flight) {
  std::vector<std::pair<double, std::string>> lines;
  const auto add = [&](const auto& commands) {
    for (const auto& command : commands) lines.emplace_back(command.time_s, to_line(command));
  };
  add(flight.waypoints);
  add(flight.heads);
  add(flight.sets);
  add(flight.interests);
  add(flight.views);
  add(flight.objects);
  add(flight.reliefs);
  add(flight.patches);
  std::stable_sort(lines.begin(), lines.end(), [](const auto& a, const auto& b) { return a.first < b.first; });

  std::string text = version_line(version_of(flight)) + to_line(flight.view);
  for (const auto& [time_s, line] : lines) text += line;
  if (flight.end_s) text += end_line(*flight.end_s);
  return text;
}

}  // namespace scripts
