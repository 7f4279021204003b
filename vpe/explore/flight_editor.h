// Editing of a flight's poses: place, drag, insert, delete and retime, with undo.
//
// The flight always satisfies these conditions: parse_flight(to_text()) returns it, and it can be played. Times
// of poses ascend strictly and lie within the format's limits, there is at least one pose, every number is in
// its range, and no pose is opposite to the one before it or (if given by its altitude) at the planet's centre.
// An edit that would violate this changes nothing and returns the reason. Distances are along great circles on
// the planet's sphere.
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
  static constexpr std::size_t kUndoBytes = std::size_t{64} << 20;  // of flights kept for undo; oldest go first
  static constexpr double kStandingLeg_s = 1;  // to a pose at the same place, where a speed gives no time
};

// Edits one flight. For one thread at a time.
//
// Typical usage:
//   FlightEditor editor(flight, radius_m);
//   if (FlightEditor::Problem problem = editor.move(2, place); !problem.empty()) show(problem);
//   if (!editor.undo_text().empty()) editor.undo();
class FlightEditor {
 public:
  // Empty, or what is wrong with an edit and what to do.
  using Problem = std::string;

  // Throws std::invalid_argument with the problem for a flight that violates the conditions above.
  FlightEditor(scripts::Flight flight, double radius_m);

  const scripts::Flight& flight() const { return flight_; }
  // Returns a number that changes whenever the flight changes.
  std::uint64_t revision() const { return revision_; }
  std::string to_text() const { return scripts::to_text(flight_); }

  // Returns the index of the pose nearest to a place, along the ground; the first of equal ones.
  std::size_t nearest(mars::LonLat place) const;

  // Inserts a pose at its own time. An earlier `end` moves to it.
  [[nodiscard]] Problem insert(const scripts::Waypoint& waypoint);

  // Inserts a pose between a pose and the next one. Its time divides theirs as its place divides the path.
  // After the last pose works as append(). Does not read the time of `waypoint`.
  [[nodiscard]] Problem insert_after(std::size_t index, const scripts::Waypoint& waypoint,
                                     double speed_m_per_s);

  // Adds a pose at the end. Its time follows from the distance and the speed; an earlier `end` moves to it.
  // Does not read the time of `waypoint`.
  [[nodiscard]] Problem append(const scripts::Waypoint& waypoint, double speed_m_per_s);

  // Moves a pose to another place; altitude or height, attitude and time stay. `continues` joins the move with
  // the previous move of the same pose to one undo step, as during one drag.
  [[nodiscard]] Problem move(std::size_t index, mars::LonLat place, bool continues = false);

  // Replaces all fields of a pose. The time must stay between those of its neighbours; other times do not
  // change.
  [[nodiscard]] Problem replace(std::size_t index, const scripts::Waypoint& waypoint);

  // Deletes a pose. The last remaining pose cannot be deleted.
  [[nodiscard]] Problem remove(std::size_t index);

  // Multiplies every time of the flight by a positive factor.
  [[nodiscard]] Problem scale_times(double factor);

  // Retimes legs of at least 1 m for this ground speed; shorter ones keep their time, and so does the first
  // pose. Looks, settings, regions, views and the end move with the poses around them.
  [[nodiscard]] Problem keep_speed(double speed_m_per_s);

  // Returns the length from the first to the last pose, metres.
  double length_m() const;

  [[nodiscard]] Problem set_view(const scripts::FlightView& view);

  // Sets the time at which the flight ends; nullopt: it ends with its last command.
  [[nodiscard]] Problem set_end(std::optional<double> end_s);

  // Replaces the whole flight, for edits of looks, settings, regions and views. `what` names the edit for undo.
  [[nodiscard]] Problem replace_all(scripts::Flight flight, const std::string& what);

  // Return the edit that undo() or redo() would revert or repeat, such as "move pose 3", or "" if there is
  // none.
  std::string undo_text() const;
  std::string redo_text() const;
  bool undo();
  bool redo();
  void forget_redo() { redo_.clear(); }
  // Return the numbers of steps that undo() and redo() can take, of all steps ever made, and of the oldest ones
  // that were dropped.
  std::size_t undo_steps() const { return undo_.size(); }
  std::size_t redo_steps() const { return redo_.size(); }
  std::uint64_t steps_made() const { return made_; }
  std::uint64_t steps_dropped() const { return dropped_; }

  // Returns true if the flight differs from the one given to the constructor or last marked as saved.
  bool is_changed() const { return !(flight_ == saved_); }
  void mark_saved() {
    saved_ = flight_;
    ++saves_;
  }
  void mark_unsaved() {
    saved_ = {};
    ++saves_;
  }
  // Returns a number that changes whenever mark_saved() or mark_unsaved() is called.
  std::uint64_t saves() const { return saves_; }

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
  std::uint64_t saves_ = 0;
  std::deque<Step> undo_;
  std::deque<Step> redo_;
  std::uint64_t made_ = 0;
  std::uint64_t dropped_ = 0;
  std::string drag_;  // name of the undo step that a move may continue
};

}  // namespace vpe::explore
