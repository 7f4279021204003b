#include "vpe/window/layers/layers_panel.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "vpe/window/panels/file_names.h"
#include "vpe/window/ui/imgui_helpers.h"

namespace vpe::window {

namespace {

constexpr const char* kFilesKey = "overlay.layers";
constexpr const char* kImagesKey = "image.layers";

std::string count_text(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " feature" : " features");
}

}  // namespace

LayersPanel::LayersPanel(double radius_m, std::function<void()> notify)
    : loader_(radius_m, std::move(notify)) {}

void LayersPanel::report(const std::string& problem) {
  if (problem.empty()) return;
  actions_ = {problem, true};
}

void LayersPanel::set(explore::Session& session, const char* key, const std::string& text) {
  if (session.settings().get(key).value_or("") != text) report(session.set(key, text));
}

bool LayersPanel::is_shown() const { return ImGui::GetFrameCount() - shown_frame_ <= 1; }

bool LayersPanel::update(const explore::Session& session) {
  files_ = explore::rows_of(files_, session.settings().get(kFilesKey).value_or(""));
  std::vector<std::string> paths;
  for (const auto& row : files_) paths.push_back(row.item.path);
  loader_.want(paths);
  const bool is_new = loader_.update();
  std::string readable = readable_setting();
  if (readable == readable_ && loaded_ == loader_.revision()) return is_new;
  readable_ = std::move(readable);
  loaded_ = loader_.revision();
  ++revision_;
  return true;
}

std::string LayersPanel::readable_setting() const {
  std::vector<core::LayerFile> readable;
  for (const core::LayerFile& file : explore::items_on(files_)) {
    const LoadedFile* loaded = loader_.find(file.path);
    if (loaded != nullptr && loaded->state == LoadedFile::State::kRead) readable.push_back(file);
  }
  return core::layer_list_text(readable);
}

std::vector<explore::MapLayer> LayersPanel::map_layers() const {
  std::vector<explore::MapLayer> layers;
  for (const core::LayerFile& file : explore::items_on(files_)) {
    const LoadedFile* loaded = loader_.find(file.path);
    if (loaded == nullptr) continue;
    for (const auto& one : loaded->layers) {
      layers.push_back(
          {{one, &one->layer()},
           [one](std::uint32_t feature) -> const mars::FeatureStyle& { return one->style(feature); },
           file.opacity});
    }
  }
  return layers;
}

void LayersPanel::add(const std::string& path, explore::Session& session) {
  std::error_code failed;
  const std::filesystem::path whole = std::filesystem::absolute(in_home(path), failed);
  const std::string file = failed ? path : whole.lexically_normal().string();
  explore::FileRows rows = files_;
  std::string problem = explore::add_file(rows, file);
  if (problem.empty()) problem = session.set(kFilesKey, explore::setting_of(rows));
  if (!problem.empty()) return report(problem);
  files_ = std::move(rows);
  actions_ = {"layer: " + file, false};
}

void LayersPanel::draw(explore::Session& session, std::span<const std::string> image_layers, Widgets& widgets) {
  shown_frame_ = ImGui::GetFrameCount();
  begin_part("layers");
  if (widgets.header("Vector files", true)) {
    draw_files(session, widgets);
    draw_switches(session, widgets);
  }
  if (widgets.header("What was clicked", true)) draw_picked(session, widgets);
  if (widgets.header("Image layers", !image_layers.empty())) {
    images_ = explore::rows_of(images_, session.settings().get(kImagesKey).value_or(""), image_layers);
    draw_images(session, image_layers, widgets);
  }
  ImGui::EndChild();
}

