// Named spots in the world that have a panorama.
//
// One spot a line, words split by blanks, `#` starts a comment; a word with blanks or # stands in double
// quotes, where a backslash keeps the next character as it is. Degrees; the height of the camera above the ground,
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

struct Hotspot {
  std::string name;  // of at least one character, of one line; no two are the same
  mars::LonLat place;
  double height_m = 0;
  std::filesystem::path panorama;  // an image or the JSON that names one (panorama::describe)
};

// Either spots (perhaps none) and no errors, or what is wrong (the first kMaxErrors). Whether panoramas are
// there is not looked at.
struct ParsedHotspots {
  static constexpr std::size_t kMaxErrors = 20;
  std::vector<Hotspot> hotspots;
  std::vector<LineError> errors;
};

// `file` names the file in errors and gives the folder that paths are relative to.
ParsedHotspots parse_hotspots(std::string_view text, const std::filesystem::path& file);

// Throws base::FileError when the file cannot be read.
ParsedHotspots load_hotspots(const std::filesystem::path& file);

// The spot's line, with its newline: parse_hotspots() reads the same back.
std::string to_line(const Hotspot& hotspot);

// Where their eyes are, body-fixed, metres from the planet's centre, over the ground as it is drawn; not a
// number where the terrain is not known.
std::vector<glm::dvec3> hotspot_eyes(std::span<const Hotspot> hotspots, double radius_m,
                                     const scripts::TerrainHeight& terrain_height_m, double exaggeration = 1.0);

struct NearHotspot {
  std::size_t index = 0;
  double distance_m = 0;
};

// Nothing when none is within the distance, both ends included. The first of equal ones.
std::optional<NearHotspot> nearest_hotspot(std::span<const glm::dvec3> eyes_m, const glm::dvec3& camera_m,
                                           double within_m);

enum class HotspotStage {
  kFar,
  kApproaching,  // read its panorama ahead
  kWithinReach,  // one key steps in
};

struct HotspotTrackerOptions {
  double approach_m = 3000;
  double reach_m = 150;
  double leave = 1.25;  // a stage is left at so many times the distance at which it begins; 1 or more
  double swap = 0.8;    // another spot takes over when it is nearer than this share of the distance; 0..1
};

// Follows the camera among spots. A stage that has begun does not flicker at its border, nor do two spots about
// equally far.
class HotspotTracker {
 public:
  explicit HotspotTracker(std::vector<glm::dvec3> eyes_m, const HotspotTrackerOptions& options = {});

  struct State {
    HotspotStage stage = HotspotStage::kFar;
    NearHotspot hotspot;  // meaningless when far

    bool operator==(const State& other) const {
      return stage == other.stage && (stage == HotspotStage::kFar || hotspot.index == other.hotspot.index);
    }
  };

  // What holds now that the camera is here; comparing with the state before shows whether something is to be done.
  State update(const glm::dvec3& camera_m);
  const State& state() const { return state_; }

 private:
  std::vector<glm::dvec3> eyes_m_;
  HotspotTrackerOptions options_;
  State state_;
};

}  // namespace vpe::explore
