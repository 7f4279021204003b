// Where the frames of a film are kept from run to run: a folder of images (film_folder.h) or a video in
// segments (film_video.h).
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>

#include "vpe/app/film/film_frame.h"
#include "vpe/base/parallel.h"
#include "vpe/core/frame.h"

namespace vpe::app {

// Which of a film's frames are meant.
struct FilmPlace {
  std::int64_t first = 0;  // of them, counted in the film
  std::int64_t all = 0;    // frames of the film
};

// Frames are made in groups that are there as a whole or not at all: `group_size` frames each, the last one
// what remains. Several processes may work on different groups of one film at once. Everything appears under
// its name only when complete. Errors: std::runtime_error that names the file and says what to do.
class FilmTarget {
 public:
  virtual ~FilmTarget() = default;

  virtual std::int64_t group_size() const = 0;

  // Marks those frames as kept, with figures and checksum, whose group is there, whole, and of the same
  // fingerprints. The frames are whole groups of the film. Main thread.
  virtual void keep(std::span<FilmFrame> frames, const FilmPlace& place, base::ThreadPool& pool) = 0;

  // Called before the first group is made. Main thread.
  virtual void prepare() = 0;

  // The frames of a group in order, then its end, or abandon() instead; one thread at a time. Those that are
  // there then are marked as made.
  virtual void add(std::int64_t group, FilmFrame& frame, const core::Frame& image) = 0;
  virtual void end_group(std::int64_t group, std::span<FilmFrame> frames) = 0;
  virtual void abandon() = 0;

  // The whole film is there. Main thread.
  virtual void finish(std::span<FilmFrame> frames) = 0;

  // What a manifest says of the target itself.
  virtual nlohmann::json describe() const = 0;
};

}  // namespace vpe::app
