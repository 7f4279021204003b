// Draws views of a panorama for a window.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "vpe/app/panorama/open_stereo.h"
#include "vpe/window/overlook_view.h"
#include "vpe/window/workers/painter.h"

namespace vpe::app {

// Chooses what draws the views of a panorama: OpenGL where this machine has it, else the CPU; or one of both.
enum class OverlookGraphics : std::uint8_t { kAuto, kOn, kOff };

class PanoramaPainter : public window::Painter {
 public:
  // Reports the progress of copying a large image in `copying`, and stops when it asks for that. Makes an OpenGL context
  // for this thread unless graphics is off. Throws gl::ContextError if it is on and there is none.
  PanoramaPainter(StereoPanorama panorama, std::shared_ptr<window::CopyingState> copying,
                  OverlookGraphics graphics = OverlookGraphics::kAuto);
  window::DrawnImage paint(const window::ImageRequest& request) override;

 private:
  StereoPanorama panorama_;
  std::shared_ptr<window::CopyingState> copying_;
  std::string failure_;  // of copying
};

// Returns the setup of a window that shows a panorama: its description, number of eyes and painter; the rest
// has its defaults. Reads the descriptions now, so that faulty files are reported at once. Throws as
// StereoPanorama.
window::OverlookSetup overlook_setup(const PanoramaFiles& files, std::size_t budget_bytes, int threads,
                                     OverlookGraphics graphics = OverlookGraphics::kAuto);

}  // namespace vpe::app