// The topmost layer is the first row.
void LayersPanel::draw_files(explore::Session& session, Widgets& widgets) {
  ImGui::SetNextItemWidth(-ImGui::GetFontSize() * 3);
  const bool entered = widgets.text(
      "##layer file", file_, "a vector file: .gpkg .geojson .shp .kml .kmz .gpx .csv; ~/ is the home folder",
      "units.gpkg");
  ImGui::SameLine();
  const bool adds =
      widgets.button("Add##layer", "shows the file on the ground; files may also be dropped on the window");
  if ((entered || adds) && !file_.empty()) {
    add(file_, session);
    if (!actions_.message_is_error) file_.clear();
  }
  if (files_.empty()) draw_hint("No vector files: enter a path, or drop a file on the window.");
  explore::FileRows next = files_;
  std::string reload;
  for (std::size_t n = next.size(); n-- > 0;) {
    const std::string path = next[n].item.path;
    ImGui::PushID(path.c_str());
    widgets.group("layer " + std::filesystem::path(path).filename().string());
    const RowAct act = draw_file(next[n], n + 1 == next.size(), n == 0, widgets);
    widgets.group("");
    ImGui::PopID();
    if (act == RowAct::kReload) reload = path;
    if (act == RowAct::kUp || act == RowAct::kDown) explore::move_by_one(next, n, act == RowAct::kUp);
    if (act == RowAct::kRemove) next.erase(next.begin() + static_cast<std::ptrdiff_t>(n));
    if (act != RowAct::kNone) break;
  }
  if (!reload.empty()) loader_.reload(reload);
  if (next == files_) return;
  files_ = std::move(next);
  set(session, kFilesKey, explore::setting_of(files_));
}

LayersPanel::RowAct LayersPanel::draw_file(explore::Switched<core::LayerFile>& row, bool is_top, bool is_bottom,
                                           Widgets& widgets) {
  RowAct act = RowAct::kNone;
  const auto button = [&](const char* label, const char* tip, bool is_off, RowAct meaning) {
    ImGui::BeginDisabled(is_off);
    if (widgets.button(label, tip)) act = meaning;
    ImGui::EndDisabled();
  };
  button("\u2191", "up: above the next layer", is_top, RowAct::kUp);
  ImGui::SameLine();
  button("\u2193", "down: below the next layer", is_bottom, RowAct::kDown);
  ImGui::SameLine();
  if (widgets.check("##on", row.is_on, "shows or hides the layer")) act = RowAct::kChanged;
  ImGui::SameLine();
  ImGui::TextUnformatted(std::filesystem::path(row.item.path).filename().string().c_str());
  widgets.tip(row.item.path.c_str());
  const LoadedFile* loaded = loader_.find(row.item.path);
  const LoadedFile::State state = loaded == nullptr ? LoadedFile::State::kWaits : loaded->state;
  ImGui::BeginDisabled(!row.is_on);
  ImGui::SetNextItemWidth(ImGui::GetFontSize() * 6);
  double percent = row.item.opacity * 100;
  if (widgets.slide("##opacity", percent, 0, 100, "%.0f %%", false, "opacity")) {
    row.item.opacity = std::round(percent) / 100;
    act = RowAct::kChanged;
  }
  ImGui::EndDisabled();
  ImGui::SameLine();
  button("\u21ba", "reads the file anew", state == LoadedFile::State::kWaits, RowAct::kReload);
  ImGui::SameLine();
  button("x", "removes the layer; the file stays", false, RowAct::kRemove);
  ImGui::SameLine();
  if (state == LoadedFile::State::kRead)
    ImGui::TextDisabled("%s", count_text(loaded->features).c_str());
  else if (state == LoadedFile::State::kWaits)
    ImGui::TextDisabled("is read \u2026");
  else
    ImGui::NewLine();
  if (state == LoadedFile::State::kFailed) coloured(kErrorColour, loaded->error);
  return act;
}

void LayersPanel::draw_switches(explore::Session& session, Widgets& widgets) {
  const auto on = [&](const char* key, const char* value) {
    return session.settings().get(key).value_or("") == value;
  };
  bool dashes = on("overlay.layers.hidden", "dashed");
  if (widgets.check("Hidden parts dashed", dashes, "lines behind ground are dashed; else they are left out"))
    set(session, "overlay.layers.hidden", dashes ? "dashed" : "off");
  bool has_legend = on("overlay.layers.legend", "on");
  if (widgets.check("Legend##layers", has_legend, "what colours and patterns of the layers stand for"))
    set(session, "overlay.layers.legend", has_legend ? "on" : "off");
}

}  // namespace vpe::window
