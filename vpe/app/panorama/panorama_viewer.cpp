#include "vpe/app/panorama/panorama_viewer.h"

#include <stdexcept>
#ifdef VPE_HAS_WINDOW
#include <filesystem>
#include <utility>

#include "vpe/app/cli/interrupt.h"
#include "vpe/app/panorama/panorama_painter.h"
#include "vpe/window/overlook_window.h"
#endif

namespace vpe::app {

#ifdef VPE_HAS_WINDOW

namespace {

constexpr double kIdle_s = 0.5;

window::DisplayOptions display_options() {
  window::DisplayOptions options;
  options.instead =
      "set DISPLAY to an X server, or work without a window: --view YAW,PITCH -o VIEW.png draws a view, "
      "--direction AZIMUTH,ELEVATION prints what is there, and 'xvfb-run vpe overlook PANO' opens the window "
      "on a virtual screen";
  return options;
}

}  // namespace

void check_window() { window::check_display(display_options()); }

panorama::Viewer view_panorama(const PanoramaViewerRequest& request, const Common& common) {
  window::OverlookWindowSetup setup;
  setup.preferences = explore::read_preferences(explore::explore_files().preferences);
  // The rest of the memory is for views and the window.
  setup.view = overlook_setup(request.files, memory_bytes(common) / 4 * 3, common.threads,
                              request.is_exact ? OverlookGraphics::kOff : OverlookGraphics::kAuto);
  setup.view.look = request.direction;
  setup.view.fov_deg = request.fov_deg;
  setup.view.head_scale = request.head_scale;
  setup.view.stereo = request.stereo;
  setup.view.images = std::filesystem::current_path();
  setup.display = display_options();
  setup.display.title = "vpe - " + setup.view.panorama.image.filename().string();
  setup.display.width = request.size.width;
  setup.display.height = request.size.height;
  setup.display.scale = request.scale;
  // Ctrl+C stops the copying of a large image and removes the unfinished copy.
  const InterruptGuard guard;
  window::OverlookWindow window(std::move(setup));
  while (window.step(kIdle_s)) InterruptGuard::check();
  return window.view().viewer();
}

#else

void check_window() {
  throw std::runtime_error(
      "this program was built without windows; install libglfw3-dev and libimgui-dev and build it again, or "
      "work without a window: --view YAW,PITCH -o VIEW.png draws a view, --direction AZIMUTH,ELEVATION prints "
      "what is there");
}

panorama::Viewer view_panorama(const PanoramaViewerRequest&, const Common&) {
  check_window();
  throw std::logic_error("check_window() throws");
}

#endif

}  // namespace vpe::app
