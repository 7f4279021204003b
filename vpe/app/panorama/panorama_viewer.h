// `vpe overlook` in a window.
#pragma once

#include <optional>

#include "panorama/viewer/viewer.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/panorama/open_stereo.h"
#include "vpe/app/picture/image_options.h"
#include "vpe/core/stereo.h"

namespace vpe::app {

struct PanoramaViewer {
  EyesFiles files;
  std::optional<panorama::Direction> look;  // to begin with; the middle when left out
  double fov_deg = panorama::ViewerLimits::kDefaultFov_deg;
  std::optional<core::StereoLayout> stereo;
  Size size;         // of the window
  double scale = 0;  // of letters; 0: as the preferences or the monitor have it
};

// Throws std::runtime_error that says what to do instead when no window can be had.
void check_window();

// Until the window is closed; returns where it looked then. Throws Interrupted, and as window::OverlookWindow.
panorama::Viewer view_panorama(const PanoramaViewer& request, const Common& common);

}  // namespace vpe::app
