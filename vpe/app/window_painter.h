// Images for a window: either backend, overlays, one eye or two.
#pragma once

#include <memory>

#include "paging/planet/planet_file.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/picture/frame_overlays.h"
#include "vpe/window/painter.h"

namespace vpe::app {

// Holds one backend at a time, so that --memory holds: changing it begins with nothing loaded.
class WindowPainter : public window::Painter {
 public:
  WindowPainter(std::shared_ptr<const paging::PlanetFile> planet, Common common);
  window::DrawnImage paint(const window::ImageRequest& order) override;

 private:
  core::DrawResult draw(const core::DrawRequest& request, double time_s);

  std::shared_ptr<const paging::PlanetFile> planet_;
  Common common_;
  FrameOverlays overlays_;
  std::optional<window::Backend> backend_;
  std::unique_ptr<core::Renderer> renderer_;
};

}  // namespace vpe::app
