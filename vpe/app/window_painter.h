// Images for the exploration window: either backend, overlays, mono or stereo.
#pragma once

#include <memory>
#include <optional>

#include "paging/planet/planet_file.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/picture/carried_drawer.h"
#include "vpe/app/picture/frame_overlays.h"
#include "vpe/app/picture/stereo_render.h"
#include "vpe/app/picture/view_palette.h"
#include "vpe/app/planet/flight_ground.h"
#include "vpe/gl/polygon_renderer.h"
#include "vpe/window/workers/painter.h"

namespace vpe::app {

// Returns the request as rays draw it in a window. In mode exact they draw the finest tiles everywhere; where level
// control is asked for, or `within_tolerance`, it becomes multires with cells of the tolerance. Pure.
core::DrawRequest for_window_rays(core::DrawRequest request, bool within_tolerance);

// Returns a request as WindowPainter draws it: a limit of triangles is kept by triangles, whatever is chosen, and rays
// have the mode of for_window_rays(). Pure.
window::ImageRequest as_drawn(window::ImageRequest request);

// Draws the window's image requests. Holds one backend at a time to keep within --memory, and gives each of two planets
// that are compared a half of it. After a change of the backend, of exaggeration or of the kind of shading no loaded tile
// fits, and the first image waits for its tiles for `change_s` at most, so that the window shows the former image until
// then. One thread at a time.
class WindowPainter : public window::Painter {
 public:
  static constexpr double kChange_s = 1.5;
  // `stereo` says how second eyes are drawn by rays; triangles draw them in full.
  WindowPainter(std::shared_ptr<const paging::PlanetFile> planet, Common common, StereoMethod stereo = {},
                double change_s = kChange_s);
  window::DrawnImage paint(const window::ImageRequest& request) override;

 private:
  core::DrawResult draw(const core::DrawRequest& request, double time_s, Eye eye = Eye::kMiddle);
  core::DrawResult with_overlays(const core::DrawRequest& request, core::DrawResult result, double time_s,
                                 FrameOverlays& overlays) const;
  void draw_earlier(const core::DrawRequest& request, const window::ImageRequest& asked,
                    window::DrawnImage& drawn);
  // Returns what carries second eyes, or null if they are drawn in full.
  CarriedDrawer* drawer_for(const core::DrawRequest& request, Eye eye);
  void draw_pair(const window::ImageRequest& request, const core::DrawRequest& draw_request,
                 window::DrawnImage& drawn);
  // Goes over to the planet as the flight has changed it at the request's time, and then its reliefs.
  void change_ground(const window::ImageRequest& request);
  bool take_palette(core::DrawRequest& request, window::DrawnImage& drawn);
  std::unique_ptr<core::Renderer> make_ground_renderer(core::Backend backend, const window::DrawPlace& place);
  void take_texture(const core::DrawRequest& request, window::DrawnImage& drawn);

  std::shared_ptr<const paging::PlanetFile> planet_;  // as its file is
  std::shared_ptr<const paging::PlanetFile> shown_;   // with the changes of a flight
  std::unique_ptr<FlightGround> ground_;              // of the last flight that changed the ground
  Common common_;
  double change_s_;
  FrameOverlays overlays_;
  std::optional<core::Backend> backend_;
  std::unique_ptr<core::Renderer> renderer_;
  // Shared with renderer_ where that draws in the window's context, else null.
  std::shared_ptr<gl::TextureHandover> handover_;
  // Draw the planet that this one is compared with, once it is needed.
  std::unique_ptr<core::Renderer> earlier_renderer_;
  std::unique_ptr<FrameOverlays> earlier_overlays_;
  StereoMethod stereo_;
  std::unique_ptr<CarriedDrawer> carried_;  // of renderer_, once it is needed

  // The palette by the view: what its ends were taken from, and the view of the request before.
  struct Sight {
    core::View view;
    core::Colour colour = core::Colour::kElevation;
    double exaggeration = 1;
  };
  static bool is_same(const Sight& a, const Sight& b);
  std::unique_ptr<ViewPalette> view_palette_;  // made for the first such image
  std::optional<Sight> palette_of_;
  std::optional<Sight> before_;
  core::PaletteEnds ends_;
  std::string told_;  // that image layers are left out
};

}  // namespace vpe::app
