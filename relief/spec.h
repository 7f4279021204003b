// One relief as a person describes it: its kind, place and sizes.
//
// All keys are declared once (relief_keys()), with units, limits and meaning; files (relief/files/relief_file.h) and lines
// of flights (relief/spec_line.h) are read by them. A key without a value follows from the others (docs/guide/relief.md).
//
// Typical usage:
//   ReliefSpec spec;
//   spec.place = {137.4, -4.6};
//   spec.radius_m = 200;
//   if (const std::string problem = problem_of(spec); !problem.empty()) complain(problem);
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mars/geodesy/sphere.h"
#include "relief/composition.h"
#include "vpe/core/registry/key_registry.h"

namespace relief {

inline constexpr std::size_t kMostPolygonCorners = 2000;
inline constexpr std::size_t kMostNameBytes = 200;
// Bounds lengths and heights of reliefs.
inline constexpr double kLeastLength_m = 0.01;
inline constexpr double kMostLength_m = 1e7;
inline constexpr double kMostHeight_m = 1e6;

enum class ReliefKind : std::uint8_t { kCrater, kRamp, kPad, kTrench, kDune, kDam, kFlood, kNoise };
enum class DuneForm : std::uint8_t { kBarchan, kTransverse };

// Numbers that are not given are nullopt. place() says what they are then.
struct ReliefSpec {
  std::string name;  // "": none
  ReliefKind kind = ReliefKind::kCrater;
  mars::LonLat place;        // the origin of the shape's plane
  double azimuth_deg = 0;    // of the plane's x axis, clockwise from north
  std::optional<Mode> mode;  // nullopt: usual_mode()
  double strength = 1;       // factor of the weight, 0 to 1
  std::optional<double>
      level_m;        // of the shape's zero above the datum; nullopt: that of the ground at the place
  double rise_m = 0;  // added to it
  std::optional<double> spacing_m;  // wanted distance of posts
  std::optional<double> radius_m;
  std::optional<double> length_m;  // along x
  std::optional<double> width_m;   // along y
  std::optional<double> height_m;
  std::optional<double> depth_m;
  std::optional<double> falloff_m;
  std::optional<double> slope_deg;
  std::optional<double> rim_m;
  std::optional<double> floor_ratio;
  std::optional<double> peak_m;
  double ejecta_ratio = 5;
  double start_m = 0;
  double end_m = 0;
  DuneForm form = DuneForm::kBarchan;
  std::optional<double> stoss_m;
  std::optional<double> horn_m;
  std::optional<double> foundation_m;
  std::optional<double> amplitude_m;
  std::optional<double> wavelength_m;
  int octaves = 4;
  double gain = 0.5;
  int seed = 1;
  std::vector<mars::LonLat> polygon;  // corners; its edges are straight in the shape's plane
};

// Returns true if all keys have the same values, numbers to the bit.
bool operator==(const ReliefSpec& a, const ReliefSpec& b);

// Returns the registry of all keys.
const vpe::core::KeyRegistry<ReliefSpec>& relief_keys();

// Returns the word of a kind, such as "crater".
std::string_view kind_word(ReliefKind kind);

// Returns true if the kind has the key `key` of relief_keys(), and if the key must be given.
bool has_key(ReliefKind kind, std::size_t key);
bool needs_key(ReliefKind kind, std::size_t key);

// Returns the names of the keys of a kind, separated by commas.
std::string keys_of(ReliefKind kind);

// Returns how a kind changes the ground unless the mode is given: craters, trenches, dunes and noise are added, ramps and
// pads replace it, dams and floods are the maximum.
Mode usual_mode(ReliefKind kind);

// Sets a key from its text. Returns what is wrong, and changes nothing then; else "".
std::string set_key(ReliefSpec& spec, std::size_t key, std::string_view text);

// Returns what is wrong with a relief, or "": values that are not allowed, keys that its kind needs or does not have,
// two ways to give the area.
std::string problem_of(const ReliefSpec& spec);

}  // namespace relief
