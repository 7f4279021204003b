// Where a tracked head looks, from opentrack's datagrams ("UDP over network").
//
// A datagram is 48 bytes: x, y, z in centimetres, then yaw, pitch, roll in degrees, each an IEEE 754 double,
// least significant byte first. As opentrack means them yaw is to the right, pitch up and roll to the right
// when positive, which is mars::HeadAngles; trackers differ, so each can be inverted. x, y, z are read and not
// used: what a head moves is nothing against a planet.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "mars/geodesy/pose.h"

namespace vpe::explore {

struct HeadDatagram {
  static constexpr std::size_t kBytes = 48;
  static constexpr double kMaxAngle_deg = 360;  // a head has no larger angles: such numbers are something else

  double x_cm = 0;
  double y_cm = 0;
  double z_cm = 0;
  double yaw_deg = 0;
  double pitch_deg = 0;
  double roll_deg = 0;
};

// Nothing for another size, numbers that are not finite, and angles beyond kMaxAngle_deg.
std::optional<HeadDatagram> parse_head_datagram(std::span<const std::uint8_t> bytes);

struct HeadTrackerOptions {
  static constexpr double kMinScale = 0.1;
  static constexpr double kMaxScale = 10;
  static constexpr double kMaxSmoothing_s = 1;

  bool invert_yaw = false;
  bool invert_pitch = false;
  bool invert_roll = false;
  double scale = 1;           // of all angles: with 2, half a turn of the head is a whole one of the view
  double smoothing_s = 0.03;  // time in which 63 % of a step is followed; 0 = at once

  bool operator==(const HeadTrackerOptions&) const = default;
};

// Follows the datagrams. Times are seconds of one clock that does not run backwards (an earlier time counts as
// the last one). Between datagrams, when they stop and when they come back the look is a continuous function of
// time: it follows each datagram within smoothing_s, goes to zero in kEase_s after kTimeout_s without any, and
// goes to where the head is in kEase_s when they come back. One thread at a time.
class HeadTracker {
 public:
  static constexpr double kTimeout_s = 0.5;
  static constexpr double kEase_s = 0.5;

  // Options beyond their limits, and numbers that are not finite, are brought within them.
  explicit HeadTracker(const HeadTrackerOptions& options = {});

  // Changes the options; the look eases to what they make of the last datagram.
  void set_options(const HeadTrackerOptions& options, double time_s);

  // Whether the bytes were a datagram; others are counted and change nothing.
  bool receive(std::span<const std::uint8_t> bytes, double time_s);

  // Where the head is now is straight ahead from now on; the look eases there. Nothing happens when no datagram
  // came within the time-out.
  void recentre(double time_s);

  // Relative to the platform: yaw and roll in [-180, 180], pitch in [-90, 90].
  mars::HeadAngles look(double time_s) const;

  // Whether a datagram came within the time-out.
  bool is_live(double time_s) const;

  // Whether look() is on its way to somewhere at this time, so that the next image is another one.
  bool is_moving(double time_s) const;

  std::uint64_t received() const { return received_; }
  std::uint64_t ignored() const { return ignored_; }

 private:
  using Angles = std::array<double, 3>;  // yaw, pitch, roll, degrees

  Angles target() const;
  Angles followed(double time_s) const;
  Angles angles(double time_s) const;
  void ease_from(const Angles& shown, double time_s);
  double not_before(double time_s) const;

  HeadTrackerOptions options_;
  std::optional<double> last_s_;  // of the last datagram
  Angles raw_{};                  // of it
  Angles centre_{};               // raw angles that are straight ahead
  Angles from_{};                 // look that was followed at last_s_
  Angles to_{};                   // look that is followed from then on
  Angles left_{};                 // what the look differs from what is followed, at eased_s_
  double eased_s_ = 0;
  double now_s_ = 0;
  std::uint64_t received_ = 0;
  std::uint64_t ignored_ = 0;
};

}  // namespace vpe::explore
