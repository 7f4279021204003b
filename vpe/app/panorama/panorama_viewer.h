// The window of `vpe overlook`, the panorama viewer.
#pragma once

#include <optional>

#include "panorama/viewer/viewer.h"
#include "vpe/app/cli/program.h"
#include "vpe/app/panorama/open_stereo.h"
#include "vpe/app/picture/image_options.h"
#include "vpe/core/stereo.h"

namespace vpe::app {

struct PanoramaViewerRequest {
  PanoramaFiles files;
  std::optional<panorama::Direction> direction;  // of the first view; nullopt: the middle of the image
  double fov_deg = panorama::ViewerLimits::kDefaultFov_deg;  // vertical
  std::optional<core::StereoLayout> stereo;
  Size size;              // of the window
  bool is_exact = false;  // drawn on the CPU
  double scale = 0;       // of letters; 0: that of the preferences, else of the monitor
  double head_scale = 1;  // OverlookSetup::head_scale
};

// Throws std::runtime_error that says what to do instead if no window can be opened.
void check_window();

// Shows the panorama until the window is closed. Returns the last view. Throws Interrupted, and as
// window::OverlookWindow.
panorama::Viewer view_panorama(const PanoramaViewerRequest& request, const Common& common);

}  // namespace vpe::app
