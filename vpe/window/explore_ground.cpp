// Ground of the explore window that is not that of the planet's file: reliefs, and flights that change it.
#include <algorithm>
#include <filesystem>
#include <memory>

#include "vpe/window/explore_window.h"

namespace vpe::window {

namespace {

// Tiles of a surface whose ground has changed.
constexpr std::size_t kChangedSurfaceBytes = std::size_t{32} << 20;

}  // namespace

// Lets the session stand on the ground that an image shows.
void ExploreWindow::follow_ground(const std::shared_ptr<const paging::PlanetFile>& changed) {
  const std::shared_ptr<const paging::PlanetFile>& shown = changed ? changed : setup_.surface->shared_planet();
  if (shown == session_.shared_surface()->shared_planet()) return;
  session_.set_changed_surface(changed ? std::make_shared<const paging::Surface>(changed, kChangedSurfaceBytes)
                                       : setup_.surface);
  ground_changed_s_ = now_s();
}

bool ExploreWindow::measures_other_ground() const { return measured_ != session_.shared_surface(); }

// Measures on the ground of the images once that has been at rest for a while.
void ExploreWindow::measure_on_ground() {
  constexpr double kRests_s = 0.4;
  if (!measures_other_ground()) return;
  frames_due_ = std::max(frames_due_, 1);
  if (now_s() - ground_changed_s_ < kRests_s) return;
  measured_ = session_.shared_surface();
  measure_.set_surface(measured_, measured_ == setup_.surface ? setup_.open_scene
                                  : setup_.scenes_on          ? setup_.scenes_on(measured_)
                                                              : explore::OpenScene());
  drawing_.set_surface(measured_);
}

void ExploreWindow::keep_reliefs() {
  reliefs_.update(now_s());
  const ReliefsActions actions = reliefs_.take_actions();
  if (!actions.message.empty()) show_message(actions.message, actions.message_is_error);
  if (!actions.patch) return;
  const std::filesystem::path made = new_file(setup_.folder, "planet-", ".vpe");
  start_job({JobKind::kMakes,
             "planet",
             {"patch", setup_.planet->path(), actions.patch->string(), "-o", made.string()},
             made,
             {}});
}

}  // namespace vpe::window
