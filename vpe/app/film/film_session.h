// One run over a film: finds stored frames, makes the missing ones, and writes the manifest.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "vpe/app/film/film_maker.h"
#include "vpe/app/film/film_summary.h"
#include "vpe/app/film/film_target.h"
#include "vpe/app/film/film_video.h"

namespace vpe::app {

struct FilmRequest {
  std::filesystem::path output;
  bool is_video = false;
  VideoFormat format;
  std::string frames;  // --frames as given
  FrameRange range;    // of the flight
  Shard shard;
  bool remake = false;
};

// Runs a film through its steps. Main thread.
//
// Typical usage:
//   FilmSession session(request);
//   session.find_stored(plan, threads);
//   session.make(plan, reports, options, makers, overlays, quiet);
//   session.finish(head);
class FilmSession {
 public:
  // Throws std::runtime_error when the film is a video that surely needs ffmpeg and there is none.
  explicit FilmSession(FilmRequest request);

  // Plans the frames of this run and marks those that an earlier run stored. May be called again with another
  // plan. Throws Interrupted.
  void find_stored(const FilmPlan& plan, int threads);

  // Makes the missing frames. Throws Interrupted and std::runtime_error, both with the film's progress.
  void make(const FilmPlan& plan, FilmReports& reports, const RenderOptions& options,
            const FilmMaker::Makers& makers, FrameOverlays& overlays, bool quiet);

  // Writes the manifest, and joins a video whose frames are all stored. Must not be called after make() threw.
  void finish(const ManifestHead& head);

  const std::vector<FilmFrame>& frames() const { return frames_; }
  // Returns the number of groups that parts divide among them: frames, or segments of a video.
  std::int64_t groups() const;
  // Returns text about missing frames for a run over the whole film whose parts were made by other runs, else "".
  std::string missing_from_parts() const;
  FilmKind kind() const { return {request_.is_video, target_->group_size()}; }
  // Returns true if the video consists of the segments of several parts and is not joined yet.
  bool is_left_unjoined() const { return video_ != nullptr && !video_->is_complete(); }
  // Returns the manifest's path; empty when none was written.
  const std::filesystem::path& manifest() const { return manifest_; }

 private:
  FilmRequest request_;
  std::unique_ptr<FilmTarget> target_;
  FilmVideo* video_ = nullptr;  // target_ if it is a video
  std::int64_t first_ = 0;      // number of frames_[0] in the film
  std::vector<FilmFrame> frames_;
  std::filesystem::path manifest_;
};

}  // namespace vpe::app
