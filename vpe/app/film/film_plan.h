// What a flight's frames look like: poses, settings, sun, and from them fingerprints.
#pragma once

#include <vector>

#include "scripts/path.h"
#include "vpe/app/film/film_frame.h"
#include "vpe/app/film/frame_range.h"

namespace vpe::app {

// One frame, ready to be drawn.
struct PlannedFrame {
  double time_s = 0;
  scripts::FlightState state;
  core::Settings settings;
  core::DrawRequest request;
};

// Immutable; every member may be called from any number of threads at once.
class FilmPlan {
 public:
  // `base` are the settings before the flight's own, `interest` regions beside its own, from the start on.
  FilmPlan(FilmBasis basis, scripts::FlightView view, scripts::Path path, core::Settings base,
           std::vector<core::InterestRegion> interest = {});

  const scripts::Path& path() const { return path_; }
  const scripts::FlightView& view() const { return view_; }

  PlannedFrame at(std::int64_t frame) const;
  // Frames number begin to end - 1 of a range, none of them there yet.
  std::vector<FilmFrame> frames(const FrameRange& range, std::int64_t begin, std::int64_t end) const;

 private:
  FilmBasis basis_;
  scripts::FlightView view_;
  scripts::Path path_;
  core::Settings base_;
  std::vector<core::InterestRegion> interest_;
  mars::Pose start_;
};

}  // namespace vpe::app
