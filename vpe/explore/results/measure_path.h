// The path that is measured, edited with undo: its places, and the heights of the ends of the line of sight.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mars/geodesy/sphere.h"
#include "vpe/explore/drawing/edited_state.h"

namespace vpe::explore {

// Holds the state of a path.
struct PathState {
  std::vector<mars::LonLat> places;  // longitude in (-180, 180]
  double from_height_m = 2;          // of the first place, above the ground
  double to_height_m = 0;            // of the last one
};

// Edits a path, each edit a step of undo. For one thread at a time.
//
// Typical usage:
//   MeasurePath path;
//   path.add(place);
//   path.undo();
class MeasurePath : public EditedState<PathState> {
 public:
  static constexpr std::size_t kUndoBytes = std::size_t{4} << 20;

  MeasurePath() : EditedState(kUndoBytes) {}

  std::span<const mars::LonLat> places() const { return state().places; }
  double from_height_m() const { return state().from_height_m; }
  double to_height_m() const { return state().to_height_m; }

  // Appends a place. An invalid one changes nothing, here and below.
  void add(mars::LonLat place);
  // Removes a place; does nothing where there is none of this number.
  void erase(std::size_t index);
  // Removes all places; does nothing without any.
  void clear();
  // Begins a path anew with one place.
  void begin_at(mars::LonLat place);
  // Goes on to a place: from the last one of the path, or else from `begin`.
  void go_on_to(mars::LonLat place, mars::LonLat begin);
  // Sets the heights of the ends above the ground, metres.
  void set_heights(double from_height_m, double to_height_m);

 private:
  void edit_path(PathState next, const std::string& what);
};

// Returns the letters of a point of a path, from 0: "A", ..., "Z", "AA".
std::string path_point_name(std::size_t index);

}  // namespace vpe::explore
