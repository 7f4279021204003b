// Changes of the ground by a flight: reliefs and patches at any time.
//
//   - A relief is there from its line with `kind` on. Each of its numbers runs on a monotone curve (monotone_spline.h)
//     through the lines that give it, angles the short way, and is held after the last of them. Words, `octaves` and
//     `seed` hold from their time on.
//   - The distance of a relief's posts is the same over its whole life, so that no level of detail changes where a size
//     does: the finest that its lines ask for, but at least a quarter of the coarsest.
//   - A patch is mixed in from its first line on, by a monotone curve through its `mix`.
//   - At the time of a line the state is what the line says, to the bit.
//
// Typical usage:
//   const GroundTracks ground(flight, radius_m);
//   if (const GroundState state = ground.at(12.5); !state.empty()) draw(changed(planet, state));
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "relief/spec.h"
#include "scripts/flight.h"
#include "scripts/monotone_spline.h"

namespace scripts {

// Holds a patch at a time.
struct PatchState {
  std::string file;
  double mix = 0;  // above 0, at most 1

  bool operator==(const PatchState&) const = default;
};

// Holds what a flight has made of the ground at a time. Patches come before reliefs, each in their order here.
struct GroundState {
  std::vector<PatchState> patches;
  std::vector<relief::ReliefSpec> reliefs;  // with names and the distance of posts

  bool empty() const { return patches.empty() && reliefs.empty(); }
  bool operator==(const GroundState&) const = default;
};

// Returns a line for each patch and relief, such as "patch b.vpe mix=0.5" and "relief pit kind=crater lon=1 ...". Equal
// lines mean equal states.
std::vector<std::string> lines_of(const GroundState& state);

// Tells the ground of a flight. Immutable; any number of threads may call its const members at once. All results are pure
// functions of the flight and the time.
class GroundTracks {
 public:
  GroundTracks() = default;
  // Takes the lines of a flight as parse_flight() returns them. Throws std::runtime_error, naming relief and time, for a
  // relief that reaches further than relief::kMostReach_rad on a sphere of radius_m, and for lines that parse_flight()
  // refuses.
  GroundTracks(const Flight& flight, double radius_m);

  // Returns true if the ground never changes.
  bool empty() const { return reliefs_.empty() && patches_.empty(); }

  // Returns true if the lines are the same, so that all states are.
  bool operator==(const GroundTracks& other) const { return text_ == other.text_; }

  // Returns the ground at a time. Leaves out reliefs that are hidden or of no strength, and patches of mix 0.
  GroundState at(double time_s) const;

  // Returns the times of all lines, ascending, each once.
  const std::vector<double>& times_s() const { return times_s_; }

  // Returns the files of all patches, in the order of their first lines.
  std::vector<std::string> files() const;
  // Returns what changes the ground, such as "patch b.vpe" and "relief pit": patches, then reliefs, in that order.
  std::vector<std::string> names() const;

 private:
  // Holds one number of a relief at the lines that give it.
  struct Curve {
    std::size_t key = 0;  // of relief_keys()
    std::vector<double> times_s;
    std::vector<double> values;  // as given
    MonotoneSpline spline;       // angles without jumps
    bool is_angle = false;
  };
  // Holds a relief from a line with `kind` to the next one.
  struct Life {
    std::vector<double> times_s;             // of its lines
    std::vector<relief::ReliefSpec> states;  // after each of them
    std::vector<Curve> curves;               // of numbers that change
    double spacing_m = 0;

    relief::ReliefSpec at(double time_s) const;
  };
  struct Showing {
    double time_s = 0;
    bool is_shown = true;
  };
  struct Track {
    std::string name;
    std::vector<Life> lives;  // times ascend
    std::vector<Showing> showings;
  };
  struct Patch {
    std::string file;
    double begin_s = 0;
    MonotoneSpline mix;
  };
  static double value_at(const Curve& curve, double time_s);
  static void add_line(const ReliefCommand& line, Track& track);
  static void add_curves(const std::vector<const ReliefCommand*>& lines, double end_s, Life& life);
  static void set_spacing(const std::string& name, double radius_m, Life& life);

  std::vector<Track> reliefs_;
  std::vector<Patch> patches_;
  std::vector<double> times_s_;
  std::string text_;  // lines, radius and end
};

}  // namespace scripts
