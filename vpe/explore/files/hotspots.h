// Named spots in the world that have a panorama.
//
// One spot a line, words split by blanks, `#` starts a comment; a word with blanks or # stands in double
// quotes, where a backslash keeps the next character as it is. Degrees; the height of the eye above the ground,
// metres; a path that is not absolute is relative to the file's folder.
//
//   spot "Glen Torridon" 137.39 -4.72 2 panoramas/torridon.json
#pragma once

#include <filesystem>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mars/geodesy/sphere.h"
#include "scripts/path.h"
#include "vpe/explore/files/text_lines.h"

namespace vpe::explore {

struct Spot {
  std::string name;  // of at least one character, of one line; no two are the same
  mars::LonLat place;
  double height_m = 0;
  std::filesystem::path panorama;  // a picture or the JSON that names one (panorama::describe)
};

// Either spots (perhaps none) and no errors, or what is wrong (the first kMaxErrors). Whether panoramas are
// there is not looked at.
struct ParsedSpots {
  static constexpr std::size_t kMaxErrors = 20;
  std::vector<Spot> spots;
  std::vector<LineError> errors;
};

// `file` names the file in errors and gives the folder that paths are relative to.
ParsedSpots parse_spots(std::string_view text, const std::filesystem::path& file);

// Throws base::FileError when the file cannot be read.
ParsedSpots load_spots(const std::filesystem::path& file);

// The spot's line, with its newline: parse_spots() reads the same back.
std::string to_line(const Spot& spot);

// Where their eyes are, body-fixed, metres from the planet's centre, over the ground as it is drawn; not a
// number where the terrain is not known.
std::vector<glm::dvec3> spot_eyes(std::span<const Spot> spots, double radius_m,
                                  const scripts::TerrainHeight& terrain_height_m, double exaggeration = 1.0);

struct NearSpot {
  std::size_t index = 0;
  double distance_m = 0;
};

// Nothing when none is within the distance, both ends included. The first of equal ones.
std::optional<NearSpot> nearest_spot(std::span<const glm::dvec3> eyes_m, const glm::dvec3& eye_m,
                                     double within_m);

enum class SpotStage {
  kFar,
  kApproaching,  // read its panorama ahead
  kWithinReach,  // one key steps in
};

struct SpotTrackerOptions {
  double approach_m = 3000;
  double reach_m = 150;
  double leave = 1.25;  // a stage is left at so many times the distance at which it begins; 1 or more
  double swap = 0.8;    // another spot takes over when it is nearer than this share of the distance; 0..1
};

// Follows the eye among spots. A stage that has begun does not flicker at its border, nor do two spots about
// equally far.
class SpotTracker {
 public:
  explicit SpotTracker(std::vector<glm::dvec3> eyes_m, const SpotTrackerOptions& options = {});

  struct State {
    SpotStage stage = SpotStage::kFar;
    NearSpot spot;  // meaningless when far

    bool operator==(const State& other) const {
      return stage == other.stage && (stage == SpotStage::kFar || spot.index == other.spot.index);
    }
  };

  // What holds now that the eye is here; comparing with the state before shows whether something is to be done.
  State update(const glm::dvec3& eye_m);
  const State& state() const { return state_; }

 private:
  std::vector<glm::dvec3> eyes_m_;
  SpotTrackerOptions options_;
  State state_;
};

}  // namespace vpe::explore
