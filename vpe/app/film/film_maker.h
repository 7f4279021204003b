// Makes the frames of a film that are not there yet.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scripts/log.h"
#include "scripts/stats.h"
#include "vpe/app/cli/progress.h"
#include "vpe/app/film/film_plan.h"
#include "vpe/app/film/film_target.h"
#include "vpe/app/picture/frame_overlays.h"
#include "vpe/app/picture/image_options.h"

namespace vpe::app {

struct FilmReports {
  std::optional<scripts::StatsWriter> stats;  // a row for every frame that is kept or drawn
  std::optional<scripts::FlightLog> log;      // a pose for every frame
  std::vector<std::string> failures;          // of tiles that cannot be read, each once
};

class FilmMaker {
 public:
  using MakeRenderer = std::function<std::unique_ptr<core::Renderer>()>;

  // The renderer is made when the first frame has to be drawn. `first` is the number of frames[0] in the film.
  FilmMaker(const FilmPlan& plan, FilmTarget& target, std::span<FilmFrame> frames, std::int64_t first,
            const RenderOptions& options, MakeRenderer make_renderer, FrameOverlays& overlays);

  // Draws what is missing, in order. A frame that the renderer cannot draw or not completely (unless
  // the options allow it) is marked as failed, and its group
  // is given up; the rest is made. Throws Interrupted, and std::runtime_error when frames cannot be written or
  // nothing can be drawn: then frames that are there are marked so. Once only; main thread.
  void run(FilmReports& reports, ProgressLine& line);

 private:
  void make_group(std::size_t begin, std::size_t end);
  bool draw(std::size_t n);
  void report_kept(const FilmFrame& frame);
  void log(const FilmFrame& frame, const PlannedFrame& planned);
  void show(std::size_t done);

  const FilmPlan& plan_;
  FilmTarget& target_;
  std::span<FilmFrame> frames_;
  std::int64_t first_;
  const RenderOptions& options_;
  MakeRenderer make_renderer_;
  FrameOverlays& overlays_;
  std::unique_ptr<core::Renderer> renderer_;
  FilmReports* reports_ = nullptr;
  ProgressLine* line_ = nullptr;
  class FrameSink* sink_ = nullptr;
};

}  // namespace vpe::app
