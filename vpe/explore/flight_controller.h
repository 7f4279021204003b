// The flight of a session: being edited and played at once.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "mars/geodesy/pose.h"
#include "scripts/path.h"
#include "vpe/explore/flight_editor.h"
#include "vpe/explore/flight_player.h"

namespace vpe::explore {

class FlightController {
 public:
  FlightController(double radius_m, scripts::TerrainHeight terrain_height_m);

  // Replaces what is there; paused at the start. What is wrong, empty when all is well; then nothing changes.
  [[nodiscard]] std::string take(const scripts::Flight& flight);
  void clear();

  // A waypoint at the end, at its altitude, reached with a ground speed; the first one makes the flight.
  [[nodiscard]] std::string add(const mars::Pose& pose, double speed_m_per_s);

  // Null when there is no flight.
  FlightEditor* editor() { return editor_ ? &*editor_ : nullptr; }
  const FlightEditor* editor() const { return editor_ ? &*editor_ : nullptr; }
  // As the flight is now: an edit shows at once, with the player's time, speed, loop, look and settings kept by hand as they were. Null when
  // there is no flight or it cannot be played (problem()).
  FlightPlayer* player(double exaggeration);
  // Why it cannot be played; empty when it can.
  const std::string& problem() const { return problem_; }

 private:
  double radius_m_;
  scripts::TerrainHeight terrain_height_m_;
  std::optional<FlightEditor> editor_;
  std::uint64_t played_ = 0;  // revision of the flight that the player was made of
  double played_exaggeration_ = 1;
  std::optional<FlightPlayer> player_;
  std::string problem_;
};

}  // namespace vpe::explore
