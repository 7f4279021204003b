// Panorama hotspots: named places with a panorama that can be opened there.
//
// The file has one hotspot a line. Words are separated by blanks; `#` starts a comment. A word with blanks or #
// is in double quotes, where a backslash keeps the next character as it is. Angles are in degrees, the height
// of the camera above the ground in metres. A relative path is relative to the file's folder.
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
  std::string name;  // one line, not empty, unique
  mars::LonLat place;
  double height_m = 0;             // of the camera above the ground
  std::filesystem::path panorama;  // an image, or the JSON file that names one (panorama::describe)
};

// Holds either hotspots (possibly none), or errors (the first kMaxErrors). Parsing does not check that the
// panoramas exist.
struct ParsedHotspots {
  static constexpr std::size_t kMaxErrors = 20;
  std::vector<Hotspot> hotspots;
  std::vector<LineError> errors;
};

// Parses any text. `file` is the file's name in errors; relative paths are relative to its folder.
ParsedHotspots parse_hotspots(std::string_view text, const std::filesystem::path& file);

// Reads a file. Throws base::FileError if it cannot be read.
ParsedHotspots load_hotspots(const std::filesystem::path& file);

// Returns the hotspot's line, with its newline. parse_hotspots() reads the same back.
std::string to_line(const Hotspot& hotspot);

// Computes the hotspots' camera positions: body-fixed, metres from the planet's centre, above the ground as
// drawn. Positions are NaN where the terrain is not known.
std::vector<glm::dvec3> hotspot_positions(std::span<const Hotspot> hotspots, double radius_m,
                                          const scripts::TerrainHeight& terrain_height_m,
                                          double exaggeration = 1.0);

struct NearHotspot {
  std::size_t index = 0;
  double distance_m = 0;
};

// Returns the nearest hotspot up to and including a distance, the first of equal ones, or nullopt.
std::optional<NearHotspot> nearest_hotspot(std::span<const glm::dvec3> positions_m, const glm::dvec3& camera_m,
                                           double within_m);

enum class HotspotStage {
  kFar,
  kApproaching,  // its panorama is opened ahead
  kWithinReach,  // the user can enter it
};

struct HotspotTrackerOptions {
  double approach_m = 3000;    // Smaller: panoramas open later; larger: more of them are opened in vain.
  double reach_m = 150;        // distance from which a hotspot can be entered
  double leave_factor = 1.25;  // a stage ends at this times the distance at which it begins; 1 or more
  double switch_share =
      0.8;  // another hotspot replaces this one if nearer than this share of its distance; 0..1
};

// Tracks the camera among hotspots. Stages have hysteresis, so that neither a stage at its limit nor two
// hotspots at about the same distance alternate.
//
// Typical usage:
//   HotspotTracker tracker(positions_m);
//   const HotspotTracker::State before = tracker.state();
//   if (!(tracker.update(camera_m) == before)) announce(tracker.state());
class HotspotTracker {
 public:
  explicit HotspotTracker(std::vector<glm::dvec3> positions_m, const HotspotTrackerOptions& options = {});

  struct State {
    HotspotStage stage = HotspotStage::kFar;
    NearHotspot hotspot;  // undefined for kFar

    bool operator==(const State& other) const {
      return stage == other.stage && (stage == HotspotStage::kFar || hotspot.index == other.hotspot.index);
    }
  };

  // Updates and returns the state for a camera position.
  State update(const glm::dvec3& camera_m);
  const State& state() const { return state_; }

 private:
  std::vector<glm::dvec3> positions_m_;
  HotspotTrackerOptions options_;
  State state_;
};

}  // namespace vpe::explore
