// Flights as text: waypoints, where the head looks, settings and regions of interest at times.
//
// One command a line, `#` starts a comment, words are split by blanks, lines end with LF or CRLF, UTF-8 (a byte
// order mark is skipped). Degrees, metres, seconds from the start; numbers are the same in every locale.
//
//   flight 1                                  format version, the first command
//   view fov=60 size=1280x720 fps=30          at most once, before the first `at`; each key may be left out
//   at 0   pose lon=-74 lat=-13.5 alt=12000 yaw=90 pitch=-15 roll=0
//   at 8   pose lon=-68 lat=-13.2 height=3000 yaw=100 pitch=-10 roll=-20
//   at 8   set mode=textured exaggeration=2   keys of the settings registry (vpe/core/appearance/settings.h)
//   at 9   set overlay.title="West of it"     a value with blanks or # stands in quotes; inside, a backslash keeps the
//                                            next character as it is
//   at 10  look yaw=40 pitch=5                head on its platform
//   at 12  interest lon=-67 lat=-13 radius=40000 levels=+1
//   at 20  end                                the last command; left out: the flight ends at the last time
//   given
//
// `pose` needs lon, lat and one of alt (above the sphere) and height (above the terrain); angles left out are
// 0. Times never run backwards; there is one pose and one look a time, and at least one pose in all.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mars/geodesy/pose.h"
#include "scripts/frame_rate.h"
#include "vpe/core/interest.h"

namespace scripts {

struct FlightLimits {
  static constexpr double kMaxTime_s = 1e6;
  static constexpr double kMinAlt_m = -1e7;
  static constexpr double kMaxAlt_m = 1e10;
  static constexpr double kMaxRadius_m = vpe::core::InterestLimits::kMaxRadius_m;  // of a region of interest
  static constexpr int kMaxLevels = vpe::core::InterestLimits::kMaxLevels;
};

struct FlightView {
  double fov_deg = 60;  // vertical
  int width = 1280;
  int height = 720;
  FrameRate fps;

  bool operator==(const FlightView&) const = default;
};

struct Waypoint {
  double time_s = 0;
  double lon_deg = 0;
  double lat_deg = 0;
  double up_m = 0;  // alt, or height when above_terrain
  bool above_terrain = false;
  double yaw_deg = 0;
  double pitch_deg = 0;
  double roll_deg = 0;

  bool operator==(const Waypoint&) const = default;
};

struct Look {
  double time_s = 0;
  double yaw_deg = 0;
  double pitch_deg = 0;
  double roll_deg = 0;

  bool operator==(const Look&) const = default;
};

struct SetCommand {
  double time_s = 0;
  std::string key;
  std::string text;

  bool operator==(const SetCommand&) const = default;
};

// From a time on, a region of interest (core::InterestRegion).
struct Interest {
  double time_s = 0;
  double lon_deg = 0;
  double lat_deg = 0;
  double radius_m = 0;
  int levels = 0;

  bool operator==(const Interest&) const = default;
};

// Each list is in ascending order of time; parse_flight() gives nothing else.
struct Flight {
  FlightView view;
  std::vector<Waypoint> waypoints;
  std::vector<Look> looks;
  std::vector<SetCommand> sets;
  std::vector<Interest> interests;
  std::optional<double> end_s;

  bool operator==(const Flight&) const = default;
};

// The end, or the last time given.
double duration_s(const Flight& flight);

struct FlightError {
  std::string file;
  int line = 0;          // from 1
  std::string expected;  // what was expected and what was found
};

// "FILE:LINE: expected ..."
std::string to_string(const FlightError& error);

// Either a flight and no errors, or no flight and at least one error (the first kMaxErrors of them).
struct ParsedFlight {
  static constexpr int kMaxErrors = 20;
  std::optional<Flight> flight;
  std::vector<FlightError> errors;
};

// Any text is allowed, also binary rubbish. `name` is what errors call the file.
ParsedFlight parse_flight(std::string_view text, const std::string& name);

// parse_flight(to_text(flight)) == flight, for every flight that parse_flight() can give.
std::string to_text(const Flight& flight);

// Single lines of the format, with their newline: what to_text() and logs are made of.
std::string to_line(const FlightView& view);
std::string to_line(const Waypoint& waypoint);
std::string to_line(const Look& look);
std::string to_line(const SetCommand& set);
std::string to_line(const Interest& interest);
std::string end_line(double time_s);
std::string version_line();

}  // namespace scripts
