// The menu of a place in the explore window: right clicks in view and map, and what is chosen.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <exception>

#include "vpe/explore/command_words.h"
#include "vpe/window/explore_window.h"
#include "vpe/window/panels/file_panel.h"

namespace vpe::window {

// Opens the menu after a right click into the view that was no drag. The drag itself goes its usual way.
void ExploreWindow::watch_menu_click(const Event& event) {
  const bool is_right = event.code == GLFW_MOUSE_BUTTON_RIGHT;
  switch (event.kind) {
    case Event::Kind::kPress:
      menu_click_.cancel();
      menu_place_.reset();
      if (is_right && !state_.large_map && !ImGui::GetIO().WantCaptureMouse) {
        const ImageLayout layout = image_layout();
        const auto xy = layout.camera_xy(cursor_);
        if (!xy) break;
        menu_click_.press(cursor_);
        menu_place_ = session_.place_at(eye_image(layout.eye_at(cursor_)).view, *xy);
      }
      break;
    case Event::Kind::kMove: menu_click_.move(cursor_); break;
    case Event::Kind::kRelease:
      if (!is_right || !menu_click_.release()) break;
      if (menu_place_)
        open_menu(*menu_place_);
      else
        show_message("there is no ground under the cursor");
      break;
    case Event::Kind::kFocusLost: menu_click_.cancel(); break;
    default: break;
  }
}

void ExploreWindow::open_menu(mars::LonLat place) {
  if (guide_.inside() != nullptr) return show_message("press Esc to leave the panorama first", true);
  welcome_.dismiss();
  try {
    const explore::PlaceReport report =
        explore::what_is_here(session_.surface(), place, search_.places().places());
    menu_.open(place, report, explore::usual_reach_m(report.ground.at.spacing_m, session_.ground().radius_m));
    frames_due_ = kFramesAfterChange;
  } catch (const std::exception& e) {
    show_message(e.what(), true);
  }
}

void ExploreWindow::draw_menu() {
  if (!menu_.is_open()) return;
  PlaceOffer offer;
  const std::size_t points = measure_.points().size();
  offer.profile_from = points > 0 ? "point " + explore::path_point_name(points - 1) : "the camera's place";
  offer.can_make = jobs_.can_start();
  offer.why_not = why_not_made(false);
  const std::optional<PlaceChoice> choice = menu_.draw(offer, widgets_);
  if (!choice) return;
  frames_due_ = kFramesAfterChange;
  choose(*choice, menu_.place());
}

void ExploreWindow::choose(PlaceChoice choice, mars::LonLat place) {
  switch (choice) {
    case PlaceChoice::kCopy:
      glfwSetClipboardString(display_.handle(), menu_.text().c_str());
      return show_message("copied: what is at " + explore::coordinates_text(place));
    case PlaceChoice::kMeasureFrom:
      measure_.begin_at(place);
      return show_message("point A is set; M, or a right click and Profile to here, sets the next one");
    case PlaceChoice::kProfileTo:
      return measure_.go_on_to(place, {session_.pose().lon_deg, session_.pose().lat_deg});
    case PlaceChoice::kViewshedFrom: {
      explore::MakeOptions options = make_options();
      const std::filesystem::path file = new_file(setup_.folder, "viewshed-", ".tif");
      options.output = file.string();
      return start_job({JobKind::kMakes,
                        "viewshed",
                        explore::viewshed_words(place, menu_.height_m(), menu_.reach_m(), options),
                        file,
                        {}});
    }
    case PlaceChoice::kPanoramaFrom: {
      explore::MakeOptions options = make_options();
      const std::filesystem::path file = new_file(setup_.folder, "panorama-", ".jpg");
      options.output = file.string();
      options.width_px = kPanoramaSizes.front().width_px;
      return start_job({JobKind::kMakes,
                        "panorama",
                        explore::panorama_words_at(session_, place, menu_.height_m(), options),
                        file,
                        {}});
    }
  }
}

}  // namespace vpe::window
