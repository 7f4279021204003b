#include "vpe/window/panels/file_panel.h"

#include <algorithm>
#include <utility>

#include "vpe/explore/files/planet_files.h"

namespace vpe::window {

namespace {

template <std::size_t N>
std::vector<std::string> names_of(const std::array<MadeSize, N>& sizes) {
  std::vector<std::string> names;
  for (const MadeSize& size : sizes) names.emplace_back(size.name);
  return names;
}

void begin_row(const std::string& title) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(title.c_str());
  ImGui::SameLine(ImGui::GetFontSize() * 7);
}

// Draws how far work is, and a button; a negative share is not known. Returns true if the button was pressed.
bool draw_progress(double fraction, const std::string& text, const std::string& id, Widgets& widgets) {
  ImGui::ProgressBar(static_cast<float>(std::max(fraction, 0.0)), {-ImGui::GetFontSize() * 4, 0},
                     fraction < 0 ? "..." : nullptr);
  widgets.tip(text.c_str());
  ImGui::SameLine();
  return widgets.button(("Stop" + id).c_str(), "finished frames and parts are kept");
}

bool is_panorama(const std::filesystem::path& file) {
  return file.filename().string().starts_with("vpe-panorama-");
}

}  // namespace

void FilePanel::add_recent(const std::string& file) {
  if (file.empty()) return;
  std::erase(recent_, file);
  recent_.insert(recent_.begin(), file);
  if (recent_.size() > kMostRecent) recent_.resize(kMostRecent);
}

void FilePanel::focus() {
  takes_focus_ = true;
  std::vector<std::filesystem::path> folders{folder_.empty() ? "." : folder_};
  for (const std::string& file : recent_) {
    const std::filesystem::path path(file);
    if (path.extension() == ".vpe") folders.push_back(path.parent_path());
  }
  planets_ = explore::planet_files(folders);
}

FileActions FilePanel::draw(const ViewArea& area, double scale, const explore::Session& session, FileWork work,
                            Widgets& widgets) {
  FileActions actions;
  const double width = std::min(area.width, 460 * scale);
  ImGui::SetNextWindowPos(
      at(area.x + (area.width - width) / 2, area.y + std::min(40 * scale, area.height / 8)));
  ImGui::SetNextWindowSizeConstraints(at(width, 0), at(width, area.height * 0.8));
  ImGui::Begin("files", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize);
  widgets.group("file");
  if (widgets.button("Close", "Esc or Ctrl+O")) actions.closes = true;
  ImGui::SameLine();
  if (widgets.button("Preferences", "mouse, speeds, devices")) actions.opens_preferences = true;
  draw_open(actions, widgets);
  draw_planets(actions, widgets);
  ImGui::Separator();
  draw_make(session, work.jobs.can_start(), actions, widgets);
  if (work.planet || !work.jobs.entries().empty()) {
    ImGui::Separator();
    draw_work(work, actions, widgets);
  }
  widgets.group("");
  ImGui::End();
  return actions;
}

void FilePanel::draw_open(FileActions& actions, Widgets& widgets) {
  if (refused_) widgets.refuse("##open", *std::exchange(refused_, std::nullopt));
  if (std::exchange(takes_focus_, false)) ImGui::SetKeyboardFocusHere();
  ImGui::SetNextItemWidth(-ImGui::GetFontSize() * 4);
  const bool is_entered = widgets.text(
      "##open", name_, "a planet file, DEM, flight, project or panorama; ~/ is your folder. Or drop it here.",
      "file to open");
  ImGui::SameLine();
  if ((widgets.button("Open") || is_entered) && !name_.empty()) actions.open = std::exchange(name_, {});
  for (std::size_t n = 0; n < recent_.size(); ++n) {
    const std::string label =
        std::filesystem::path(recent_[n]).filename().string() + "##recent " + std::to_string(n);
    if (widgets.button(label.c_str(), recent_[n].c_str())) actions.open = recent_[n];
  }
}

