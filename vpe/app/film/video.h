// Frames to video files through ffmpeg: short segments, joined without encoding them again.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "scripts/frame_rate.h"
#include "vpe/app/cli/subprocess.h"
#include "vpe/core/frame.h"

namespace vpe::app {

struct VideoFormat {
  int width = 0;  // both even
  int height = 0;
  scripts::FrameRate rate;
};

// Throws std::runtime_error that names the film when the size is odd.
void check_video_format(const std::filesystem::path& film, const VideoFormat& format);

// How ffmpeg is told to encode: equal text, equal image from equal frames by one version of ffmpeg. The
// number of its threads is fixed, because x264's output depends on it.
std::string encoder_settings(const VideoFormat& format);

// First line of `ffmpeg -version`. Throws std::runtime_error, naming the film, when there is no ffmpeg that
// runs.
std::string encoder_version(const std::filesystem::path& film);

// A video of its own that begins with a key frame and refers to nothing outside. Frames are piped into ffmpeg,
// which writes a temporary file; close() gives it its name. Throws std::runtime_error with ffmpeg's own words.
// One that is not closed leaves nothing.
class VideoWriter {
 public:
  VideoWriter(std::filesystem::path path, const VideoFormat& format);
  ~VideoWriter();
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;

  void add(const core::Frame& frame);
  void close();

 private:
  [[noreturn]] void fail(const std::string& what);

  std::filesystem::path path_;
  std::filesystem::path temporary_;
  Subprocess ffmpeg_;
};

struct VideoSegment {
  std::string name;  // in the folder of the segments; letters, digits, '_' and '.'
  std::int64_t frames = 0;
};

// Joins segments of one format into a film at a constant rate, under its name only when complete. Throws
// std::runtime_error with ffmpeg's own words.
void join_video(const std::filesystem::path& folder, std::span<const VideoSegment> segments,
                const VideoFormat& format, const std::filesystem::path& film);

}  // namespace vpe::app
