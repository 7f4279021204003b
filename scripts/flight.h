// Flights as text: waypoints, head angles, settings, regions of interest and views at times.
//
// One command a line, `#` starts a comment, words are split by blanks, lines end with LF or CRLF, UTF-8 (a byte
// order mark is skipped). Degrees, metres, seconds from the start; numbers are the same in every locale.
//
//   flight 1.1                                format version, the first command; 1 where no view has a time
//   view fov=60 size=1280x720 fps=30          at most once, before the first `at`; each key may be left out
//   at 0   pose lon=-74 lat=-13.5 alt=12000 yaw=90 pitch=-15 roll=0
//   at 8   pose lon=-68 lat=-13.2 height=3000 yaw=100 pitch=-10 roll=-20
//   at 8   set mode=textured exaggeration=2   keys of the settings registry (vpe/core/appearance/settings.h)
//   at 9   set overlay.title="West of it"     a value with blanks or # needs quotes; inside them, a backslash
//                                             keeps the next character unchanged
//   at 10  look yaw=40 pitch=5                head angles relative to the platform
//   at 12  interest lon=-67 lat=-13 radius=40000 levels=+1
//   at 14  view fov=30 backend=ray eyes=sbs base=2 convergence=90 size=1920x1080
//                                             version 1.1; each key may be left out
//   at 15  object Curiosity lon=137.4 lat=-4.6 heading=90
//                                             version 1.2; a name with blanks needs quotes
//   at 16  object Curiosity show=off
//   at 17  relief "a crater" kind=crater lon=137.4 lat=-4.6 radius=100 depth=20
//                                             version 1.3; keys of relief/spec_line.h
//   at 19  relief "a crater" radius=400 depth=80
//   at 19  patch new.vpe mix=0.5              version 1.3; a planet, a raster or *.relief.toml
//   at 20  end                                the last command; without it, the flight ends at its last time
//
// `pose` needs lon, lat and one of alt (above the sphere) and height (above the terrain); angles left out are
// 0. Times never run backwards. There is at most one pose, one look and one view at a time, and at least one pose
// in all.
//
// `view` at a time says how images are drawn: `fov` (vertical), `backend` (polygon, ray, or auto: the program
// chooses), `eyes` (off, or the layout of a stereo pair: sbs, ou, anaglyph), `base` between the eyes (0: follows
// the height above the ground), `convergence`, the distance at which both eyes' images coincide (0: infinitely far), and
// `size` of an image. The field of view changes smoothly from one such line to
// the next, beginning with that of the `view` line without a time, so a zoom lasts as long as the time between
// them; two equal ones hold it (scripts/path.h). The other keys hold from their time on, as settings do.
//
// `object` places an object of the scene by its name: `lon` and `lat`, `height` above the ground (0) and `heading`
// (along its way). Lines of one name are points of its way: it moves evenly from each to the next along the great circle,
// and stands at the first one before its time and at the last one after it. `show=off` hides it from then on, `show=on`
// shows it. There is at most one line of a name at a time.
//
// `relief` changes the ground by a formula (relief/spec.h). A line with `kind` describes the relief of a name, which is
// there from then on; later lines without it change keys. Numbers change smoothly from one line that gives them to the next,
// angles the short way; a key cannot change between a number and `auto`. Words, `octaves` and `seed` hold from their time
// on. `spacing` belongs to the line with `kind`. `show` is as for objects. `patch` changes the ground towards that of a file:
// `mix` is the share of the difference, and changes smoothly too. Patches come first, then reliefs, each in the order of
// their first lines (scripts/ground_tracks.h).
//
// Typical usage:
//   const ParsedFlight parsed = parse_flight(text, "tour.flight");
//   for (const FlightError& error : parsed.errors) print(to_string(error));
//   if (parsed.flight) write(to_text(*parsed.flight));
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mars/geodesy/pose.h"
#include "scripts/frame_rate.h"
#include "vpe/core/drawn_by.h"
#include "vpe/core/interest.h"
#include "vpe/core/object_track.h"
#include "vpe/core/stereo.h"

namespace scripts {

struct FlightLimits {
  static constexpr double kMaxTime_s = 1e6;
  static constexpr double kMinAlt_m = -1e7;
  static constexpr double kMaxAlt_m = 1e10;
  static constexpr double kMaxRadius_m = vpe::core::InterestLimits::kMaxRadius_m;  // of a region of interest
  static constexpr int kMaxLevels = vpe::core::InterestLimits::kMaxLevels;
  static constexpr double kMaxEyeBase_m = 1e9;
  static constexpr double kMaxConvergence_m = 1e12;
};

// The versions of the format. All are read. A flight is written in the oldest one that can hold it.
enum class FlightVersion : std::uint8_t {
  k1,
  k1_1,  // also `view` at a time
  k1_2,  // also `object`
  k1_3,  // also `relief` and `patch`
};

// Holds the `view` line: how the flight is filmed.
struct FlightView {
  double fov_deg = 60;  // vertical
  int width = 1280;
  int height = 720;
  FrameRate fps;

