// What keys and buttons ask of the explore window, and the files that it writes.
#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <glm/geometric.hpp>

#include "vpe/base/file.h"
#include "vpe/base/number.h"
#include "vpe/core/image/image.h"
#include "vpe/explore/input/keyboard.h"
#include "vpe/window/explore_window.h"

namespace vpe::window {

namespace fs = std::filesystem;

namespace {

constexpr double kZoomStep = 1.15;  // of the field of view

// What the window itself does while one stands in a panorama; all else would move a camera that nobody sees through.
using Kind = explore::ActionKind;
constexpr std::array kInside{Kind::kRecord,     Kind::kLeave,      Kind::kRecentreHead, Kind::kMap,
                             Kind::kHidePanels, Kind::kFullScreen, Kind::kHelp,         Kind::kEnterOverlook};

}  // namespace

// "vpe-20261122-150405.png", with a number added when there is one already.
fs::path ExploreWindow::new_file(const std::string& kind, const std::string& extension) const {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  char stamp[32];
  std::strftime(stamp, sizeof stamp, "%Y%m%d-%H%M%S", &local);
  const std::string stem = "vpe-" + kind + stamp;
  fs::path file = setup_.folder / (stem + extension);
  for (int n = 2; fs::exists(file); ++n) file = setup_.folder / (stem + "-" + std::to_string(n) + extension);
  return file;
}

void ExploreWindow::open_dropped(const std::string& file) {
  if (!setup_.open_planet) return say("another planet cannot be opened here", true);
  if (opening_.valid()) return say("wait until " + opening_file_ + " is open", true);
  opening_file_ = file;
  opening_ = std::async(std::launch::async, [open = setup_.open_planet, file] {
    auto planet = open(file);
    Display::wake();
    return planet;
  });
  say("opening " + file + "; what is no planet file is made into one first");
}

void ExploreWindow::take_opened() {
  if (!opening_.valid() || opening_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
  try {
    next_planet_ = opening_.get();
  } catch (const std::exception& e) {
    say(e.what(), true);
  }
}

void ExploreWindow::save_image() {
  saves_image_ = false;
  const fs::path file = new_file("", ".png");
  try {
    core::write_image(file.string(), last_image_.pixels, last_image_.width, last_image_.height);
    say("picture: " + file.string());
  } catch (const std::exception& e) {
    say(e.what(), true);
  }
}

void ExploreWindow::start_log(const fs::path& file) {
  try {
    scripts::FlightView view;
    view.fov_deg = session_.screen().fov_deg;
    view.width = session_.screen().width;
    view.height = session_.screen().height;
    log_ = std::make_unique<explore::SessionLog>(file, view, session_.ground().radius_m);
    log_file_ = file;
    log_begun_s_ = now_s();
    log_note_.clear();
    say("recording: " + file.string());
  } catch (const std::exception& e) {
    log_.reset();
    say(e.what(), true);
  }
}

void ExploreWindow::stop_log() {
  if (log_ == nullptr) return;
  const std::unique_ptr<explore::SessionLog> log = std::move(log_);
  try {
    log->end(now_s() - log_begun_s_);
    say("recorded: " + log_file_.string());
  } catch (const std::exception& e) {
    say(e.what(), true);  // what was written before is a flight all the same
  }
}

// In a panorama the camera stands at the spot and the head looks where its view does.
void ExploreWindow::log_overlook() {
  if (log_ == nullptr) return;
  const panorama::Viewer& viewer = guide_.inside()->viewer();
  const std::pair look{viewer.yaw_deg(), viewer.pitch_deg()};
  if (look == logged_look_) return;
  logged_look_ = look;
  mars::CameraPose camera;
  camera.position_m = guide_.inside_camera_m();
  const mars::LonLat place = mars::lon_lat(camera.position_m);
  const mars::Pose stand{
      place.lon_deg, place.lat_deg, glm::length(camera.position_m) - session_.ground().radius_m, 0, 0, 0};
  try {
    log_->frame({now_s() - log_begun_s_, stand, {std::remainder(look.first, 360.0), look.second, 0}},
                session_.settings(), session_.all_interest());
  } catch (const std::exception& e) {
    log_.reset();
    say(e.what(), true);
  }
}

std::string ExploreWindow::exit_message() {
  const explore::FlightEditor* editor = session_.flights().editor();
  if (editor == nullptr || !editor->is_changed()) return {};
  const fs::path file = new_file("unsaved-", ".flight");
  try {
    base::write_file(file, editor->to_text());
    return "the flight was not saved; it is kept in " + file.string();
  } catch (const std::exception& e) {
    return std::string("the flight that was not saved is lost: ") + e.what();
  }
}

void ExploreWindow::log_image(ImageRequest& order) {
  if (log_ == nullptr) return;
  try {
    const double time_s = now_s() - log_begun_s_;
    const std::string drawn = std::string("drawn by ") + to_string(order.backend) + ", " +
                              std::to_string(session_.screen().width) + "x" +
                              std::to_string(session_.screen().height) + ", field of view " +
                              base::format_number(session_.screen().fov_deg) + " degrees" +
                              (order.stereo ? ", " + std::string(core::to_string(*order.stereo)) : "");
    if (drawn != log_note_) log_->note(time_s, drawn);
    log_note_ = drawn;
    order.logged_s =
        log_->frame({time_s, session_.pose(), session_.look()}, session_.settings(), order.request.interest);
  } catch (const std::exception& e) {
    log_.reset();
    say(e.what(), true);
  }
}

void ExploreWindow::go_to_bookmark(int number) {
  if (setup_.bookmarks.empty()) return say("there is no folder to keep bookmarks in: HOME is not set", true);
  try {
    const explore::ParsedBookmarks parsed = explore::load_bookmarks(setup_.bookmarks);
    if (!parsed.bookmarks) return say(scripts::to_string(parsed.errors.front()), true);
    const auto found = parsed.bookmarks->at_key(number);
    if (!found)
      return say("bookmark " + std::to_string(number) + " is not set; Ctrl+" + std::to_string(number) +
                 " sets it");
    session_.set_fov(found->view.fov_deg);
    session_.go(found->view.pose);
    say("bookmark " + std::to_string(number) + ": " + found->name);
  } catch (const std::exception& e) {
    say(e.what(), true);
  }
}

void ExploreWindow::set_bookmark(int number) {
  if (setup_.bookmarks.empty()) return say("there is no folder to keep bookmarks in: HOME is not set", true);
  try {
    explore::ParsedBookmarks parsed = explore::load_bookmarks(setup_.bookmarks);
    if (!parsed.bookmarks) return say(scripts::to_string(parsed.errors.front()), true);
    const explore::Bookmark bookmark{
        number, {session_.pose(), session_.screen().fov_deg}, "view " + std::to_string(number)};
    const std::string trouble = parsed.bookmarks->put(bookmark);
    if (!trouble.empty()) return say(trouble, true);
    explore::save_bookmarks(setup_.bookmarks, *parsed.bookmarks);
    say("bookmark " + std::to_string(number) + " set");
  } catch (const std::exception& e) {
    say(e.what(), true);
  }
}

void ExploreWindow::save_flight() {
  explore::FlightEditor* editor = session_.flights().editor();
  if (editor == nullptr) return say("there is no flight yet; place waypoints first", true);
  if (setup_.flight_file.empty()) setup_.flight_file = new_file("", ".flight").string();
  try {
    base::write_file(setup_.flight_file, editor->to_text());
    editor->mark_saved();
    say("flight: " + setup_.flight_file);
  } catch (const std::exception& e) {
    say(e.what(), true);
  }
}

std::string ExploreWindow::act(const explore::Action& action) {
  const auto go = [this](const std::optional<explore::SavedView>& view) -> std::string {
    if (!view) return "there is no other view to go to";
    session_.set_fov(view->fov_deg);
    session_.go(view->pose);
    return {};
  };
  if (guide_.inside() != nullptr) {
    if (guide_.inside()->act(action)) return {};
    if (!std::ranges::count(kInside, action.kind)) return "Esc steps out of the panorama first";
  }
  switch (action.kind) {
    case Kind::kNorthUp: session_.north_up(); return {};
    case Kind::kLookDown: session_.look_down(false); return {};
    case Kind::kWholePlanet: session_.show_planet(); return {};
    case Kind::kLevel: session_.level(); return {};
    case Kind::kReset: session_.look_down(true); return {};
    case Kind::kViewBack: return go(history_.back());
    case Kind::kViewForward: return go(history_.forward());
    case Kind::kGoToBookmark: go_to_bookmark(action.number); return {};
    case Kind::kSetBookmark: set_bookmark(action.number); return {};
    case Kind::kZoomIn: session_.set_fov(session_.screen().fov_deg / kZoomStep); return {};
    case Kind::kZoomOut: session_.set_fov(session_.screen().fov_deg * kZoomStep); return {};
    case Kind::kZoomReset: session_.set_fov(first_fov_deg_); return {};
    case Kind::kPlayPause: {
      const explore::FlightPlayer* flight = session_.follows_flight() ? session_.player() : nullptr;
      return session_.follow(flight == nullptr || !flight->is_playing());
    }
    case Kind::kRecord:
      if (log_ != nullptr)
        stop_log();
      else
        start_log(new_file("log-", ".flight"));
      return {};
    case Kind::kPlaceWaypoint: return session_.flights().add(session_.pose(), state_.ground_speed_m_s);
    case Kind::kLeave:
      state_.help = false;
      if (guide_.inside() != nullptr) {
        step_out();
        return {};
      }
      session_.leave_flight();
      return {};
    case Kind::kRecentreHead: devices_.recentre(now_s()); return {};
    case Kind::kMap: state_.large_map = !state_.large_map; return {};
    case Kind::kHidePanels: state_.panels = !state_.panels; return {};
    case Kind::kFullScreen: display_.set_fullscreen(!display_.is_fullscreen()); return {};
    case Kind::kScreenshot:
      if (shows_final_image())
        save_image();
      else
        saves_image_ = true;
      return {};
    case Kind::kHelp: state_.help = !state_.help; return {};
    case Kind::kMeasure:
      if (!under_cursor_) return "there is no ground under the cursor to place a point on";
      measure_.add(*under_cursor_);
      return {};
    case Kind::kEnterOverlook: {
      const std::string trouble = guide_.enter();
      if (!trouble.empty()) return trouble;
      const explore::Hotspot& hotspot = *guide_.inside_hotspot();
      say(hotspot.name + ": Esc steps out");
      session_.release();
      if (log_ == nullptr) return {};
      try {
        log_->enter(now_s() - log_begun_s_, hotspot.name, hotspot.panorama);
      } catch (const std::exception& e) {
        log_.reset();
        return e.what();
      }
      return {};
    }
  }
  return {};
}

}  // namespace vpe::window
