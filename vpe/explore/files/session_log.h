// Everything that happens in a session, as a flight that `vpe fly` renders at any size.
//
// scripts::FlightLog writes poses, looks, settings and regions. Added here: a window that draws only when
// something changes leaves gaps, in which the camera must stand still and not creep to where it was next; regions
// that are taken away; jumps; steps into an overlook and out of it. These last are comments (playback passes
// over them: the log stays a flight of version 1, in which the camera stands at the spot and the head looks
// around):
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
  double lead_s = 0.04;  // so long before the frame that ends a pause motion begins; below gap_s
};

// At any moment the file is a valid flight, once the first frame is written. Poses, looks and settings replay
// to the bit at the times of frames (scripts/path.h). Errors as scripts::LineFile.
class SessionLog {
 public:
  SessionLog(const std::filesystem::path& path, const scripts::FlightView& view, double radius_m,
             const SessionLogOptions& options = {});

  struct Frame {
    double time_s = 0;
    mars::Pose pose;
    mars::HeadAngles look;  // with the head on its platform, as the image was drawn
  };

  // Each image that was drawn. `regions` are those that hold now. A time that is not after the one before
  // counts as just after it. Returns the time written. Frames beyond the flight format (numbers that are not
  // finite, times after FlightLimits::kMaxTime_s, a tilt of more than 90 degrees) are left out: nothing.
  std::optional<double> frame(const Frame& frame, const core::Settings& settings,
                              std::span<const core::InterestRegion> regions = {});

  void enter(double time_s, const std::string& hotspot, const std::filesystem::path& panorama);
  void step_out(double time_s);

  // Whatever else is worth knowing, as a comment: a resized window, another backend.
  void note(double time_s, std::string_view text);

  // At or after the last frame; closes the file.
  void end(double time_s);

 private:
  void tell_regions(std::span<const core::InterestRegion> regions);
  void write(const Frame& frame, const core::Settings& settings);

  scripts::FlightLog log_;
  double radius_m_;
  SessionLogOptions options_;
  std::optional<Frame> last_;
  core::Settings settings_;                   // of the last frame
  std::vector<core::InterestRegion> active_;  // regions that hold, as told
  std::vector<core::InterestRegion> told_;    // all that were told, those that take back included
};

// The steps that a log tells of, in its order. Any text is allowed; comments that are not steps are passed
// over.
struct OverlookStep {
  double time_s = 0;
  bool in = false;
  std::string hotspot;             // of a step in
  std::filesystem::path panorama;  // likewise
};
std::vector<OverlookStep> overlook_steps(std::string_view log);

}  // namespace vpe::explore
