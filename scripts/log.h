// Logs of flights that are flights themselves, so that they can be replayed.
#pragma once

#include <cstdio>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mars/geodesy/pose.h"
#include "scripts/flight.h"
#include "vpe/base/file.h"
#include "vpe/core/appearance/settings.h"

namespace scripts {

// Writes a text file line by line. Members throw std::runtime_error; the message names the file, the operation
// and the system's message.
class LineFile {
 public:
  enum class Mode {
    kLive,   // under its name from the start; each line reaches the operating system at once, and so survives a
             // crash of the program. The former file is lost.
    kWhole,  // under its name when it is closed; until then, and without close(), the former file stays
  };

  LineFile(std::filesystem::path path, Mode mode);
  // Writes lines that end with newlines.
  void write(std::string_view lines);
  // Closes the file. The destructor closes a live file too, but cannot report errors, and removes a whole one.
  void close();

 private:
  [[noreturn]] void fail(const char* operation) const;

  std::filesystem::path path_;
  std::unique_ptr<vpe::base::OutputFile> whole_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> live_;
};

// Writes a flight with one pose for each frame (`--log F.flight`), and with its view where that has changed. The second line is the comment "# log of
// vpe", by which logs are told from flights. Once the first frame is written, a live file is a valid flight at
// any moment, also without end(). Replayed at the same times it gives the same poses to
// the bit (scripts/path.h). Members throw what LineFile throws.
//
// Typical usage:
//   FlightLog log("flight.flight", flight.view, LineFile::Mode::kLive, FlightVersion::k1_1);
//   for (const Frame& f : frames) log.frame(f.time_s, f.state.pose, f.state.head, f.settings, {}, f.state.view);
//   log.end(duration_s);
class FlightLog {
 public:
  FlightLog(const std::filesystem::path& path, const FlightView& view,
            LineFile::Mode mode = LineFile::Mode::kLive, FlightVersion version = FlightVersion::k1);

  // Writes the pose, and head, settings and view where they have changed since the last frame. Times must ascend.
  // `interest` are all regions so far; those that the last frame did not have are written. (A flight cannot
  // remove a region.) Members of `view` without a value are as in the last frame; those of the first view hold
  // from 0 s on. Throws std::logic_error for a view in a log of version 1.
  void frame(double time_s, const mars::Pose& pose, const mars::HeadAngles& head,
             const vpe::core::Settings& settings, std::span<const vpe::core::InterestRegion> interest = {},
             const ViewState& view = {});

  // Takes the lines of objects of the flight that is logged, in ascending order of time: each is written before the first
  // frame at or after its time, and the rest at the end. Throws std::logic_error for lines in a log of a version before
  // 1.2.
  void objects(std::span<const ObjectCommand> commands);

  // Takes the lines that change the ground, likewise. Throws std::logic_error for lines in a log of a version before 1.3.
  void ground(std::span<const ReliefCommand> reliefs, std::span<const PatchCommand> patches);

  // Writes a comment line, for people and for programs that can read it. Replay ignores it. Line ends become
  // blanks.
  void note(std::string_view text);

  // Writes the end, at or after the last frame, and closes the file.
  void end(double time_s);

 private:
  std::string view_lines(double time_s, const ViewState& view);
  std::string waiting_lines(double time_s);

  LineFile file_;
  FlightVersion version_;
  std::optional<double> last_frame_s_;
  HeadCommand head_{.time_s = -1};              // last one written, or straight ahead
  vpe::core::Settings settings_;                // last ones written
  ViewCommand view_{.time_s = -1, .view = {}};  // all that was written so far, and when last
  std::size_t regions_ = 0;                     // written so far
  std::deque<ObjectCommand> objects_;           // not written yet
  std::deque<ReliefCommand> reliefs_;
  std::deque<PatchCommand> patches_;
};

}  // namespace scripts