void FilePanel::draw_planets(FileActions& actions, Widgets& widgets) {
  ImGui::SetNextItemWidth(-ImGui::GetFontSize() * 4);
  std::vector<std::string> names{"the embedded Mars"};
  // Folders may have files of one name.
  for (std::size_t n = 0; n < planets_.size(); ++n)
    names.push_back(planets_[n].filename().string() + "##" + std::to_string(n));
  int chosen = -1;
  if (!widgets.choose("##Planets", chosen, names,
                      "those beside the files opened last, and in the present folder", "choose a planet"))
    return;
  if (chosen == 0)
    actions.planet = std::filesystem::path();
  else if (chosen > 0)
    actions.planet = planets_[static_cast<std::size_t>(chosen) - 1];
}

void FilePanel::draw_make(const explore::Session& session, bool can_make, FileActions& actions,
                          Widgets& widgets) {
  static const std::vector<std::string> kImages = names_of(kImageSizes);
  static const std::vector<std::string> kFilms = names_of(kFilmSizes);
  static const std::vector<std::string> kPanoramas = names_of(kPanoramaSizes);
  ImGui::BeginDisabled(!can_make);
  const auto row = [&](const char* label, const char* tip, const char* id, int& size,
                       const std::vector<std::string>& names) {
    const bool pressed = widgets.button(label, tip);
    ImGui::SameLine(ImGui::GetFontSize() * 12);
    ImGui::SetNextItemWidth(ImGui::GetFontSize() * 9);
    widgets.choose(id, size, names);
    return pressed;
  };
  const auto make = [&](MadeKind kind, const MadeSize& size) {
    actions.make = MakeRequest{kind, size, has_overlays_};
  };
  if (row("Save image", "an image of this view, in full quality", "##image size", image_size_, kImages))
    make(MadeKind::kImage, kImageSizes[static_cast<std::size_t>(image_size_)]);
  const bool has_flight = session.flights().editor() != nullptr;
  ImGui::BeginDisabled(!has_flight);
  if (row("Make film", "a film of the flight that is open", "##film size", film_size_, kFilms))
    make(MadeKind::kFilm, kFilmSizes[static_cast<std::size_t>(film_size_)]);
  ImGui::EndDisabled();
  if (row("Panorama from here", "all around the camera", "##panorama size", panorama_size_, kPanoramas))
    make(MadeKind::kPanorama, kPanoramaSizes[static_cast<std::size_t>(panorama_size_)]);
  widgets.check("with overlays", has_overlays_, "names, scale, grid and the others that are switched on");
  ImGui::EndDisabled();
  if (!has_flight) ImGui::TextDisabled("A film needs a flight: add waypoints in Flight, or record one.");
}

void FilePanel::draw_work(FileWork work, FileActions& actions, Widgets& widgets) {
  JobList& jobs = work.jobs;
  std::optional<std::size_t> removed;
  if (work.planet) {
    begin_row("planet");
    if (draw_progress(*work.planet, "the complete planet replaces this one", "##planet", widgets))
      actions.stops_planet = true;
  }
  for (std::size_t n = 0; n < jobs.entries().size(); ++n) {
    const JobList::Entry& entry = jobs.entries()[n];
    const std::string id = "##job " + std::to_string(n);
    begin_row(entry.order.title);
    if (entry.job != nullptr) {
      if (draw_progress(entry.state.fraction, entry.state.text, id, widgets)) jobs.stop(n);
      continue;
    }
    if (entry.is_stopped) {
      ImGui::TextDisabled("stopped");
    } else if (entry.state.failed) {
      coloured(kErrorColour, entry.state.text);
    } else {
      ImGui::TextUnformatted(entry.order.file.filename().c_str());
      widgets.tip(entry.order.file.c_str());
      if (is_panorama(entry.order.file)) {
        ImGui::SameLine();
        if (widgets.button(("Look around" + id).c_str(), "in a window of its own"))
          actions.look_around = entry.order.file;
      }
    }
    ImGui::SameLine();
    if (widgets.button(("x" + id).c_str(), "forget this line; the file stays")) removed = n;
  }
  if (removed) jobs.remove(*removed);
}

}  // namespace vpe::window
