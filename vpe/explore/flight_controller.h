// The flight of a session, which can be edited and played at the same time.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "mars/geodesy/pose.h"
#include "scripts/path.h"
#include "vpe/explore/flight_editor.h"
#include "vpe/explore/flight_player.h"

namespace vpe::explore {

// Owns the editor and the player of one flight, and remakes the player after each edit. For one thread at a
// time.
//
// Typical usage:
//   FlightController flights(radius_m, terrain_height_m);
//   if (std::string problem = flights.append(pose, 1000); !problem.empty()) show(problem);
//   if (FlightPlayer* player = flights.player(exaggeration)) player->advance(dt_s);
class FlightController {
 public:
  FlightController(double radius_m, scripts::TerrainHeight terrain_height_m);

  // Uses other terrain of the same body from now on.
  void set_terrain(scripts::TerrainHeight terrain_height_m);

  // Replaces the flight; the player is paused at the start. Returns what is wrong with the flight, or "". A bad
  // flight changes nothing.
  [[nodiscard]] std::string load(const scripts::Flight& flight);
  // Removes the flight.
  void clear();

  // Appends a waypoint at the pose's altitude, reached at a ground speed; makes a new flight if there is none.
  // Returns what is wrong, or "".
  [[nodiscard]] std::string append(const mars::Pose& pose, double speed_m_per_s);

  // Returns a number that changes whenever load(), clear() or append() replaces the editor.
  std::uint64_t loads() const { return loads_; }

  // Returns the editor, or null if there is no flight.
  FlightEditor* editor() { return editor_ ? &*editor_ : nullptr; }
  const FlightEditor* editor() const { return editor_ ? &*editor_ : nullptr; }
  // Returns a player of the flight as edited. Remakes it after an edit, but keeps its time, speed, loop, offsets
  // and what the user has changed. Returns null if there is no flight or it cannot be played (problem()).
  FlightPlayer* player(double exaggeration);
  // Returns why the flight cannot be played, or "".
  const std::string& problem() const { return problem_; }

 private:
  double radius_m_;
  scripts::TerrainHeight terrain_height_m_;
  std::optional<FlightEditor> editor_;
  std::uint64_t loads_ = 0;
  std::uint64_t player_revision_ = 0;  // FlightEditor::revision() that the player was made from
  double player_exaggeration_ = 1;
  std::optional<FlightPlayer> player_;
  std::string problem_;
};

}  // namespace vpe::explore
