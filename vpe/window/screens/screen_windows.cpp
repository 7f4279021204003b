#include "vpe/window/screens/screen_windows.h"

#include <algorithm>
#include <utility>

#include "vpe/base/quote.h"

namespace vpe::window {

namespace {

bool is_same_place(const core::View& a, const core::View& b) {
  return a.camera.position_m == b.camera.position_m && a.camera.axes.right == b.camera.axes.right &&
         a.camera.axes.up == b.camera.axes.up && a.camera.axes.forward == b.camera.axes.forward &&
         a.fov_deg == b.fov_deg && a.principal_offset_px == b.principal_offset_px && a.width == b.width &&
         a.height == b.height;
}

bool are_same(const std::vector<ScreenOrder>& a, const std::vector<ScreenOrder>& b) {
  return std::ranges::equal(a, b, [](const ScreenOrder& one, const ScreenOrder& other) {
    return one.view.has_value() == other.view.has_value() &&
           (!one.view || is_same_place(*one.view, *other.view));
  });
}

}  // namespace

ScreenWindows::ScreenWindows(explore::ScreenSet set, const MakePainter& make_painter,
                             std::function<void()> notify)
    : set_(std::move(set)), notify_(std::move(notify)) {
  for (const explore::ScreenSet::Entry& entry : set_.screens) {
    // The last one that is shown waits for the display, once for all.
    const bool is_last = &entry == &set_.screens.back();
    windows_.push_back(std::make_unique<ScreenWindow>(entry, is_last));
    if (entry.screen.eye == explore::ScreenEye::kBoth && !windows_.back()->has_pairs())
      notes_.push_back("screen " + base::quote_text(entry.screen.name) +
                       " shows one image: the driver has no pairs in turn (frame-sequential stereo)");
  }
  set_painter(make_painter);
}

void ScreenWindows::set_painter(const MakePainter& make_painter) {
  maker_ = std::make_unique<ScreenMaker>(set_, make_painter, notify_);
  asked_.clear();
}

std::vector<ScreenOrder> ScreenWindows::orders(const ScreenScene& scene) const {
  std::vector<ScreenOrder> all;
  const explore::Room room = explore::room_of(set_);
  for (std::size_t n = 0; n < windows_.size(); ++n) {
    const explore::PlacedScreen& screen = set_.screens[n].screen;
    for (const int side : explore::sides_of(screen.eye, windows_[n]->has_pairs()))
      all.push_back({n, side, explore::screen_view(screen, scene.head, scene.platform, room, side)});
  }
  return all;
}

bool ScreenWindows::show() {
  std::optional<ScreenImages> drawn = maker_->take();
  if (drawn) {
    error_ = drawn->error;
    live_.record(drawn->seconds * 1e3, drawn->is_settled || !error_.empty());
    for (const ScreenImage& one : drawn->images) windows_[one.order.screen]->upload(one.order.side, one.image);
  }
  const bool has_new = drawn && error_.empty();
  if (has_new) ++rounds_;
  // All are drawn before any is shown, so that the eyes of a pair change together.
  std::vector<ScreenWindow*> due;
  for (const auto& window : windows_) {
    window->follow_close();
    if (has_new || window->is_damaged()) due.push_back(window.get());
  }
  for (ScreenWindow* window : due) window->draw();
  for (ScreenWindow* window : due) window->swap();
  return has_new;
}

bool ScreenWindows::update(const ScreenScene& scene) {
  const bool has_new = show();
  if (!maker_->is_idle()) return has_new;
  live_.set_budget_ms(scene.budget_ms);
  std::vector<ScreenOrder> wanted = orders(scene);
  const auto first = std::ranges::find_if(wanted, [](const ScreenOrder& one) { return one.view.has_value(); });
  const bool changed = scene.state != asked_state_ || !are_same(wanted, asked_);
  ScreenRound round;
  round.base = scene.base;
  round.orders = wanted;
  if (first == wanted.end()) {
    if (!changed) return has_new;
  } else {
    const auto next = live_.next(*first->view, changed, scene.nearest_m);
    if (!next) return has_new;
    round.base.draw.coarsening = next->multiplier;
    round.base.is_full = next->is_full;
    round.base.px_per_screen_px = next->side;
    round.base.draw.settings.lod_tolerance_px *= next->side;
    round.base.draw.settings.ray_cell_px *= next->side;
    round.base.draw.settings.ray_ratio *= next->side;
    for (ScreenOrder& one : round.orders)
      if (one.view) one.view = explore::reduced(*one.view, next->side);
  }
  asked_state_ = scene.state;
  asked_ = std::move(wanted);
  maker_->request(std::move(round));
  return has_new;
}

bool ScreenWindows::is_at_rest() const {
  return maker_->is_idle() && live_.state() == lod::RefinementState::kWaiting;
}

}  // namespace vpe::window
