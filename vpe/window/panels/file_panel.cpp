#include "vpe/window/panels/file_panel.h"

#include <algorithm>
#include <utility>

namespace vpe::window {

namespace {

template <std::size_t N>
std::vector<std::string> names_of(const std::array<MadeSize, N>& sizes) {
  std::vector<std::string> names;
  for (const MadeSize& size : sizes) names.emplace_back(size.name);
  return names;
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

FileActions FilePanel::draw(const ViewArea& area, double scale, const explore::Session& session, JobList& jobs,
                            Widgets& widgets) {
  FileActions actions;
  const double width = std::min(area.width, 460 * scale);
  ImGui::SetNextWindowPos(at(area.x + (area.width - width) / 2, area.y + std::min(40 * scale, area.height / 8)));
  ImGui::SetNextWindowSizeConstraints(at(width, 0), at(width, area.height * 0.8));
  ImGui::Begin("files", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize);
  widgets.group("file");
  if (widgets.button("Close", "Esc or Ctrl+O")) actions.closes = true;
  draw_open(actions, widgets);
  ImGui::Separator();
  draw_make(session, jobs.can_start(), actions, widgets);
  if (!jobs.entries().empty()) {
    ImGui::Separator();
    draw_jobs(jobs, actions, widgets);
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
      "##open", name_, "a planet file, DEM, flight, project or panorama; ~/ is your folder. Or drop it here.");
  ImGui::SameLine();
  if ((widgets.button("Open") || is_entered) && !name_.empty()) actions.open = name_;
  for (std::size_t n = 0; n < recent_.size(); ++n) {
    const std::string label =
        std::filesystem::path(recent_[n]).filename().string() + "##recent " + std::to_string(n);
    if (widgets.button(label.c_str(), recent_[n].c_str())) actions.open = recent_[n];
  }
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

void FilePanel::draw_jobs(JobList& jobs, FileActions& actions, Widgets& widgets) {
  std::optional<std::size_t> removed;
  for (std::size_t n = 0; n < jobs.entries().size(); ++n) {
    const JobList::Entry& entry = jobs.entries()[n];
    const std::string id = "##job " + std::to_string(n);
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(entry.title.c_str());
    ImGui::SameLine(ImGui::GetFontSize() * 7);
    if (entry.job != nullptr) {
      ImGui::ProgressBar(static_cast<float>(std::max(entry.state.fraction, 0.0)), {-ImGui::GetFontSize() * 4, 0},
                         entry.state.fraction < 0 ? "..." : nullptr);
      widgets.tip(entry.state.text.c_str());
      ImGui::SameLine();
      if (widgets.button(("Stop" + id).c_str(), "finished frames and parts are kept")) jobs.stop(n);
      continue;
    }
    if (entry.is_stopped) {
      ImGui::TextDisabled("stopped");
    } else if (entry.state.failed) {
      coloured(kErrorColour, entry.state.text);
    } else {
      ImGui::TextUnformatted(entry.result.filename().c_str());
      widgets.tip(entry.result.c_str());
      if (is_panorama(entry.result)) {
        ImGui::SameLine();
        if (widgets.button(("Look around" + id).c_str(), "in a window of its own"))
          actions.look_around = entry.result;
      }
    }
    ImGui::SameLine();
    if (widgets.button(("x" + id).c_str(), "forget this line; the file stays")) removed = n;
  }
  if (removed) jobs.remove(*removed);
}

}  // namespace vpe::window
