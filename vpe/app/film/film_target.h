// Storage of a film's frames from run to run: the interface, and its implementation as a folder of images.
// film_video.h implements it as a video in segments.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "vpe/app/film/film_frame.h"
#include "vpe/app/film/film_plan.h"
#include "vpe/base/parallel.h"
#include "vpe/core/frame.h"

namespace vpe::app {

// Position of a run's frames among all frames of the film.
struct FilmSlice {
  std::int64_t first = 0;  // number of the run's first frame in the film
  std::int64_t all = 0;    // number of frames in the film
};

// Stores frames in groups of group_size() frames; the last group holds the rest. A group is stored as a whole
// or not at all, and everything appears under its name only when it is complete. Several processes may work on
// different groups of one film at the same time. Members throw std::runtime_error that names the file and says
// what to do.
//
// Typical usage:
//   target.keep(frames, slice, pool);            // marks what an earlier run left
//   target.prepare();                            // only if a frame is missing
//   for (FilmFrame& frame : group) target.add(number, frame, draw(frame));
//   target.end_group(number, group);             // or abandon()
//   target.finish(frames);                       // when the whole film is there
class FilmTarget {
 public:
  virtual ~FilmTarget() = default;

  virtual std::int64_t group_size() const = 0;

  // Marks the frames of every group that is stored whole and with equal fingerprints as kept, and sets their
  // figures and checksums. The frames must be whole groups of the film. Main thread.
  virtual void keep(std::span<FilmFrame> frames, const FilmSlice& slice, base::ThreadPool& pool) = 0;

  // Prepares the storage before the first group is made. Main thread.
  virtual void prepare() = 0;

  // add() takes the frames of a group in order; then end_group() stores the group, or abandon() drops it.
  // Stored frames are marked as made. One thread at a time.
  virtual void add(std::int64_t group, FilmFrame& frame, const core::Frame& image) = 0;
  virtual void end_group(std::int64_t group, std::span<FilmFrame> frames) = 0;
  virtual void abandon() = 0;

  // Completes the film when all its frames are stored. Main thread.
  virtual void finish(std::span<FilmFrame> frames) = 0;

  // Returns the target's own keys of the manifest.
  virtual nlohmann::json describe() const = 0;
};

// Text chunks of a frame's PNG file.
inline constexpr const char* kFingerprintKey = "vpe:fingerprint";
inline constexpr const char* kFiguresKey = "vpe:figures";  // FrameFigures as JSON

// Returns "frame_NNNNNN.png".
std::string frame_file_name(std::int64_t index);

// Checks that no file of another program has the name of one of these frames. Throws std::runtime_error with
// its name.
void check_frame_files(const std::filesystem::path& folder, const FrameRange& range);

// Stores a film as a folder of PNG files, each with its fingerprint and figures in text chunks. A group is one
// frame.
class FilmFolder : public FilmTarget {
 public:
  // With `remake`, stored frames are ignored and made again.
  FilmFolder(std::filesystem::path folder, bool remake);

  std::int64_t group_size() const override { return 1; }
  void keep(std::span<FilmFrame> frames, const FilmSlice& slice, base::ThreadPool& pool) override;
  void prepare() override;
  void add(std::int64_t group, FilmFrame& frame, const core::Frame& image) override;
  void end_group(std::int64_t, std::span<FilmFrame>) override {}
  void abandon() override {}
  void finish(std::span<FilmFrame>) override {}
  nlohmann::json describe() const override;

 private:
  void keep(FilmFrame& frame) const;

  std::filesystem::path folder_;
  bool remake_;
};

}  // namespace vpe::app
