// Files that the explore window opens, and images, films and panoramas that it has made.
#include <algorithm>
#include <exception>
#include <stdexcept>
#include <utility>

#include "vpe/base/file.h"
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

}  // namespace

void ExploreWindow::draw_files() {
  const FileActions actions = files_.draw(view_area_, display_.scale(), session_, jobs_, widgets_);
  if (actions.closes) state_.files = false;
  if (actions.open) open_file(*actions.open);
  if (actions.make) make(*actions.make);
  if (actions.look_around) start_job("panorama", {"overlook", actions.look_around->string()}, {});
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
  if (is_image_of_panorama(whole)) {
    files_.add_recent(whole.string());
    return start_job("panorama", {"overlook", whole.string()}, {});
  }
  const std::string error = opener_.start(whole.string());
  if (!error.empty()) return show_message(error, true);
  files_.add_recent(whole.string());
  show_message("opening " + opener_.file() + "; other files than planet files are converted first");
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
    if (const std::string error = opener_.start(parsed.project->planet.string()); !error.empty())
      throw std::runtime_error(error);
    opening_project_ = file;
    files_.add_recent(file.string());
    show_message("opening " + file.string());
  } catch (const std::exception& e) {
    show_message(e.what(), true);
  }
}

void ExploreWindow::make(const MakeRequest& request) {
  explore::MakeOptions options;
  options.planet = setup_.planet_file.string();
  options.width_px = request.size.width_px;
  options.height_px = request.size.height_px;
  options.has_overlays = request.has_overlays;
  options.backend = core::named_backend(state_.drawn_by);
  options.stereo = state_.stereo;
  options.eye_base_m = state_.eye_base_m;
  switch (request.kind) {
    case MadeKind::kImage: {
      const fs::path file = new_file(setup_.folder, "image-", ".png");
      options.output = file.string();
      return start_job("image", explore::image_words(session_, options), file);
    }
    case MadeKind::kPanorama: {
      const fs::path file = new_file(setup_.folder, "panorama-", ".jpg");
      options.output = file.string();
      return start_job("panorama", explore::panorama_words(session_, options), file);
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
  start_job("film", explore::film_words(session_, flight.string(), options), file);
}

void ExploreWindow::start_job(std::string title, const std::vector<std::string>& words, const fs::path& result) {
  if (const std::string error = jobs_.start(std::move(title), words, result); !error.empty())
    return show_message(error, true);
  if (!result.empty()) show_message("making " + result.string());
}

void ExploreWindow::update_jobs() {
  jobs_asked_s_ = now_s();
  const std::vector<std::size_t> ended = jobs_.update();
  for (auto n = ended.rbegin(); n != ended.rend(); ++n) {
    const JobList::Entry& entry = jobs_.entries()[*n];
    if (entry.is_stopped) {
      show_message(entry.title + ": stopped");
    } else if (entry.state.failed) {
      show_message(entry.state.text, true);
    } else if (!entry.result.empty()) {
      show_message(entry.title + ": " + entry.result.string());
    }
    if (entry.result.empty()) jobs_.remove(*n);  // a window, which was closed
  }
  if (state_.files) frames_due_ = std::max(frames_due_, 1);
}

std::vector<std::vector<std::string>> ExploreWindow::unfinished() const {
  std::vector<std::vector<std::string>> commands;
  for (const JobList::Entry& entry : jobs_.entries())
    if (entry.job != nullptr && !entry.result.empty()) commands.push_back(entry.words);
  return commands;
}

}  // namespace vpe::window
