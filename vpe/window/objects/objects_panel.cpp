#include "vpe/window/objects/objects_panel.h"

#include <algorithm>
#include <array>

#include "objects/files/model_file.h"
#include "objects/files/scene_limits.h"
#include "vpe/base/number.h"
#include "vpe/explore/measure/read_out.h"
#include "vpe/window/objects/object_marks.h"
#include "vpe/window/ui/imgui_helpers.h"

namespace vpe::window {

using explore::SceneItem;
using explore::SharedItem;
using objects::HeightKind;
using objects::Placing;

ObjectsPanel::ObjectsPanel(explore::ModelBall measure, std::filesystem::path folder,
                           const std::filesystem::path& state, std::function<void()> notify)
    : sizes_(std::move(measure), std::move(notify)),
      folder_(std::move(folder)),
      copy_(state.empty() ? (folder_.empty() ? std::filesystem::path(".") : folder_) : state, ".scene.toml",
            "scene"),
      abandoned_(copy_.abandoned()) {}

void ObjectsPanel::report(const std::string& problem) {
  if (!problem.empty()) actions_ = {problem, true};
}

void ObjectsPanel::tell(const std::string& text) { actions_ = {text, false}; }

void ObjectsPanel::select(std::uint64_t id) {
  selected_ = id;
  scrolls_to_selected_ = true;
}

void ObjectsPanel::draw(explore::Session& session, Widgets& widgets) {
  shown_frame_ = ImGui::GetFrameCount();
  follow_setting(session);
  begin_part("objects");
  draw_models(widgets);
  draw_tools(session, widgets);
  draw_list(session, widgets);
  draw_selected(session, widgets);
  if (clock_.can_play()) draw_time(widgets);
  draw_file(session, widgets);
  ImGui::EndChild();
}

// Draws the model of objects that are placed.
void ObjectsPanel::draw_models(Widgets& widgets) {
  std::vector<std::string> names;
  for (const objects::ModelEntry& model : editor_.models()) names.push_back(model.name);
  for (const objects::ModelEntry& model : typed_models_) names.push_back(model.name);
  model_ = std::clamp(model_, 0, std::max(0, static_cast<int>(names.size()) - 1));
  ImGui::SetNextItemWidth(-ImGui::GetFontSize() * 4);
  if (!names.empty()) widgets.choose("Model", model_, names, "the model that a click places");
  ImGui::SetNextItemWidth(-ImGui::GetFontSize() * 4);
  if (widgets.text("Add##model file", model_text_,
                   "a file of a model: glTF, OBJ, PLY, STL or .sticks; Enter makes it the one that is placed",
                   "file of another model"))
    take_model(model_text_);
}

void ObjectsPanel::draw_tools(explore::Session& session, Widgets& widgets) {
  const bool has_model = !editor_.models().empty() || !typed_models_.empty();
  ImGui::BeginDisabled(!has_model);
  if (widgets.toggle("Place", is_placing_,
                     "A click on the ground places an object, V in the middle of the view; Esc ends it."))
    follow_.reset();
  ImGui::EndDisabled();
  is_placing_ = is_placing_ && has_model;
  ImGui::SameLine();
  if (widgets.button("Undo##objects", ("Ctrl+Z: " + editor_.undo_text()).c_str())) editor_.undo();
  ImGui::SameLine();
  if (widgets.button("Redo##objects", ("Ctrl+Shift+Z: " + editor_.redo_text()).c_str())) editor_.redo();
  const SharedItem item = editor_.find(selected_);
  ImGui::SameLine();
  ImGui::BeginDisabled(item == nullptr);
  if (widgets.button("Delete##object", "Delete: the selected object")) report(editor_.remove(selected_));
  if (widgets.button("Go to##object", "fly to a view of it")) go_to(selected_, session);
  ImGui::SameLine();
  bool follows = follow_ && follow_->id == selected_;
  if (widgets.toggle(
          "Follow", follows,
          "the camera keeps its place beside the object; a drag turns about it, the wheel changes the "
          "distance, Esc ends it")) {
    if (follows)
      follow(selected_, session);
    else
      follow_.reset();
  }
  ImGui::EndDisabled();
  if (is_placing_)
    draw_hint("Click on the ground to place an object.");
  else if (follow_)
    draw_hint("Drag to look from elsewhere; Esc ends the following.");
  else if (!editor_.items().empty())
    draw_hint("Click an object in the view to select it, drag it to move it.");
  else
    draw_hint(has_model ? "Press Place, and click on the ground."
                        : "Enter the file of a model above, or open a scene file below.");
}

void ObjectsPanel::draw_list(explore::Session& session, Widgets& widgets) {
  begin_part("items", ImVec2(0, ImGui::GetTextLineHeightWithSpacing() * 7), true);
  const explore::SceneEditor::Items& all = editor_.items();
  const auto chosen =
      std::find_if(all.begin(), all.end(), [this](const SharedItem& item) { return item->id == selected_; });
  const float row_px = ImGui::GetTextLineHeightWithSpacing();
  if (std::exchange(scrolls_to_selected_, false) && chosen != all.end()) {
    const float at_px = row_px * static_cast<float>(chosen - all.begin());
    if (at_px < ImGui::GetScrollY() || at_px + row_px > ImGui::GetScrollY() + ImGui::GetWindowHeight())
      ImGui::SetScrollY(std::max(0.0F, at_px - ImGui::GetWindowHeight() / 2));
  }
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(all.size()));
  while (clipper.Step()) {
    for (int n = clipper.DisplayStart; n < clipper.DisplayEnd; ++n) {
      const SceneItem& item = *all[static_cast<std::size_t>(n)];
      const std::string title = explore::item_title(item, editor_.models());
      ImGui::PushID(static_cast<int>(item.id));
      if (ImGui::Selectable(title.c_str(), item.id == selected_, ImGuiSelectableFlags_AllowDoubleClick)) {
        selected_ = item.id;
        if (ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) go_to(item.id, session);
      }
      widgets.record("object " + title);
      if (!explore::item_name(item).empty()) {
        const std::string kind = explore::item_kind(item, editor_.models());
        ImGui::SameLine();
        ImGui::SetCursorPosX(std::max(ImGui::GetCursorPosX(),
                                      ImGui::GetContentRegionMax().x - ImGui::CalcTextSize(kind.c_str()).x));
        ImGui::TextDisabled("%s", kind.c_str());
      }
      ImGui::PopID();
    }
  }
  ImGui::EndChild();
}

