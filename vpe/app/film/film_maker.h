// Makes the missing frames of a film.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "scripts/log.h"
#include "scripts/stats.h"
#include "vpe/app/cli/progress.h"
#include "vpe/app/film/film_palette.h"
#include "vpe/app/film/film_plan.h"
#include "vpe/app/film/film_target.h"
#include "vpe/app/picture/carried_drawer.h"
#include "vpe/app/picture/frame_overlays.h"
#include "vpe/app/picture/image_options.h"

namespace vpe::app {

// Outputs beside the images.
struct FilmReports {
  std::optional<scripts::StatsWriter> stats;  // a row for every frame that is kept or drawn
  std::optional<scripts::FlightLog> log;      // a pose for every frame
  std::vector<std::string> failures;          // to read tiles, each once
};

class FrameSink;

// Draws on the main thread while another thread encodes earlier frames. Used once, by the main thread.
//
// Typical usage:
//   FilmMaker(plan, target, frames, first, options, makers, overlays).run(reports, line);
class FilmMaker {
 public:
  struct Makers {
    std::function<std::unique_ptr<core::Renderer>(core::Backend)> renderer;
    // Makes what carries second eyes and frames; may be empty if the plan has none. Memory and threads of the options are
    // its own.
    std::function<std::unique_ptr<CarriedDrawer>(core::Renderer&, CarriedDrawerOptions)> carried;
    // Returns the planet with changed ground; empty if the ground never changes. The others have the planet without changes.
    ChangedPlanet planet = {};
  };

  // `first` is the number of frames[0] in the film. A renderer is made when a frame has to be drawn by it. There is
  // one at a time, so that --memory holds also where a flight changes the backend.
  FilmMaker(const FilmPlan& plan, FilmTarget& target, std::span<FilmFrame> frames, std::int64_t first,
            const RenderOptions& options, Makers makers, FrameOverlays& overlays);

  // Draws the missing frames, in order. A frame that cannot be drawn, or not completely (unless the options
  // allow that), is marked as failed, and its group is abandoned; the other groups are made. Throws
  // Interrupted, and std::runtime_error when frames cannot be written or nothing can be drawn; frames stored by
  // then are marked as made.
  void run(FilmReports& reports, ProgressLine& line);

 private:
  struct DrawnEye {
    core::DrawRequest request;
    core::DrawResult result;
    std::optional<core::DrawResult> contours;
  };
  static std::size_t bytes_of(const std::vector<DrawnEye>& eyes);
  core::Renderer& renderer_for(core::Backend backend);
  std::vector<DrawnEye> draw_eyes(std::size_t n, const PlannedFrame& planned, core::Renderer& renderer);
  core::DrawResult keep_failures(core::DrawResult result);
  CarriedDrawer& drawer_for(const PlannedFrame& planned, core::Renderer& renderer);
  core::DrawResult draw_reusing(const PlannedFrame& planned, const core::DrawRequest& request,
                                core::Renderer& renderer);
  void change_ground(const scripts::GroundState& ground, core::Renderer& renderer);
  core::Frame finish(std::vector<DrawnEye>& eyes, const std::optional<core::StereoPair>& stereo, double time_s);
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
  Makers makers_;
  FrameOverlays& overlays_;
  std::unique_ptr<core::Renderer> renderer_;
  std::unique_ptr<CarriedDrawer> drawer_;  // of renderer_, for this gap and bound
  std::pair<double, double> drawer_px_;
  std::shared_ptr<const paging::PlanetFile> planet_;  // of renderer_ and drawer_; null: without changes
  std::optional<std::int64_t> key_;                   // frame that is the drawer's first image
  std::vector<core::MissingTile> key_missing_;        // of it
  core::Backend backend_ = core::Backend::kPolygon;   // of renderer_
  bool is_prepared_ = false;                          // the target
  FilmReports* reports_ = nullptr;                    // during run()
  ProgressLine* line_ = nullptr;
  FrameSink* sink_ = nullptr;
};

}  // namespace vpe::app
