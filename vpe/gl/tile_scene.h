// The tiles of a frame, resident and ready to draw.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "vpe/core/frame.h"
#include "vpe/gl/camera_clearance.h"
#include "vpe/gl/polygon_renderer.h"
#include "vpe/gl/tile_cover.h"
#include "vpe/gl/tile_streamer.h"

namespace vpe::gl {

// Joins TileCover (which tiles are drawn), TileStreamer (what is loaded and resident) and CameraClearance
// (where the near plane lies) to the steps of a frame.
//
// Thread rule: the context's thread.
//
// Typical usage, once a frame:
//
//   scene.prepare(request);
//   const double near_m = scene.near_plane_m(request.view);
//   ... draw scene.tiles() as scene.material() says ...
//   scene.record_draw_time(draw_ms);
//   scene.report(result);
class TileScene {
 public:
  TileScene(const std::shared_ptr<const paging::PlanetFile>& planet, const RendererOptions& options);

  // Goes over to another version of the planet, as paging::PlanetUser::change_planet().
  void change_planet(const std::shared_ptr<const paging::PlanetFile>& planet);

  // Decides what is drawn for a request, and makes it resident. The members below refer to that frame.
  void prepare(const core::DrawRequest& request);

  std::span<const SceneTile> tiles() const { return cover_->tiles(); }
  const TileMaterial& material() const { return streamer_.material(); }

  // Returns the scale of the colours shown, or null if none is shown.
  const std::shared_ptr<const core::ColourScale>& scale() const { return streamer_.scale(); }

  // Returns the distance of the near plane for the frame's view, metres.
  double near_plane_m(const core::View& view) const { return clearance_->near_plane_m(cover_->cover(), view); }

  // Takes the time in which the tiles of the frame were drawn, milliseconds.
  void record_draw_time(double draw_ms) { cover_->record_draw_time(draw_ms); }

  // Fills in the frame's counts, times, missing tiles and failures.
  void report(core::DrawResult& result) const;

 private:
  void request_pages(const core::DrawRequest& request);

  TileStreamer streamer_;  // first: the others refer to it
  std::int64_t most_triangles_;
  // Made anew for each planet.
  std::optional<CameraClearance> clearance_;
  std::optional<TileCover> cover_;
  double select_ms_ = 0;
  double load_ms_ = 0;
  bool settled_ = true;
  int frames_for_fallbacks_ = 0;  // frames in turn that lacked nothing but near fallbacks
};

}  // namespace vpe::gl
