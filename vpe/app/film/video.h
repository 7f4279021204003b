// Video files by ffmpeg: short segments, joined without encoding them again.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "scripts/frame_rate.h"
#include "vpe/app/cli/subprocess.h"
#include "vpe/base/file.h"
#include "vpe/core/frame.h"

namespace vpe::app {

struct VideoFormat {
  int width = 0;  // pixels, both even
  int height = 0;
  scripts::FrameRate rate;
  std::string comment{};  // in the film's metadata; "": none
};

// Throws std::runtime_error that names the film when width or height is odd.
void check_video_format(const std::filesystem::path& film, const VideoFormat& format);

// Returns ffmpeg's options. With one version of ffmpeg, equal options give equal video for equal frames: the
// number of encoder threads is fixed, because x264's output depends on it.
std::string encoder_settings(const VideoFormat& format);

// Returns the first line of `ffmpeg -version`. Throws std::runtime_error that names the film when no ffmpeg
// runs.
std::string encoder_version(const std::filesystem::path& film);

// Writes one video, which begins with a key frame and refers to nothing outside. Frames are piped into ffmpeg,
// which writes a temporary file; close() gives it its name. A writer that is not closed leaves no file. Throws
// std::runtime_error with ffmpeg's message, and base::FileError.
//
// Typical usage:
//   VideoWriter writer("segment_000000.mp4", format);
//   for (const core::Frame& frame : frames) writer.add(frame);
//   writer.close();
class VideoWriter {
 public:
  VideoWriter(const std::filesystem::path& path, const VideoFormat& format);
  ~VideoWriter();
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;

  void add(const core::Frame& frame);
  void close();

 private:
  [[noreturn]] void fail(const std::string& what);

  base::OutputFile file_;
  Subprocess ffmpeg_;
  std::vector<std::uint8_t> planes_;  // of the last frame
};

struct VideoSegment {
  std::string name;  // in the folder of the segments; letters, digits, '_' and '.'
  std::int64_t frames = 0;
};

// Joins segments of one format into a film with a constant frame rate. The film appears under its name only
// when it is complete. Throws std::runtime_error with ffmpeg's message, and base::FileError.
void join_video(const std::filesystem::path& folder, std::span<const VideoSegment> segments,
                const VideoFormat& format, const std::filesystem::path& film);

}  // namespace vpe::app
