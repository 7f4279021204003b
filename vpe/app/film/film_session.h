// One run over a film: keep what is there, make what is missing, write down what was made.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "vpe/app/film/film_maker.h"
#include "vpe/app/film/film_manifest.h"
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
  Shard part;
  bool remake = false;
};

class FilmSession {
 public:
  // For a video, throws when there is no ffmpeg and one is needed for sure.
  explicit FilmSession(FilmRequest request);

  // Finds what this run has to do and what of it is done. Throws Interrupted.
  void look(const FilmPlan& plan, int threads);

  // Makes the rest. Throws Interrupted and std::runtime_error, both saying how far the film is.
  void make(const FilmPlan& plan, FilmReports& reports, const RenderOptions& options,
            const FilmMaker::MakeRenderer& make_renderer, FrameOverlays& overlays, bool quiet);

  // The manifest; of a whole video also the film. Not to be called when make() threw.
  void finish(const FilmHead& head);

  const std::vector<FilmFrame>& frames() const { return frames_; }
  FilmKind kind() const { return {request_.is_video, target_->group_size()}; }
  // The video is made of the segments of several parts and is not joined yet.
  bool is_left_unjoined() const { return video_ != nullptr && !video_->is_complete(); }
  // Empty when none was written.
  const std::filesystem::path& manifest() const { return manifest_; }

 private:
  FilmRequest request_;
  std::unique_ptr<FilmTarget> target_;
  FilmVideo* video_ = nullptr;  // the target, if it is one
  std::int64_t first_ = 0;      // number of frames_[0] in the film
  std::vector<FilmFrame> frames_;
  std::filesystem::path manifest_;
};

}  // namespace vpe::app
