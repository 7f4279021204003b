// Chooses what draws the images of a session, and for which eyes: by the user's choice, or that of a flight.
#pragma once

#include <optional>

#include "vpe/core/drawn_by.h"
#include "vpe/core/stereo.h"
#include "vpe/explore/flight_player.h"

namespace vpe::explore {

struct DrawChoice {
  core::DrawnBy drawn_by = core::DrawnBy::kAuto;
  std::optional<core::StereoLayout> stereo;
  double eye_base_m = 0;     // 0: follows the height above the ground
  double convergence_m = 0;  // where the eyes' images coincide; 0: infinitely far

  bool operator==(const DrawChoice&) const = default;
};

// Finds the choice that holds. While a flight is followed, it is the flight's where the flight says something. What the
// user changes meanwhile holds until the flight is left. For one thread at a time.
//
// Typical usage, before each image:
//   const DrawChoice chosen = chooser.update(own, session.follows_flight() ? session.player() : nullptr);
class DrawChooser {
 public:
  // Takes the user's choice and the flight that is followed, or null. Returns the choice that holds.
  const DrawChoice& update(const DrawChoice& own, FlightPlayer* flight);
  // Returns the choice of the last update().
  const DrawChoice& choice() const { return choice_; }

 private:
  std::optional<DrawChoice> own_;  // at the last update
  DrawChoice choice_;
};

}  // namespace vpe::explore
