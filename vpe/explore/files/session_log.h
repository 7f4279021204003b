// A recording of a session as a flight, which `vpe fly` can render at any size.
//
// scripts::FlightLog writes poses, looks, settings, regions and views (zoom, window size, backend, eyes). This class
// adds: pauses, since a window draws only when something changes and the camera must stand still meanwhile; removal
// of regions; jumps; and entering and leaving panoramas. The latter are comments, which playback skips: the log stays
// a flight, in which the camera stands at the hotspot and the head looks around. Its version is 1.1.
//
//   # at 12.5 overlook in "Glen Torridon" "/home/u/panoramas/torridon.json"
//   # at 40 overlook out
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scripts/log.h"

namespace vpe::explore {

struct SessionLogOptions {
  double gap_s = 0.2;    // frames farther apart than this are a pause
  double lead_s = 0.04;  // motion begins this long before the frame that ends a pause; less than gap_s
};

// Writes a log. The file is a valid flight at any moment after the first frame. Poses, looks, settings and views
// replay bit by bit at the times of frames (scripts/path.h). Throws as scripts::LineFile. For one thread at a
// time.
//
// Typical usage:
//   SessionLog log("session.flight", view, radius_m);
//   log.frame({time_s, session.pose(), session.look(), view}, session.settings());   // for each image
//   log.end(time_s);
class SessionLog {
 public:
  SessionLog(const std::filesystem::path& path, const scripts::FlightView& view, double radius_m,
             const SessionLogOptions& options = {});

  struct Frame {
    double time_s = 0;
    mars::Pose pose;
    mars::HeadAngles look;         // of the head on its platform, as the image was drawn
    scripts::ViewState view = {};  // likewise; members without a value are as before
  };

  // Records an image that was drawn. `regions` are those in effect. A time that is not after the previous one
  // counts as just after it. Returns the time written, or nullopt if the frame exceeds the flight format
  // (numbers that are not finite, times after FlightLimits::kMaxTime_s, a pitch beyond 90 degrees, a field of view of 0) and is left
  // out.
  std::optional<double> frame(const Frame& frame, const core::Settings& settings,
                              std::span<const core::InterestRegion> regions = {});

  // Record entering and leaving a panorama.
  void enter_overlook(double time_s, const std::string& hotspot, const std::filesystem::path& panorama);
  void leave_overlook(double time_s);

  // Writes a comment. Playback skips it.
  void note(double time_s, std::string_view text);

  // Ends the flight at a time, at least that of the last frame, and closes the file.
  void end(double time_s);

 private:
  void update_regions(std::span<const core::InterestRegion> regions);
  void write(const Frame& frame, const core::Settings& settings);

  scripts::FlightLog log_;
  double radius_m_;
  SessionLogOptions options_;
  std::optional<Frame> last_;
  core::Settings settings_;                    // of the last frame
  std::vector<core::InterestRegion> active_;   // regions in effect
  std::vector<core::InterestRegion> written_;  // all regions written, including those that cancel others
};

// Describes that a panorama was entered or left.
struct OverlookStep {
  double time_s = 0;
  bool in = false;
  std::string hotspot;             // only when entering
  std::filesystem::path panorama;  // only when entering
};

// Returns the steps that a log contains, in its order. Accepts any text; other comments are skipped.
std::vector<OverlookStep> overlook_steps(std::string_view log);

}  // namespace vpe::explore
