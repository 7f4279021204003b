// Writes what happens as a flight: a log that replays.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "mars/geodesy/pose.h"
#include "scripts/flight.h"
#include "vpe/core/appearance/settings.h"

namespace scripts {

// A text file that is written line by line. Each line reaches the operating system at once, so that what was
// written survives a crash. Throws std::runtime_error that names the file, the operation and the system's
// words.
class LineFile {
 public:
  explicit LineFile(std::filesystem::path path);
  void write(std::string_view lines);  // with their newlines
  void close();                        // the destructor closes too, but cannot report

 private:
  [[noreturn]] void fail(const char* operation) const;

  std::filesystem::path path_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};

// A flight with one pose a frame (`--log F.flight`). At any moment the file is a valid flight, also without
// end(), once the first frame is written. Played back at the same times it gives the same poses to the bit
// (scripts/path.h). Errors as LineFile.
class FlightLog {
 public:
  FlightLog(const std::filesystem::path& path, const FlightView& view);

  // Times ascend. Writes the pose; the head and the settings only where they changed since the last frame.
  // `interest` are all regions so far: those beyond the last frame's are written. (A flight cannot take a
  // region back.)
  void frame(double time_s, const mars::Pose& pose, const mars::HeadAngles& look,
             const vpe::core::Settings& settings, std::span<const vpe::core::InterestRegion> interest = {});

  // A comment line, for people and for programs that know how to read it; playback passes over it. Line ends
  // become blanks.
  void note(std::string_view text);

  // Writes the end, at or after the last frame, and closes the file.
  void end(double time_s);

 private:
  LineFile file_;
  std::optional<double> last_frame_s_;
  Look look_{.time_s = -1};       // last one written, or straight ahead
  vpe::core::Settings settings_;  // last ones written
  std::size_t regions_ = 0;       // written so far
};

}  // namespace scripts
