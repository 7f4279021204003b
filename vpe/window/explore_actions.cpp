// Actions of the explore window, and the files that it writes.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "mars/geodesy/place_text.h"
#include "vpe/base/file.h"
#include "vpe/core/image/image.h"
#include "vpe/explore/files/user_files.h"
#include "vpe/window/explore_window.h"

namespace vpe::window {

namespace fs = std::filesystem;

namespace {

constexpr double kZoomStep = 1.15;    // of the field of view
constexpr double kLettersStep = 1.1;  // of the scale

// Actions of the window while a panorama is entered. Others would move the camera, which is not shown then.
using Kind = explore::ActionKind;
constexpr std::array kInside{Kind::kRecord,      Kind::kLeave,      Kind::kRecentreHead,  Kind::kMap,
                             Kind::kHidePanels,  Kind::kFullScreen, Kind::kHelp,          Kind::kEnterOverlook,
                             Kind::kFiles,       Kind::kPanelKeys,  Kind::kLettersLarger, Kind::kLettersSmaller,
                             Kind::kLettersUsual};

constexpr const char* kNoBookmarks = "there is no folder for bookmarks: HOME is not set";

struct Reply {
  std::string text;
  bool is_error = false;
};

Reply go_to_bookmark(explore::Session& session, const fs::path& file, int number) {
  if (file.empty()) return {kNoBookmarks, true};
  try {
    const explore::ParsedBookmarks parsed = explore::load_bookmarks(file);
    if (!parsed.bookmarks) return {scripts::to_string(parsed.errors.front()), true};
    const auto found = parsed.bookmarks->at_key(number);
    if (!found)
      return {"bookmark " + std::to_string(number) + " is not set; Ctrl+" + std::to_string(number) +
              " sets it"};
    session.set_fov(found->view.fov_deg);
    session.go(found->view.pose);
    return {"bookmark " + std::to_string(number) + ": " + found->name};
  } catch (const std::exception& e) {
    return {e.what(), true};
  }
}

Reply set_bookmark(const explore::Session& session, const fs::path& file, int number) {
  if (file.empty()) return {kNoBookmarks, true};
  try {
    explore::ParsedBookmarks parsed = explore::load_bookmarks(file);
    if (!parsed.bookmarks) return {scripts::to_string(parsed.errors.front()), true};
    const explore::Bookmark bookmark{
        number, {session.pose(), session.screen().fov_deg}, "view " + std::to_string(number)};
    const std::string problem = parsed.bookmarks->put(bookmark);
    if (!problem.empty()) return {problem, true};
    explore::save_bookmarks(file, *parsed.bookmarks);
    return {"bookmark " + std::to_string(number) + " set"};
  } catch (const std::exception& e) {
    return {e.what(), true};
  }
}

}  // namespace

// Returns what is wrong, or "".
std::string ExploreWindow::swipe(explore::ActionKind kind) {
  if (setup_.planet == nullptr || !setup_.planet->earlier())
    return "there is no earlier planet: 'vpe explore PLANET --compare EARLIER' shows both";
  if (chooser_.choice().stereo) return "the line parts one image; leave stereo in the panel View first";
  if (kind == Kind::kSwipe)
    swipe_.set_on(!swipe_.is_on());
  else
    swipe_.move_by(kind == Kind::kSwipeLeft ? -SwipeLine::kStep : SwipeLine::kStep);
  frames_due_ = kFramesAfterChange;
  return {};
}

void ExploreWindow::save_image() {
  saves_image_ = false;
  const fs::path file = new_file(setup_.folder, "", ".png");
  const core::RgbImage shown = swiped_image();
  try {
    core::write_image(file.string(), shown.pixels, shown.width, shown.height);
    show_message("image: " + file.string());
  } catch (const std::exception& e) {
    show_message(e.what(), true);
  }
}

// Returns the place under the cursor; with the cursor beside the view, as where only the keyboard is used, the one in
// the middle.
std::optional<mars::LonLat> ExploreWindow::pointed_place() const {
  const bool is_over = view_area_.holds(cursor_.x, cursor_.y) && !ImGui::GetIO().WantCaptureMouse;
  if (under_cursor_ || is_over) return under_cursor_;
  return session_.place_at({session_.screen().width / 2.0, session_.screen().height / 2.0});
}

std::string ExploreWindow::copy_view() {
  const mars::LonLat place =
      pointed_place().value_or(mars::LonLat{session_.pose().lon_deg, session_.pose().lat_deg});
  std::string text = mars::place_text(place);
  if (setup_.command_line) text += "\n" + setup_.command_line(session_);
  glfwSetClipboardString(display_.handle(), text.c_str());
  show_message("copied: " + mars::place_text(place));
  return {};
}

void ExploreWindow::set_recording(bool on, const fs::path& file) {
  const std::string error =
      on ? recorder_.start(file.empty() ? new_file(setup_.folder, "log-", ".flight") : file, session_,
                           chooser_.choice().stereo, now_s())
         : recorder_.stop(now_s());
  if (!error.empty()) return show_message(error, true);
  show_message((on ? "recording: " : "recorded: ") + recorder_.file().string());
}

std::string ExploreWindow::exit_message() {
  const explore::FlightEditor* editor = session_.flights().editor();
  if (editor == nullptr || !editor->is_changed()) return {};
  const fs::path file = new_file(setup_.folder, "unsaved-", ".flight");
  try {
    base::write_file(file, editor->to_text());
    session_.flights().editor()->mark_saved();
    (void)backup_.update(session_.flights().editor());
    return "the flight was not saved; a copy is in " + file.string();
  } catch (const std::exception& e) {
    std::error_code unknown;
    if (fs::exists(backup_.file(), unknown))
      return std::string("the flight was not saved: ") + e.what() + "; a copy is in " + backup_.file().string();
    return std::string("the flight was not saved and is lost: ") + e.what();
  }
}

void ExploreWindow::restore_flight(const fs::path& copy) {
  try {
    const scripts::ParsedFlight parsed = read_flight_file(copy);
    if (!parsed.flight) throw std::runtime_error(scripts::to_string(parsed.errors.front()));
    if (const std::string error = session_.flights().load(*parsed.flight); !error.empty())
      throw std::runtime_error(error);
    session_.flights().editor()->mark_unsaved();
    backup_.adopt(copy);
    show_message("the unsaved flight is open");
  } catch (const std::exception& e) {
    show_message(e.what(), true);
  }
  flight_.offer(backup_.abandoned());
}

void ExploreWindow::scale_letters(double factor) {
  constexpr double kStep = 0.05;
  const double scale = kStep * std::round(display_.scale() * factor / kStep);
  int width = 1;
  int height = 1;
  display_.framebuffer(width, height);
  const double most = std::min(Display::kLargestScale, largest_scale(width, height));
  state_.letters = std::clamp(scale, Display::kSmallestScale, std::max(Display::kSmallestScale, most));
  show_message("scale of letters and panels " + formatted("%.2f", state_.letters) +
               (scale > most ? ": the window has no room for more" : ""));
}

std::string ExploreWindow::act(const explore::Action& action) {
  const auto go = [this](const std::optional<explore::SavedView>& view) -> std::string {
    if (!view) return "there is no other view in the history";
    session_.set_fov(view->fov_deg);
    session_.go(view->pose);
    return {};
  };
  const auto reply = [this](const Reply& r) -> std::string {
    if (r.is_error) return r.text;
    show_message(r.text);
    return {};
  };
  if (guide_.inside() != nullptr) {
    if (guide_.inside()->act(action)) return {};
    if (!std::ranges::count(kInside, action.kind)) return "press Esc to leave the panorama first";
  }
  if (has_project() && (action.kind == Kind::kGoToBookmark || action.kind == Kind::kSetBookmark))
    return act_on_project_bookmark(action);
  switch (action.kind) {
    case Kind::kNorthUp: session_.north_up(); return {};
    case Kind::kLookDown: session_.look_down(false); return {};
    case Kind::kWholePlanet: session_.show_planet(); return {};
    case Kind::kLevel: session_.level(); return {};
    case Kind::kReset: session_.look_down(true); return {};
    case Kind::kViewBack: return go(history_.back());
    case Kind::kViewForward: return go(history_.forward());
    case Kind::kGoToBookmark: return reply(go_to_bookmark(session_, setup_.bookmarks, action.number));
    case Kind::kSetBookmark:
      places_.reload();
      return reply(set_bookmark(session_, setup_.bookmarks, action.number));
    case Kind::kZoomIn: session_.zoom(1 / kZoomStep); return {};
    case Kind::kZoomOut: session_.zoom(kZoomStep); return {};
    case Kind::kZoomReset:
      if (const std::string problem = session_.set_orthographic(false); !problem.empty()) return problem;
      session_.set_fov(first_fov_deg_);
      return {};
    case Kind::kOrthographic: {
      const bool on = !session_.is_orthographic();
      if (std::string problem = session_.set_orthographic(on); !problem.empty()) return problem;
      show_message(on ? "orthographic camera; O: perspective" : "perspective camera");
      return {};
    }
    case Kind::kNextMode:
    case Kind::kPreviousMode: {
      const explore::MotionMode mode = action.kind == Kind::kNextMode ? explore::next_mode(session_.mode())
                                                                      : explore::previous_mode(session_.mode());
      session_.set_mode(mode);
      show_message(std::string(explore::to_string(mode)) + ": " + std::string(explore::meaning(mode)));
      return {};
    }
    case Kind::kCatchCursor:
      if (!display_.has_caught_cursor()) return catch_cursor();
      let_cursor_go();
      return {};
    case Kind::kSwipe:
    case Kind::kSwipeLeft:
    case Kind::kSwipeRight: return swipe(action.kind);
    case Kind::kPlayPause: {
      const explore::FlightPlayer* flight = session_.follows_flight() ? session_.player() : nullptr;
      return session_.follow(flight == nullptr || !flight->is_playing());
    }
    case Kind::kRecord: set_recording(!recorder_.is_recording()); return {};
    case Kind::kPlaceWaypoint:
      return session_.flights().append(session_.pose(), flight_.ground_speed_m_s(session_));
    case Kind::kLeave:
      if (menu_.close() || std::exchange(state_.help, false) || std::exchange(state_.preferences, false) ||
          std::exchange(state_.files, false))
        return {};
      if (guide_.inside() != nullptr) {
        leave_overlook();
        return {};
      }
      session_.leave_flight();
      return {};
    case Kind::kRecentreHead: devices_.recentre(now_s()); return {};
    case Kind::kMap: state_.large_map = !state_.large_map; return {};
    case Kind::kHidePanels: state_.panels = !state_.panels; return {};
    case Kind::kFullScreen: display_.set_fullscreen(!display_.is_fullscreen()); return {};
    case Kind::kLettersLarger: scale_letters(kLettersStep); return {};
    case Kind::kLettersSmaller: scale_letters(1 / kLettersStep); return {};
    case Kind::kLettersUsual:
      state_.letters = 0;
      show_message("letters of the usual size");
      return {};
    case Kind::kScreenshot:
      if (shows_final_image())
        save_image();
      else
        saves_image_ = true;
      return {};
    case Kind::kSearch:
      state_.panels = true;
      state_.side_is_open = true;
      search_.focus();
      return {};
    case Kind::kFiles:
      state_.files = !state_.files;
      if (state_.files) files_.focus();
      return {};
    case Kind::kCopy: return copy_view();
    case Kind::kHelp: state_.help = !state_.help; return {};
    case Kind::kPanelKeys:
      devices_.lose_keyboard();
      panel_focus_.next();
      return {};
    case Kind::kMeasure:
      if (const auto place = pointed_place()) {
        measure_.add(*place);
        return {};
      }
      return "there is no ground under the cursor";
    case Kind::kEnterOverlook: {
      if (guide_.hotspots().empty()) {
        show_message("there is no panorama to enter: no file of hotspots is open");
        return {};
      }
      if (std::string error = guide_.enter(session_); !error.empty()) return error;
      const explore::Hotspot& hotspot = *guide_.inside_hotspot();
      show_message(hotspot.name + ": press Esc to leave");
      session_.release();
      return recorder_.enter_overlook(hotspot, now_s());
    }
  }
  return {};
}

}  // namespace vpe::window
