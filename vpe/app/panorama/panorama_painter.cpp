#include "vpe/app/panorama/panorama_painter.h"

#include <limits>
#include <stdexcept>
#include <utility>

#include "vpe/window/ui/display.h"

namespace vpe::app {

namespace {

// Smaller steps of a progress bar cannot be seen.
constexpr double kShownStep = 0.005;
// Tiles of texture that an image may wait for while the view moves: a few milliseconds.
constexpr int kReadsWhileMoving = 8;

}  // namespace

PanoramaPainter::PanoramaPainter(StereoPanorama panorama, std::shared_ptr<window::CopyingState> copying,
                                 OverlookGraphics graphics)
    : panorama_(std::move(panorama)), copying_(std::move(copying)) {
  if (graphics == OverlookGraphics::kOff) return;
  try {
    panorama_.set_context(gl::Context::create());
  } catch (const gl::ContextError&) {
    if (graphics == OverlookGraphics::kOn) throw;
  }
}

window::DrawnImage PanoramaPainter::paint(const window::ImageRequest& request) {
  const auto copied = [this](const std::string&, double fraction) {
    if (copying_->stop) throw std::runtime_error("stopped");
    const double shown = copying_->fraction;
    if (shown >= 0 && fraction >= shown && fraction < shown + kShownStep) return;
    copying_->fraction = fraction;
    window::Display::wake();
  };
  // An image whose copy failed is not copied again with every view.
  if (!failure_.empty()) throw std::runtime_error(failure_);
  window::DrawnImage drawn;
  try {
    panorama_.limit_reads(request.is_full ? std::numeric_limits<int>::max() : kReadsWhileMoving);
    drawn.image = panorama_.draw(request.draw.view, request.stereo, copied);
  } catch (const std::exception& e) {
    const bool copied_some = copying_->fraction.exchange(-1) >= 0;
    if (copied_some && !copying_->stop) failure_ = e.what();
    throw;
  }
  drawn.result.settled = panorama_.is_complete();
  copying_->fraction = -1;
  return drawn;
}

window::OverlookSetup overlook_setup(const PanoramaFiles& files, std::size_t budget_bytes, int threads,
                                     OverlookGraphics graphics) {
  const StereoPanorama panorama(files, budget_bytes, threads);
  window::OverlookSetup setup;
  setup.panorama = panorama.description();
  setup.is_pair = panorama.is_pair();
  setup.make_painter = [files, budget_bytes, threads, graphics, copying = setup.copying] {
    return std::make_unique<PanoramaPainter>(StereoPanorama(files, budget_bytes, threads), copying, graphics);
  };
  return setup;
}

}  // namespace vpe::app
