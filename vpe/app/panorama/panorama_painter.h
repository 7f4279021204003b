// Views of a panorama for a window.
#pragma once

#include <memory>

#include "vpe/app/panorama/open_stereo.h"
#include "vpe/window/overlook_view.h"
#include "vpe/window/painter.h"

namespace vpe::app {

class PanoramaPainter : public window::Painter {
 public:
  // `copying` is told how far the copying of large images is, and stops it.
  PanoramaPainter(OpenEyes eyes, std::shared_ptr<window::CopyingState> copying);
  window::DrawnImage paint(const window::ImageRequest& order) override;

 private:
  OpenEyes eyes_;
  std::shared_ptr<window::CopyingState> copying_;
  std::string failure_;  // of copying
};

// What a window needs to show a panorama: an overlook's description, eyes and painter, all else as by default.
// Throws as OpenEyes.
window::OverlookSetup overlook_setup(const EyesFiles& files, std::size_t budget_bytes, int threads);

}  // namespace vpe::app
