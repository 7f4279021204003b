// Plan of a film: the flight's file, the selection of its frames, and for every frame the draw request and its
// fingerprint.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scripts/flight.h"
#include "scripts/path.h"
#include "vpe/app/film/film_frame.h"
#include "vpe/app/picture/fingerprint.h"
#include "vpe/core/appearance/palette.h"
#include "vpe/core/stereo.h"

namespace vpe::app {

// Reads a flight from a file. Throws std::runtime_error that names the file and every bad line.
scripts::Flight read_flight(const std::string& path);

// The frames of a flight that one run makes: first, first + step, ... up to last.
struct FrameRange {
  std::int64_t first = 0;
  std::int64_t last = 0;
  std::int64_t step = 1;

  std::int64_t count() const { return (last - first) / step + 1; }
  // Returns the index in the flight of the range's n-th frame, from 0.
  std::int64_t frame(std::int64_t n) const { return first + n * step; }
};

// Parses "A-B", "A-BxN" or "A", both ends included, for a flight of `count` frames. Empty text is all frames.
// Throws UsageError.
FrameRange parse_frames(const std::string& text, std::int64_t count);

// One frame, ready to be drawn.
struct PlannedFrame {
  std::int64_t index = 0;  // in the flight
  double time_s = 0;
  scripts::FlightState state;
  core::Settings settings;
  core::DrawRequest
      request;  // in stereo that of the middle between both eyes, with the size of one eye's image
  core::Backend backend = core::Backend::kPolygon;
  bool names_backend = false;   // the flight names it
  scripts::GroundState ground;  // of the planet on which the frame is drawn
  std::optional<core::StereoPair> stereo;
  // Widest gap of the second eye, which is carried from the first (CarriedDrawerOptions::gap_px). Absent: all is drawn in
  // full.
  std::optional<double> carried_gap_px;
  // Describes a frame that takes pixels of a key frame: itself, or an earlier one.
  struct Reuse {
    std::int64_t key = 0;      // index in the flight
    double most_added_px = 0;  // CarriedDrawerOptions::most_added_px
    glm::ivec2 margin_px{};    // of the key frame, CarriedDrawer::draw_first()
  };
  std::optional<Reuse> reuse;  // absent: drawn in full, and no frame takes its pixels

  // Returns the requests to draw: one, or those of the left and the right eye.
  std::vector<core::DrawRequest> requests() const;
  // Returns the view as a log records it: what the flight says, with the backend and the eye base that were used.
  scripts::ViewState drawn_view() const;
};

// Every frame of a flight whose index is a multiple of this is a key frame, so that the frames of a film do not depend on
// which of them a run makes. Larger: fewer frames are drawn in full, and more is left of the others.
inline constexpr std::int64_t kKeyFrames = 8;

// Says how a plan follows the views of its flight.
struct ViewOptions {
  // Settings of the frames whose backend the flight names; nullopt: RenderBasis::backend draws all frames.
  std::optional<core::Settings> named;
  // For eyes whose distance follows the height above the ground. Empty, or unknown terrain: above the sphere.
  scripts::TerrainHeight terrain_height_m;
  // PlannedFrame::carried_gap_px of pairs that can be carried. Absent: all pairs are drawn in full.
  std::optional<double> carried_gap_px;
  // PlannedFrame::Reuse::most_added_px of frames that can take pixels of a key frame. Larger: fewer pixels are drawn, and
  // their positions are less exact. Absent: all frames are drawn in full.
  std::optional<double> reuse_px;
  // Texts of the content of the files that change the ground, by name (ground_file_stamps()).
  std::map<std::string, std::string> ground_files = {};
};

// The ends of the palette where a film shows a value and takes them from its views (film_palette.h).
struct FilmPalette {
  core::Colour colour = core::Colour::kElevation;
  core::PaletteEnds ends = {};
};

// Turns times of a flight into draw requests. A film has one size. Eyes side by side have half its width each, eyes
// over and under half its height each; the vertical field of view stays. Any thread may call every const member at any time.
//
// Typical usage:
//   const FilmPlan plan(basis, flight.view, scripts::Path(flight, radius_m, terrain, exaggeration), settings);
//   const PlannedFrame planned = plan.at(120);
//   const core::DrawResult result = renderer.draw(planned.request);
class FilmPlan {
 public:
  // `base` holds the settings before the flight's own, in frames whose backend the flight does not name. `interest`
  // holds regions that count from the start on, beside the flight's own.
  FilmPlan(RenderBasis basis, scripts::FlightView view, scripts::Path path, core::Settings base,
           std::vector<core::InterestRegion> interest = {}, ViewOptions views = {});

  const scripts::Path& path() const { return path_; }
  const scripts::FlightView& view() const { return view_; }

  // Puts these ends in place of auto in the frames that at() returns from now on.
  void take_palettes(std::vector<FilmPalette> palettes) { palettes_ = std::move(palettes); }
  const std::vector<FilmPalette>& palettes() const { return palettes_; }

  // Returns a frame by its index in the flight. One that follows a key frame takes pixels of it if they differ in nothing
  // but their views, both have the same ground and are drawn by rays or by triangles that rays can continue, there is no haze, and neither is a
  // pair of eyes.
  PlannedFrame at(std::int64_t frame) const;

  // Returns the frames number begin to end - 1 of a range, all in state kMissing.
  std::vector<FilmFrame> frames(const FrameRange& range, std::int64_t begin, std::int64_t end) const;

 private:
  // Returns a frame without `reuse`.
  PlannedFrame alone(std::int64_t frame) const;
  std::optional<PlannedFrame::Reuse> reuse_of(const PlannedFrame& planned) const;
  std::vector<std::string> ground_lines(const scripts::GroundState& ground) const;
  std::string fingerprint(const PlannedFrame& planned) const;
  core::View view_of(const scripts::FlightState& state) const;
  // Returns the margin with which a key frame shows what the frames after it do.
  glm::ivec2 margin_of(std::int64_t key) const;
  std::optional<core::StereoPair> stereo_of(const scripts::FlightState& state, double time_s) const;

  RenderBasis basis_;
  scripts::FlightView view_;
  scripts::Path path_;
  core::Settings base_;
  std::vector<core::InterestRegion> interest_;
  ViewOptions views_;
  mars::Pose start_;
  std::vector<FilmPalette> palettes_;
};

}  // namespace vpe::app