void ObjectsPanel::draw_selected(explore::Session& session, Widgets& widgets) {
  const SharedItem item = editor_.find(selected_);
  if (item == nullptr) return;
  ImGui::PushID(static_cast<int>(item->id));
  std::string name = explore::item_name(*item);
  ImGui::SetNextItemWidth(-ImGui::GetFontSize() * 4);
  if (widgets.text("Name##object", name)) {
    const std::string problem = editor_.rename(item->id, name);
    if (!problem.empty()) widgets.refuse("Name##object", name);
    report(problem);
  }
  if (explore::single_placing(*item) != nullptr) {
    draw_placing(*item, session, widgets);
  } else if (const auto* path = std::get_if<objects::PathEntry>(&item->entry)) {
    const double seconds_s = path->points.back().time_s - path->points.front().time_s;
    ImGui::TextWrapped("%d points in %s s", static_cast<int>(path->points.size()),
                       base::format_significant(seconds_s, 6).c_str());
  } else if (const auto* scatter = std::get_if<objects::ScatterEntry>(&item->entry)) {
    ImGui::TextWrapped("%s of %s to %s m in %d corners, seed %s",
                       scatter->models.size() == 1 ? "One model" : "Models",
                       base::format_significant(scatter->least_diameter_m, 4).c_str(),
                       base::format_significant(scatter->most_diameter_m, 4).c_str(),
                       static_cast<int>(scatter->polygon.size()), std::to_string(scatter->seed).c_str());
  } else {
    ImGui::TextWrapped("%s", (explore::item_kind(*item, editor_.models()) + ", in one list").c_str());
  }
  if (explore::single_placing(*item) == nullptr)
    draw_hint("It is edited in the scene file; the window reads that again.");
  ImGui::PopID();
}

