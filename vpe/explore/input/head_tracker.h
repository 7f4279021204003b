// Place and direction of a tracked head, from opentrack's datagrams ("UDP over network").
//
// A datagram is 48 bytes: x, y, z in centimetres, then yaw, pitch, roll in degrees, each an IEEE 754 double in
// little-endian order. In opentrack's convention positive yaw is to the right, positive pitch up and positive
// roll to the right, as in mars::HeadAngles; x is to the right, y up and z backwards, away from the screen that the
// wearer faces (opentrack passes them so to X-Plane: lateral, vertical, aft). Trackers differ, so each angle can be
// inverted here; positions are inverted in opentrack. A single image at kilometres does not need the position of the
// head; screens that stand still while the head moves do (vpe/explore/screens).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>

#include "mars/geodesy/pose.h"

namespace vpe::explore {

struct HeadDatagram {
  static constexpr std::size_t kBytes = 48;
  static constexpr double kMaxAngle_deg = 360;     // larger angles cannot be a head's
  static constexpr double kMaxPosition_cm = 2000;  // positions are brought within it, as far as a room is wide

  double x_cm = 0;
  double y_cm = 0;
  double z_cm = 0;
  double yaw_deg = 0;
  double pitch_deg = 0;
  double roll_deg = 0;
};

// Parses a datagram. Returns nullopt for another size, numbers that are not finite, and angles beyond
// kMaxAngle_deg.
std::optional<HeadDatagram> parse_head_datagram(std::span<const std::uint8_t> bytes);

struct HeadTrackerOptions {
  static constexpr double kMinScale = 0.1;
  static constexpr double kMaxScale = 10;
  static constexpr double kMaxSmoothing_s = 1;

  bool invert_yaw = false;
  bool invert_pitch = false;
  bool invert_roll = false;
  double scale = 1;           // of all angles: with 2, 90 degrees of the head are 180 of the view
  double smoothing_s = 0.03;  // time constant. Smaller: follows faster, with more jitter; larger: the reverse.

  bool operator==(const HeadTrackerOptions&) const = default;
};

// Describes where a head is and how it is turned.
struct HeadPlace {
  glm::dvec3 position_m{0, 0, 0};  // right, up, backwards
  mars::HeadAngles look;
};

// Follows the datagrams. Times are seconds of one clock that does not run backwards (an earlier time counts as
// the last one). The look is a continuous function of time, also when datagrams stop or return: it follows each
// datagram with the time constant smoothing_s, eases to zero within kEase_s after kTimeout_s without datagrams,
// and eases to the head's direction within kEase_s when they return. For one thread at a time.
//
// Typical usage, in each iteration of the event loop:
//   receiver.poll([&](std::span<const std::uint8_t> bytes) { tracker.receive(bytes, time_s); });
//   session.advance(dt_s, controls, tracker.look(time_s));
class HeadTracker {
 public:
  static constexpr double kTimeout_s = 0.5;
  static constexpr double kEase_s = 0.5;

  // Clamps options to their limits; options that are not finite get their defaults.
  explicit HeadTracker(const HeadTrackerOptions& options = {});

  // Changes the options; the look eases to the new direction of the last datagram.
  void set_options(const HeadTrackerOptions& options, double time_s);

  // Processes a datagram. Returns false if the bytes are not one; these are counted and otherwise ignored.
  bool receive(std::span<const std::uint8_t> bytes, double time_s);

  // Makes the head's present direction straight ahead and its place zero; the look eases there. Does nothing if no
  // datagram came within the time-out.
  void recentre(double time_s);

  // Returns the direction relative to the platform: yaw and roll in [-180, 180], pitch in [-90, 90].
  mars::HeadAngles look(double time_s) const;

  // Returns look() and the head's position relative to where it was at recentre(), or to the tracker's zero: metres to
  // the right, up and backwards, within twice kMaxPosition_cm. HeadTrackerOptions::scale and the inversions are of
  // angles alone.
  HeadPlace place(double time_s) const;

  // Returns true if a datagram came within the time-out.
  bool is_live(double time_s) const;

  // Returns true if place() is still changing at this time, so that the next image will differ.
  bool is_moving(double time_s) const;

  std::uint64_t received() const { return received_; }
  std::uint64_t ignored() const { return ignored_; }

 private:
  using Motion = std::array<double, 6>;  // yaw, pitch, roll, degrees; right, up, backwards, metres

  Motion target() const;
  Motion followed(double time_s) const;
  Motion motion(double time_s) const;
  void ease_from(const Motion& shown, double time_s);
  double not_before(double time_s) const;

  HeadTrackerOptions options_;
  std::optional<double> last_s_;  // time of the last datagram
  Motion raw_{};                  // what it says
  Motion centre_{};               // what it says of a head that looks straight ahead, at zero
  Motion from_{};                 // followed motion at last_s_
  Motion to_{};                   // motion that is followed since then
  Motion left_{};                 // difference of the motion from the followed one, at eased_s_
  double eased_s_ = 0;
  double now_s_ = 0;
  std::uint64_t received_ = 0;
  std::uint64_t ignored_ = 0;
};

}  // namespace vpe::explore
