// Frames to a video file through ffmpeg.
#pragma once

#include <filesystem>
#include <string>

#include "scripts/frame_rate.h"
#include "vpe/core/frame.h"

namespace vpe::app {

// Pipes raw frames into `ffmpeg`, which writes OUT.part; close() renames it to OUT. Sizes must be even. Throws
// std::runtime_error with ffmpeg's own words. A writer that is not closed removes its .part file.
class VideoWriter {
 public:
  VideoWriter(std::filesystem::path path, int width, int height, const scripts::FrameRate& rate);
  ~VideoWriter();
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;

  void add(const core::Frame& frame);
  void close();

 private:
  int wait();
  [[noreturn]] void fail(const std::string& what);

  std::filesystem::path path_;
  std::filesystem::path part_;
  std::filesystem::path log_;
  int pipe_ = -1;
  int pid_ = -1;
};

}  // namespace vpe::app
