// Plays a flight: play, pause, scrub, speed, loop, with the user's own look around on top.
//
// No clock: advance() is told how much time went by. What it shows at a time is what scripts::Path says of that
// time, however it got there.
#pragma once

#include <map>
#include <span>
#include <string>

#include "scripts/path.h"
#include "vpe/core/appearance/settings.h"

namespace vpe::explore {

struct FlightPlayerLimits {
  static constexpr double kSlowest = 0.01;  // of the speed's absolute value
  static constexpr double kFastest = 100;
};

class FlightPlayer {
 public:
  // Paused at the start.
  FlightPlayer(scripts::Path path, double radius_m);

  // At the end of what is ahead (the end, or the start when the speed is negative) it begins again from the
  // other.
  void play();
  void pause() { playing_ = false; }
  bool is_playing() const { return playing_; }

  // Time goes by in the user's world, seconds, 0 or more. Without a loop it stops exactly at the end (or start)
  // and pauses there. With one the end is the start: what is beyond the end is beyond the start, however long
  // it was.
  void advance(double dt_s);

  // To a time, kept to the flight; playing or pausing stays as it is.
  void scrub(double time_s);

  // Seconds of flight a second, negative: backwards. Kept to FlightPlayerLimits with its sign; what is 0 or not
  // finite changes nothing (pause() stands still).
  void set_speed(double speed);
  double speed() const { return speed_; }
  void set_loop(bool loop) { loop_ = loop; }
  bool loops() const { return loop_; }

  double time_s() const { return time_s_; }
  double duration_s() const { return path_.duration_s(); }
  bool at_start() const { return time_s_ <= 0; }
  bool at_end() const { return time_s_ >= duration_s(); }
  const scripts::Path& path() const { return path_; }

  // The user's look, added to that of the flight angle by angle (pitch stops straight up and down). The
  // platform's motion and the flight's own look go on below it. Angles that are not finite count as 0.
  void view_panorama(const mars::HeadAngles& offset);
  void turn_look(double yaw_deg, double pitch_deg, double roll_deg = 0);  // further, from where it is
  void look_ahead() { view_panorama({}); }
  const mars::HeadAngles& look_offset() const { return offset_; }

  // Now: without an offset that of Path::at(), to the bit.
  scripts::FlightState state() const;

  // The settings of now: `base` (what held before the flight), the flight's up to and including this time, and
  // over them the user's own. Scrubbed backwards it is again as it was then.
  core::Settings settings(const core::Settings& base) const;

  // A setting of the user's own while the flight plays, which the flight does not undo. Returns what is wrong,
  // as core::Settings::set().
  [[nodiscard]] std::string keep_setting(const std::string& key, const std::string& text);
  void release_setting(const std::string& key) { kept_.erase(key); }
  void release_settings() { kept_.clear(); }
  // Those of another player of the same flight, in place of its own.
  void keep_settings_of(const FlightPlayer& other) { kept_ = other.kept_; }

  std::span<const scripts::Interest> interests() const { return path_.interests(time_s_); }

 private:
  scripts::Path path_;
  double radius_m_;
  double time_s_ = 0;
  double speed_ = 1;
  bool playing_ = false;
  bool loop_ = false;
  mars::HeadAngles offset_;
  std::map<std::string, std::string> kept_;
};

}  // namespace vpe::explore
