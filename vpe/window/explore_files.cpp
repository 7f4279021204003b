// Files that the explore window opens, and images, films and panoramas that it has made.
#include <algorithm>
#include <exception>
#include <stdexcept>
#include <utility>

#include "mars/vector/vector_file.h"
#include "relief/files/relief_file.h"
#include "vpe/base/file.h"
#include "vpe/base/number.h"
#include "vpe/explore/command_words.h"
#include "vpe/window/explore_window.h"
#include "vpe/window/panels/file_names.h"

namespace vpe::window {

namespace fs = std::filesystem;

namespace {

bool is_image_of_panorama(const fs::path& file) {
  const std::string extension = file.extension().string();
  return extension == ".json" || extension == ".jpg" || extension == ".jpeg" || extension == ".png";
}

JobList::Order shown_panorama(const fs::path& file) {
  return {JobKind::kShows, "panorama", {"overlook", file.string()}, file, {}};
}

}  // namespace

void ExploreWindow::draw_files() {
  const std::optional<double> planet =
      finer_.is_making() && !finer_.is_stopped() ? std::optional(finer_.fraction()) : std::nullopt;
  const FileActions actions = files_.draw(view_area_, display_.scale(), session_, {jobs_, planet}, widgets_);
  if (actions.closes) state_.files = false;
  if (actions.opens_preferences) {
    state_.preferences = true;
    state_.files = false;
  }
  if (actions.open) open_file(*actions.open);
  if (actions.planet) open_planet(*actions.planet, {});
  if (actions.make) make(*actions.make);
  if (actions.look_around) start_job(shown_panorama(*actions.look_around));
  if (actions.stops_planet) finer_.stop();
}

void ExploreWindow::draw_preferences() {
  take(window::draw_preferences(view_area_, display_.scale(), setup_.preferences, widgets_));
}

void ExploreWindow::take(const PreferencesActions& actions) {
  if (actions.closes) state_.preferences = false;
  if (!actions.error.empty()) show_message(actions.error, true);
  if (!actions.changed) return;
  use(*actions.changed);
  if (setup_.preferences_file.empty()) return;
  if (const std::string error = explore::save(setup_.preferences, setup_.preferences_file); !error.empty())
    show_message(error, true);
}

void ExploreWindow::use(const explore::Preferences& preferences) {
  // A time of a frame that was set by hand stays.
  if (session_.settings().values().lod_frame_ms == setup_.preferences.draw_budget_ms)
    (void)session_.set("lod.frame_ms", base::format_number(preferences.draw_budget_ms));
  setup_.preferences = preferences;
  session_.set_mouse(explore::mouse_choices(preferences));
  for (const std::string& error : devices_.use(preferences, now_s())) show_message(error, true);
}

void ExploreWindow::open_file(const std::string& name) {
  const fs::path file = in_home(name);
  std::error_code unknown;
  if (!fs::exists(file, unknown)) {
    files_.refuse(name);
    return show_message(name + ": there is no such file", true);
  }
  const fs::path whole = fs::absolute(file).lexically_normal();
  if (whole.extension() == ".flight") return open_flight(whole);
  if (explore::is_project_file(whole.string())) return open_project_file(whole);
  if (relief::is_relief_path(whole)) {
    files_.add_recent(whole.string());
    return reliefs_.open(whole);
  }
  if (whole.extension() == ".toml") {
    files_.add_recent(whole.string());
    return objects_.open(whole, session_);
  }
  if (is_image_of_panorama(whole)) {
    files_.add_recent(whole.string());
    return start_job(shown_panorama(whole));
  }
  if (mars::has_vector_extension(whole.string())) return layers_.add(whole.string(), session_);
  open_planet(whole, {});
}

void ExploreWindow::open_planet(const fs::path& file, const fs::path& project) {
  const std::string name = file.empty() ? "the embedded Mars" : file.string();
  std::string error;
  if (jobs_.can_start() && setup_.builds_first && setup_.builds_first(file.string())) {
    std::vector<std::string> words{"info"};
    if (!file.empty()) words.push_back(file.string());
    const std::string title = file.empty() ? "planet" : file.filename().string();
    error = jobs_.start({JobKind::kBuilds, title, std::move(words), file, project});
  } else {
    error = opener_.start(file.string());
    opening_project_ = error.empty() ? project : opening_project_;
  }
  if (!error.empty()) return show_message(error, true);
  files_.add_recent(project.empty() ? file.string() : project.string());
  show_message("opening " + (project.empty() ? name : project.string()));
}

void ExploreWindow::open_flight(const fs::path& file) {
  const FlightActions actions = flight_.open_file(file.string(), session_);
  if (!actions.message_is_error) files_.add_recent(file.string());
  show_message(actions.message, actions.message_is_error);
}

// The project takes effect when its planet is open, in a window of its own.
void ExploreWindow::open_project_file(const fs::path& file) {
  try {
    const explore::ParsedProject parsed = explore::load_project(file.string());
    if (!parsed.errors.empty()) throw std::runtime_error(parsed.errors.front());
    open_planet(parsed.project->planet, file);
  } catch (const std::exception& e) {
    show_message(e.what(), true);
  }
}

// Returns why the session cannot be made into a file, or "": commands make it, which read files.
std::string ExploreWindow::why_not_made(bool is_film) {
  if (objects_.editor().is_changed())
    return "save the scene first (panel Objects): images and films are made of its file";
  if (reliefs_.reliefs() && !is_film)
    return "images are made of the planet's file: put the reliefs into a planet first (panel Ground); F12 saves the "
           "image of the window";
  return {};
}

explore::MakeOptions ExploreWindow::make_options() const {
  explore::MakeOptions options;
  options.planet = setup_.planet_file.string();
  options.backend = core::named_backend(state_.drawn_by);
  options.stereo = state_.stereo;
  options.eye_base_m = state_.eye_base_m;
  options.convergence_m = state_.convergence_m;
  return options;
}

void ExploreWindow::make(const MakeRequest& request) {
  if (const std::string why = why_not_made(request.kind == MadeKind::kFilm); !why.empty())
    return show_message(why, true);
  explore::MakeOptions options = make_options();
  options.width_px = request.size.width_px;
  options.height_px = request.size.height_px;
  options.has_overlays = request.has_overlays;
  switch (request.kind) {
    case MadeKind::kImage: {
      const fs::path file = new_file(setup_.folder, "image-", ".png");
      options.output = file.string();
      return start_job({JobKind::kMakes, "image", explore::image_words(session_, options), file, {}});
    }
    case MadeKind::kPanorama: {
      const fs::path file = new_file(setup_.folder, "panorama-", ".jpg");
      options.output = file.string();
      return start_job({JobKind::kMakes, "panorama", explore::panorama_words(session_, options), file, {}});
    }
    case MadeKind::kFilm: break;
  }
  const explore::FlightEditor* editor = session_.flights().editor();
  if (editor == nullptr) return show_message("there is no flight to make a film of", true);
  // The film keeps the flight that it was made of.
  const fs::path file = new_file(setup_.folder, "film-", ".mp4");
  const fs::path flight = fs::path(file).replace_extension(".flight");
  try {
    base::write_file(flight, editor->to_text());
  } catch (const std::exception& e) {
    return show_message(e.what(), true);
  }
  options.output = file.string();
  start_job({JobKind::kMakes, "film", explore::film_words(session_, flight.string(), options), file, {}});
}

void ExploreWindow::start_job(JobList::Order order) {
  const std::string made = order.kind == JobKind::kMakes ? order.file.string() : "";
  if (const std::string error = jobs_.start(std::move(order)); !error.empty()) return show_message(error, true);
  if (!made.empty()) show_message("making " + made);
}

void ExploreWindow::update_jobs() {
  jobs_asked_s_ = now_s();
  const std::vector<std::size_t> ended = jobs_.update();
  for (auto n = ended.rbegin(); n != ended.rend(); ++n) {
    finish_job(jobs_.entries()[*n]);
    if (jobs_.entries()[*n].order.kind != JobKind::kMakes) jobs_.remove(*n);
  }
  if (state_.files) frames_due_ = std::max(frames_due_, 1);
}

void ExploreWindow::finish_job(const JobList::Entry& entry) {
  const JobList::Order& order = entry.order;
  if (entry.is_stopped) return show_message(order.title + ": stopped");
  if (entry.state.failed) return show_message(entry.state.text, true);
  if (order.kind == JobKind::kMakes) return show_message(order.title + ": " + order.file.string());
  if (order.kind != JobKind::kBuilds) return;
  if (const std::string error = opener_.start(order.file.string()); !error.empty())
    return show_message(error, true);
  opening_project_ = order.project;
}

std::vector<std::vector<std::string>> ExploreWindow::unfinished() const {
  std::vector<std::vector<std::string>> commands;
  for (const JobList::Entry& entry : jobs_.entries())
    if (entry.job != nullptr && entry.order.kind != JobKind::kShows) commands.push_back(entry.order.words);
  return commands;
}

}  // namespace vpe::window
