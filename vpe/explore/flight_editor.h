// Editing the poses of a flight: placed, dragged, inserted, deleted, timed anew, with undo.
//
// The flight is always one that parse_flight(to_text()) gives back and that plays: times of poses ascend
// strictly and lie within the format's limits, there is at least one pose, every number is in its range, and no
// pose is opposite to the one before it or (given by its altitude) at the planet's centre. An edit that would
// break this changes nothing and says why. Distances are along great circles on the planet's sphere.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>

#include "mars/geodesy/sphere.h"
#include "scripts/flight.h"

namespace vpe::explore {

struct FlightEditorLimits {
  static constexpr std::size_t kUndoBytes = std::size_t{64}
                                            << 20;  // of flights kept for undo; the oldest go first
  static constexpr double kStandingLeg_s = 1;       // to a pose at the same place, where a speed gives no time
};

class FlightEditor {
 public:
  // Empty, or what is wrong with an edit and what to do.
  using Problem = std::string;

  // Throws std::invalid_argument with the problem: a flight that is not as above.
  FlightEditor(scripts::Flight flight, double radius_m);

  const scripts::Flight& flight() const { return flight_; }
  // Another number whenever the flight is another.
  std::uint64_t revision() const { return revision_; }
  std::string to_text() const { return scripts::to_text(flight_); }

  // The pose nearest to a place, over the ground; the first of equal ones.
  std::size_t nearest(mars::LonLat place) const;

  // At its own time, between the poses around it. An `end` before it moves to it.
  [[nodiscard]] Problem insert(const scripts::Waypoint& waypoint);

  // Between a pose and the next one, its time dividing theirs as its place divides the way; after the last pose
  // as append(). The time of `waypoint` is not read.
  [[nodiscard]] Problem insert_after(std::size_t index, const scripts::Waypoint& waypoint,
                                     double speed_m_per_s);

  // At the end, as long after the last pose as the way between them takes; an earlier `end` moves to it. The
  // time of `waypoint` is not read.
  [[nodiscard]] Problem append(const scripts::Waypoint& waypoint, double speed_m_per_s);

  // To another place; altitude or height, attitude and time stay. `goes_on`: one step of undo with the move of
  // the same pose just before it, as of one drag.
  [[nodiscard]] Problem move(std::size_t index, mars::LonLat place, bool goes_on = false);

  // Any field. The time must stay between those of its neighbours; the rest of the flight keeps its times.
  [[nodiscard]] Problem replace(std::size_t index, const scripts::Waypoint& waypoint);

  // All but the only pose.
  [[nodiscard]] Problem remove(std::size_t index);

  // Every time of the flight times a positive factor.
  [[nodiscard]] Problem scale_times(double factor);

  // Legs of at least 1 m get the time of this ground speed, shorter ones keep theirs; the first pose keeps its
  // time. Looks, settings, regions and the end move with the poses around them.
  [[nodiscard]] Problem keep_speed(double speed_m_per_s);

  // From the first to the last pose, metres.
  double length_m() const;

  [[nodiscard]] Problem set_view(const scripts::FlightView& view);

  // Nothing: the flight ends with its last command.
  [[nodiscard]] Problem set_end(std::optional<double> end_s);

  // Anything else, such as looks, settings and regions: the whole flight anew. `what` names the edit for undo.
  [[nodiscard]] Problem replace_all(scripts::Flight flight, const std::string& what);

  // What undo() and redo() would take back or bring again, as "move pose 3"; empty when there is nothing.
  std::string undo_text() const;
  std::string redo_text() const;
  bool undo();
  bool redo();

  // Whether the flight differs from what it was made with or last marked as saved.
  bool is_changed() const { return !(flight_ == saved_); }
  void mark_saved() { saved_ = flight_; }
  void mark_unsaved() { saved_ = {}; }

 private:
  struct Step {
    scripts::Flight flight;  // before the edit (undo) or after it (redo)
    std::string what;
  };
  Problem change(scripts::Flight next, std::string what, bool merges = false);
  Problem insert_at(std::size_t index, const scripts::Waypoint& waypoint, std::string what);
  Problem check_neighbours(const scripts::Flight& flight, std::size_t index) const;
  Problem retime(const std::function<double(double)>& time_s, std::string what);
  Problem no_pose(std::size_t index) const;
  double leg_m(const scripts::Waypoint& a, const scripts::Waypoint& b) const;
  void forget_old_steps();

  double radius_m_;
  scripts::Flight flight_;
  std::uint64_t revision_ = 1;
  scripts::Flight saved_;
  std::deque<Step> undo_;
  std::deque<Step> redo_;
  std::string drag_;  // name of the step that a move may go on with
};

}  // namespace vpe::explore