  bool operator==(const FlightView&) const = default;
};

// Holds a `pose` line.
struct Waypoint {
  double time_s = 0;
  double lon_deg = 0;
  double lat_deg = 0;
  double up_m = 0;  // alt, or height if above_terrain
  bool above_terrain = false;
  double yaw_deg = 0;
  double pitch_deg = 0;
  double roll_deg = 0;

  bool operator==(const Waypoint&) const = default;
};

// Holds a `look` line: the angles of the head (mars::HeadAngles) at a time.
struct HeadCommand {
  double time_s = 0;
  double yaw_deg = 0;
  double pitch_deg = 0;
  double roll_deg = 0;

  bool operator==(const HeadCommand&) const = default;
};

// Holds one setting of a `set` line.
struct SetCommand {
  double time_s = 0;
  std::string key;
  std::string text;

  bool operator==(const SetCommand&) const = default;
};

// Holds an `interest` line: a region of interest from a time on.
struct InterestCommand {
  double time_s = 0;
  vpe::core::InterestRegion region;

  bool operator==(const InterestCommand&) const = default;
};

// Says for how many eyes images are drawn.
struct Eyes {
  std::optional<vpe::core::StereoLayout> layout;  // nullopt: one image for both

  bool operator==(const Eyes&) const = default;
};

struct ImageSize {
  int width = 0;
  int height = 0;

  bool operator==(const ImageSize&) const = default;
};

// Says how images are drawn. A member without a value says nothing.
struct ViewState {
  std::optional<double> fov_deg;  // vertical
  std::optional<ImageSize> size;
  std::optional<vpe::core::DrawnBy> backend;  // kAuto: the program chooses
  std::optional<Eyes> eyes;
  std::optional<double> eye_base_m;     // 0: follows the height above the ground
  std::optional<double> convergence_m;  // where the eyes' images coincide; 0: infinitely far

  bool operator==(const ViewState&) const = default;
};

// Holds a `view` line with a time. At least one member of the view has a value.
struct ViewCommand {
  double time_s = 0;
  ViewState view;

  bool operator==(const ViewCommand&) const = default;
};

// Holds an `object` line: its place, whether it is shown, or both.
struct ObjectCommand {
  double time_s = 0;
  std::string name;
  std::optional<vpe::core::ObjectPlace> place;
  std::optional<bool> is_shown;

  bool operator==(const ObjectCommand&) const = default;
};

// Holds a `relief` line: keys of a relief, whether it is shown, or both.
struct ReliefCommand {
  double time_s = 0;
  std::string name;
  std::string keys;  // as relief::parse_relief_line() reads them, separated by a blank; may be empty
  std::optional<bool> is_shown;

  bool operator==(const ReliefCommand&) const = default;
};

// Holds a `patch` line.
struct PatchCommand {
  double time_s = 0;
  std::string file;
  double mix = 0;  // 0: the ground without the file; 1: with it

  bool operator==(const PatchCommand&) const = default;
};

// Holds a whole flight. Each list is in ascending order of time; parse_flight() ensures it.
struct Flight {
  FlightView view;
  std::vector<Waypoint> waypoints;
  std::vector<HeadCommand> heads;
  std::vector<SetCommand> sets;
  std::vector<InterestCommand> interests;
  std::vector<ViewCommand> views;
  std::vector<ObjectCommand> objects;
  std::vector<ReliefCommand> reliefs;
  std::vector<PatchCommand> patches;
  std::optional<double> end_s;

  bool operator==(const Flight&) const = default;
};

// Returns the oldest version that holds a flight: k1 if no view has a time, no object moves and the ground
// stays.
FlightVersion version_of(const Flight& flight);

// Returns the time of the end, or the last time in the flight.
double duration_s(const Flight& flight);

// Describes one bad line.
struct FlightError {
  std::string file;
  int line = 0;          // from 1
  std::string expected;  // what was expected and what was found
};

// Returns "FILE:LINE: expected ...".
std::string to_string(const FlightError& error);

// Holds either a flight and no errors, or no flight and at least one error (the first kMaxErrors of them).
struct ParsedFlight {
  static constexpr int kMaxErrors = 20;
  std::optional<Flight> flight;
  std::vector<FlightError> errors;
};

// Parses any text, also binary data. `name` is the file's name in errors.
ParsedFlight parse_flight(std::string_view text, const std::string& name);

// Writes a flight as text, in the version of version_of(). parse_flight(to_text(flight)) == flight for every flight that parse_flight()
// returns.
std::string to_text(const Flight& flight);

// Return single lines of the format, with their newline. to_text() and logs consist of them.
std::string to_line(const FlightView& view);
std::string to_line(const Waypoint& waypoint);
std::string to_line(const HeadCommand& head);
std::string to_line(const SetCommand& set);
std::string to_line(const InterestCommand& interest);
std::string to_line(const ViewCommand& command);
std::string to_line(const ObjectCommand& command);
std::string to_line(const ReliefCommand& command);
std::string to_line(const PatchCommand& command);
std::string end_line(double time_s);
std::string version_line(FlightVersion version);

}  // namespace scripts