void ObjectsPanel::draw_placing(const SceneItem& item, const explore::Session& session, Widgets& widgets) {
  const Placing old = *explore::single_placing(item);
  Placing p = old;
  std::string what;
  const auto changed = [&what](bool has_changed, const char* edit) {
    if (has_changed) what = edit;
  };
  widgets.group("object");
  ImGui::PushItemWidth(ImGui::GetFontSize() * 10);
  changed(widgets.number("Longitude", p.place.lon_deg, -360, 360, 1e-5, "%.6f"), "move");
  changed(widgets.number("Latitude", p.place.lat_deg, -90, 90, 1e-5, "%.6f"), "move");
  changed(widgets.number("Heading", p.heading_deg, -360, 360, 5, "%.2f", "degrees clockwise from north"),
          "turn");
  changed(widgets.number("Pitch", p.pitch_deg, -360, 360, 1, "%.2f", "degrees up"), "turn");
  changed(widgets.number("Roll", p.roll_deg, -360, 360, 1, "%.2f", "degrees, the right side down"), "turn");
  changed(widgets.number("Scale", p.scale, 1e-6, objects::kScaleRange.most, 0.1, "%.4g"), "scale");
  const bool is_altitude = p.height_kind == HeightKind::kAltitude;
  changed(widgets.number(is_altitude ? "Altitude (m)" : "Height (m)", p.height_m, objects::kHeightRange_m.least,
                         objects::kHeightRange_m.most, 0.1, "%.3f",
                         is_altitude ? "above the sphere" : "of its origin above the ground"),
          "raise");
  ImGui::PopItemWidth();
  changed(widgets.check("On the slope", p.follows_slope, "it tilts with the ground"), "align");
  ImGui::SameLine();
  bool keeps_altitude = is_altitude;
  if (widgets.check("Keeps its altitude", keeps_altitude,
                    "above the sphere, whatever the ground below it; else its height above the ground")) {
    const double ground_m = session.ground().height_m(mars::direction(p.place));
    p.height_kind = keeps_altitude ? HeightKind::kAltitude : HeightKind::kAboveGround;
    p.height_m += keeps_altitude ? ground_m : -ground_m;
    what = keeps_altitude ? "keep the altitude of" : "keep the height of";
  }
  if (widgets.button("Put on the ground", "height 0, turned upright or along the slope")) {
    p.height_kind = HeightKind::kAboveGround;
    p.height_m = p.pitch_deg = p.roll_deg = 0;
    what = "put on the ground";
  }
  widgets.group("");
  if (!what.empty()) report(editor_.replace(item.id, p, what));
}

void ObjectsPanel::draw_time(Widgets& widgets) {
  ImGui::BeginDisabled(follows_flight_);
  if (widgets.button(clock_.plays() ? "Pause##objects" : "Play##objects",
                     "lets paths run; while a flight is followed, they have its time"))
    clock_.play(!clock_.plays());
  ImGui::SameLine();
  double time_s = time_s_;
  ImGui::SetNextItemWidth(-ImGui::GetFontSize() * 3);
  if (widgets.slide("Time##objects", time_s, clock_.begin_s(), clock_.end_s(), "%.2f s", false))
    clock_.set(time_s);
  ImGui::EndDisabled();
}

void ObjectsPanel::draw_file(explore::Session& session, Widgets& widgets) {
  ImGui::Separator();
  ImGui::SetNextItemWidth(-1);
  widgets.text("##scene file", file_, "scene file to write or to open; ~/ is the home folder",
               "new.scene.toml");
  if (widgets.button("Save##objects", "Ctrl+S: writes the scene to this file")) save(session);
  ImGui::SameLine();
  if (widgets.button("Open##objects", "reads the scene of this file")) open(typed_file(), session);
  ImGui::SameLine();
  if (widgets.button("Close##objects", "shows no scene")) open({}, session);
  if (editor_.is_changed()) {
    ImGui::SameLine();
    ImGui::TextDisabled("not saved");
  }
  const bool can_restore = !editor_.is_changed() && !abandoned_.empty();
  if (can_restore &&
      widgets.button("Restore##objects", ("open the unsaved scene " + abandoned_.front().string()).c_str()))
    restore(std::filesystem::path(abandoned_.front()), session);
}

void ObjectsPanel::draw_marks(ImDrawList& list, const explore::Session& session, const EyeImage& eye) {
  if (!is_shown()) return;
  const GroundView ground(session, eye.view);
  std::size_t marks = 0;
  std::size_t looked_at = 0;
  for (const SharedItem& item : editor_.items()) {
    if (++looked_at > ObjectsPanelLimits::kMostItems && item->id != selected_) continue;
    const bool is_chosen = item->id == selected_;
    const bool is_area = std::holds_alternative<objects::ScatterEntry>(item->entry);
    if ((is_area && !is_chosen) || (marks >= ObjectMarkLimits::kMostMarks && !is_chosen)) continue;
    bool is_first = true;
    for (const explore::ItemBall& ball : balls(item, session)) {
      if (marks >= ObjectMarkLimits::kMostMarks && !(is_chosen && is_first)) break;
      const std::string name = is_first ? explore::item_name(*item) : "";
      if (draw_object_mark(list, ground, eye, ball, name, is_chosen)) ++marks;
      is_first = false;
    }
  }
}

}  // namespace vpe::window
