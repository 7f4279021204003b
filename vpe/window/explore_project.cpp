// Drawings and project of the explore window.
#include <algorithm>
#include <exception>

#include "vpe/base/file.h"
#include "vpe/base/number.h"
#include "vpe/window/explore_window.h"

namespace vpe::window {

namespace fs = std::filesystem;

namespace {

constexpr double kKeepDrawings_s = 1;  // between copies of unsaved drawings

// Returns the settings that differ from the defaults. The time of a frame is a preference unless it was
// changed.
std::vector<std::pair<std::string, std::string>> changed_settings(const core::Settings& settings,
                                                                  double usual_frame_ms) {
  const core::Settings defaults;
  std::vector<std::pair<std::string, std::string>> changed;
  for (const core::SettingInfo& info : core::Settings::list()) {
    const std::string value = settings.get(info.key).value_or("");
    const bool is_preference = info.key == "lod.frame_ms" && settings.values().lod_frame_ms == usual_frame_ms;
    if (value != defaults.get(info.key) && !is_preference) changed.emplace_back(info.key, value);
  }
  return changed;
}

fs::path whole_path(const fs::path& file) {
  if (file.empty()) return file;
  std::error_code failed;
  const fs::path whole = fs::absolute(file, failed);
  return failed ? file : whole.lexically_normal();
}

}  // namespace

// Takes over the project that the window was opened with. Returns what is wrong, or "".
std::string ExploreWindow::open_project() {
  drawing_.join(project_bookmarks_);
  drawing_.join(measure_.path());
  drawing_.join(objects_.editor());
  drawing_.join(reliefs_.editor());
  map_.set_overlay(&drawing_);
  drawing_.offer(drawing_copy_.abandoned());
  if (!setup_.project) return {};
  explore::Project& project = *setup_.project;
  state_.large_map = project.large_map;
  state_.map_style = project.map_style;
  project_bookmarks_.load(std::move(project.bookmarks));
  if (std::string problem = drawing_.drawings().load(std::move(project.drawings)); !problem.empty())
    return problem;
  if (!project.flight_text) return {};
  return session_.flights().load(*project.flight_text);
}

// Lets drawings and the flight take an event of the view. Returns true if it is theirs.
bool ExploreWindow::handle_marks(const Event& event) {
  if (guide_.inside() != nullptr) return false;
  const ImGuiIO& io = ImGui::GetIO();
  const bool is_over_view = !state_.large_map && !io.WantCaptureMouse && state_.image_error.empty();
  const ImageLayout layout = image_layout();
  // What is held stays in the image of the eye in which it was taken.
  const bool holds = drawing_.sketch().held() || flight_.holds_pose() || objects_.holds() || reliefs_.holds();
  const int eye = holds ? held_eye_ : layout.eye_at(cursor_);
  if (event.kind == Event::Kind::kPress) held_eye_ = eye;
  std::optional<glm::dvec2> xy;
  if (is_over_view && layout.image_area().holds(cursor_.x, cursor_.y)) xy = layout.xy_of(eye, cursor_);
  const core::View view = eye_image(eye).view;
  // Of several tools that of the panel that is shown counts.
  if (objects_.is_placing() + reliefs_.is_placing() + drawing_.sketch().tool().has_value() > 1) {
    if (objects_.is_shown() || reliefs_.is_shown()) drawing_.sketch().choose(std::nullopt);
    if (!objects_.is_shown()) objects_.stop_placing();
    if (!reliefs_.is_shown()) reliefs_.stop_placing();
  }
  const bool draws = drawing_.sketch().tool().has_value();
  const bool is_typing = io.WantTextInput || panel_focus_.is_on();
  const bool is_mine = (!draws && objects_.handle(event, xy, is_typing, session_, view)) ||
                       (!draws && reliefs_.handle(event, xy, is_typing, session_, view)) ||
                       drawing_.handle(event, xy, is_typing, session_, view) ||
                       (!draws && flight_.handle(event, xy, session_, view));
  if (!is_mine && !draws && !objects_.is_placing() && !reliefs_.is_placing())
    layers_.handle(event, xy, session_, view);
  if (is_mine && event.kind == Event::Kind::kRelease) session_.release();
  return is_mine;
}

void ExploreWindow::take_drawing_actions() {
  drawing_.update_history();
  const DrawingActions actions = drawing_.take_actions();
  if (!actions.message.empty()) show_message(actions.message, actions.message_is_error);
  if (actions.saves_project) save_project();
  if (actions.restore) restore_drawings(*actions.restore);
}

explore::Project ExploreWindow::project() const {
  explore::Project project;
  project.planet = setup_.planet_file;
  project.pose = session_.pose();
  project.fov_deg = session_.screen().fov_deg;
  project.drawn_by = state_.drawn_by;
  project.panels = state_.panels;
  project.large_map = state_.large_map;
  project.map_style = state_.map_style;
  project.settings = changed_settings(session_.settings(), setup_.preferences.draw_budget_ms);
  project.regions.assign(session_.interest().begin(), session_.interest().end());
  project.bookmarks.assign(project_bookmarks_.all().begin(), project_bookmarks_.all().end());
  for (const auto& drawing : drawing_.drawings().all()) project.drawings.push_back(*drawing);
  project.hotspots = setup_.hotspots_file;
  if (const explore::FlightEditor* editor = session_.flights().editor(); editor != nullptr) {
    if (!setup_.flight_file.empty() && !editor->is_changed())
      project.flight = whole_path(setup_.flight_file);
    else
      project.flight_text = editor->flight();
  }
  return project;
}

void ExploreWindow::save_project() {
  try {
    const fs::path file = has_project() ? project_file_ : new_file(setup_.folder, "", ".vpeproj");
    const explore::Project saved = project();
    explore::save_project(saved, file);
    project_file_ = file;
    drawing_.drawings().mark_saved();
    project_bookmarks_.mark_saved();
    if (saved.flight_text) session_.flights().editor()->mark_saved();
    show_message("project: " + file.string());
  } catch (const std::exception& e) {
    show_message(e.what(), true);
  }
}

// Returns the text of a copy: the project with what is being drawn.
std::string ExploreWindow::project_text() const {
  explore::Project copy = project();
  if (auto unfinished = drawing_.sketch().unfinished_drawing()) copy.drawings.push_back(std::move(*unfinished));
  return explore::to_text(copy, drawing_copy_.file().parent_path());
}

void ExploreWindow::keep_drawings() {
  if (now_s() - drawings_kept_s_ < kKeepDrawings_s) return;
  const explore::Drawings& drawings = drawing_.drawings();
  const std::size_t unfinished = drawing_.sketch().unfinished().size();
  const explore::UnsavedCopy::State state{drawings.revision() * 1'000'003 + project_bookmarks_.revision(),
                                          drawings.saves(), unfinished};
  const bool is_unsaved = drawings.is_changed() || project_bookmarks_.is_changed() || unfinished > 1;
  const std::string problem = drawing_copy_.update(state, is_unsaved, [&] {
    drawings_kept_s_ = now_s();
    return project_text();
  });
  if (!problem.empty()) show_message(problem, true);
}

void ExploreWindow::keep_scene() {
  if (objects_.update(now_s(), !maker_->is_idle())) frames_due_ = std::max(frames_due_, 1);
  const ObjectsActions actions = objects_.take_actions();
  if (!actions.message.empty()) show_message(actions.message, actions.message_is_error);
}

void ExploreWindow::restore_drawings(const fs::path& copy) {
  try {
    explore::ParsedProject parsed = explore::load_project(copy);
    if (!parsed.project) throw std::runtime_error(parsed.errors.front());
    const std::size_t count = parsed.project->drawings.size();
    const std::string problem =
        drawing_.drawings().add_all(std::move(parsed.project->drawings), "restore drawings");
    if (!problem.empty()) throw std::runtime_error(problem);
    for (const explore::Bookmark& bookmark : parsed.project->bookmarks)
      if (has_project() && !project_bookmarks_.put(bookmark).empty()) break;
    drawing_copy_.adopt(copy);
    show_message(std::to_string(count) + " drawings are restored");
  } catch (const std::exception& e) {
    show_message(e.what(), true);
  }
  drawing_.offer(drawing_copy_.abandoned());
}

std::string ExploreWindow::drawings_message() {
  if (auto unfinished = drawing_.sketch().unfinished_drawing()) {
    drawing_.sketch().choose(std::nullopt);
    (void)drawing_.drawings().add(std::move(*unfinished));
  }
  if (!drawing_.drawings().is_changed() && !project_bookmarks_.is_changed()) return {};
  const fs::path file = new_file(setup_.folder, "unsaved-", ".vpeproj");
  try {
    explore::save_project(project(), file);
    drawing_.drawings().mark_saved();
    project_bookmarks_.mark_saved();
    drawings_kept_s_ = -1e9;
    keep_drawings();
    return "the drawings were not saved; 'vpe explore " + file.string() + "' opens a copy";
  } catch (const std::exception& e) {
    return std::string("the drawings were not saved: ") + e.what() + "; a copy is in " +
           drawing_copy_.file().string();
  }
}

std::string ExploreWindow::act_on_project_bookmark(const explore::Action& action) {
  const std::string number = std::to_string(action.number);
  if (action.kind == explore::ActionKind::kSetBookmark) {
    const std::string problem =
        project_bookmarks_.put({action.number, {session_.pose(), session_.screen().fov_deg}, "view " + number});
    if (problem.empty()) show_message("bookmark " + number + " of the project is set");
    return problem;
  }
  const auto found = project_bookmarks_.at_key(action.number);
  if (!found) {
    show_message("bookmark " + number + " of the project is not set; Ctrl+" + number + " sets it");
    return {};
  }
  session_.set_fov(found->view.fov_deg);
  session_.go(found->view.pose);
  show_message("bookmark " + number + ": " + found->name);
  return {};
}

}  // namespace vpe::window
