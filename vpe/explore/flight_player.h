// Playback of a flight: play, pause, scrub, speed, loop. The user can look around, zoom and fly beside the flight's
// course at the same time.
//
// The player has no clock: the caller passes the elapsed time to advance(). The state at a time is that of
// scripts::Path and does not depend on how that time was reached.
#pragma once

#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "scripts/path.h"
#include "vpe/core/appearance/settings.h"

namespace vpe::explore {

struct FlightPlayerLimits {
  static constexpr double kSlowest = 0.01;  // of the speed's absolute value
  static constexpr double kFastest = 100;
  static constexpr double kFarthest_m = 1e7;  // of each member of a platform's offset
};

// Holds how far the user has moved the platform off the flight's course, metres in the platform's level frame: right
// and forward are along the sphere, forward in the direction of its heading.
struct PlatformOffset {
  double right_m = 0;
  double up_m = 0;
  double forward_m = 0;

  bool operator==(const PlatformOffset&) const = default;
};

// Plays one path. For one thread at a time.
class FlightPlayer {
 public:
  // Is paused at the start.
  FlightPlayer(scripts::Path path, double radius_m);

  // Starts or continues. At the end (or at the start, if the speed is negative) begins again from the other
  // one.
  void play();
  void pause() { playing_ = false; }
  bool is_playing() const { return playing_; }

  // Advances by elapsed real time, seconds, 0 or more. Without a loop, stops and pauses exactly at the end (or
  // start). With a loop, continues from the other end; any number of loops may pass.
  void advance(double dt_s);

  // Jumps to a time, clamped to the flight. Does not start or pause.
  void scrub(double time_s);

  // Sets the seconds of flight for each real second; negative: backwards. Clamps to FlightPlayerLimits and
  // keeps the sign. Ignores 0 and values that are not finite (use pause() instead).
  void set_speed(double speed);
  double speed() const { return speed_; }
  void set_loop(bool loop) { loop_ = loop; }
  bool loops() const { return loop_; }

  double time_s() const { return time_s_; }
  double duration_s() const { return path_.duration_s(); }
  bool at_start() const { return time_s_ <= 0; }
  bool at_end() const { return time_s_ >= duration_s(); }
  const scripts::Path& path() const { return path_; }

  // Sets the user's look, which is added to that of the flight angle by angle (pitch is clamped to straight up
  // and down). The platform's motion and the flight's own look continue below it. Angles that are not finite
  // count as 0.
  void set_look_offset(const mars::HeadAngles& offset);
  // Adds to the look offset.
  void add_look_offset(double yaw_deg, double pitch_deg, double roll_deg = 0);
  void reset_look_offset() { set_look_offset({}); }
  const mars::HeadAngles& look_offset() const { return offset_; }

  // Sets the user's offset of the platform, which is added to the flight's pose in the frame of that pose: on a course
  // that turns, an offset to the right stays on the right. Regards no ground. Clamps each member to
  // FlightPlayerLimits; numbers that are not finite count as 0.
  void set_platform_offset(const PlatformOffset& offset);
  const PlatformOffset& platform_offset() const { return platform_; }

  // Returns the state now. Without offsets it equals Path::at() bit by bit.
  scripts::FlightState state() const { return state_at(time_s_); }
  // Returns the state at another time, clamped to the flight, with the offsets of now.
  scripts::FlightState state_at(double time_s) const;

  // Returns the settings now: `base` (those before the flight), then the flight's up to and including this
  // time, then the user's own. They depend on the time alone, also after scrubbing backwards.
  core::Settings settings(const core::Settings& base) const;

  // Adds a setting of the user, which overrides the flight's. Returns what is wrong, as core::Settings::set().
  [[nodiscard]] std::string keep_setting(const std::string& key, const std::string& text);
  void release_setting(const std::string& key) { kept_.erase(key); }
  void release_settings() { kept_.clear(); }

  // Returns the view now: the flight's, without the members that the user has taken over.
  scripts::ViewState view() const;

  // Says that the user has taken over the field of view, what draws, or for how many eyes at what distance. view()
  // says nothing about it until release_view().
  void keep_fov() { keeps_.fov = true; }
  void keep_backend() { keeps_.backend = true; }
  void keep_eyes() { keeps_.eyes = true; }
  void release_view() { keeps_ = {}; }

  // Copies what the user has changed, settings and view, from another player of the same flight.
  void keep_changes_of(const FlightPlayer& other) {
    kept_ = other.kept_;
    keeps_ = other.keeps_;
  }

  const std::shared_ptr<const std::vector<core::ObjectTrack>>& tracks() const { return path_.tracks(); }
  const std::shared_ptr<const scripts::GroundTracks>& ground() const { return path_.ground(); }
  std::span<const scripts::InterestCommand> interests() const { return path_.interests(time_s_); }

 private:
  scripts::Path path_;
  double radius_m_;
  double time_s_ = 0;
  double speed_ = 1;
  bool playing_ = false;
  bool loop_ = false;
  mars::HeadAngles offset_;
  PlatformOffset platform_;
  std::map<std::string, std::string> kept_;
  struct Kept {
    bool fov = false;
    bool backend = false;
    bool eyes = false;
  } keeps_;
};

}  // namespace vpe::explore
