#include "vpe/app/panorama/panorama_painter.h"

#include <stdexcept>
#include <utility>

#include "vpe/window/display.h"

namespace vpe::app {

namespace {

// Nobody sees less.
constexpr double kShownStep = 0.005;

}  // namespace

PanoramaPainter::PanoramaPainter(OpenEyes eyes, std::shared_ptr<window::CopyingState> copying)
    : eyes_(std::move(eyes)), copying_(std::move(copying)) {}

window::DrawnImage PanoramaPainter::paint(const window::ImageRequest& order) {
  const auto copied = [this](const std::string&, double fraction) {
    if (copying_->stop) throw std::runtime_error("stopped");
    const double shown = copying_->fraction;
    if (shown >= 0 && fraction >= shown && fraction < shown + kShownStep) return;
    copying_->fraction = fraction;
    window::Display::wake();
  };
  // What cannot be copied once is not tried again with every view.
  if (!failure_.empty()) throw std::runtime_error(failure_);
  window::DrawnImage drawn;
  try {
    drawn.image = eyes_.draw(order.request.view, order.stereo, copied);
  } catch (const std::exception& e) {
    const bool copied_some = copying_->fraction.exchange(-1) >= 0;
    if (copied_some && !copying_->stop) failure_ = e.what();
    throw;
  }
  drawn.result.settled = true;
  copying_->fraction = -1;
  return drawn;
}

window::OverlookSetup overlook_setup(const EyesFiles& files, std::size_t budget_bytes, int threads) {
  const OpenEyes eyes(files, budget_bytes, threads);  // so that what is wrong with the files is known now
  window::OverlookSetup setup;
  setup.panorama = eyes.description();
  setup.is_pair = eyes.is_pair();
  setup.make_painter = [files, budget_bytes, threads, copying = setup.copying] {
    return std::make_unique<PanoramaPainter>(OpenEyes(files, budget_bytes, threads), copying);
  };
  return setup;
}

}  // namespace vpe::app
