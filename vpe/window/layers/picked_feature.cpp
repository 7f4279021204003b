// Features that are clicked in the view or on the map, and their attributes.
//
// GLFW would include OpenGL's own headers.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <filesystem>

#include "vpe/explore/layers/pick_query.h"
#include "vpe/explore/terrain_query.h"
#include "vpe/window/layers/layers_panel.h"
#include "vpe/window/ui/imgui_helpers.h"

namespace vpe::window {

namespace {

constexpr ImU32 kPickedRing = IM_COL32(255, 214, 90, 255);
constexpr ImU32 kPickedDark = IM_COL32(0, 0, 0, 190);

double reach_px() {
  // Fonts are as large as the scale says; at scale 1 they have 15 pixels or so.
  constexpr double kUsualFont_px = 15;
  return LayersPanelLimits::kReach_px *
         std::max(1.0, static_cast<double>(ImGui::GetFontSize()) / kUsualFont_px);
}

}  // namespace

std::vector<ShownFeature> LayersPanel::searched_layers() const {
  std::vector<ShownFeature> searched;
  for (const core::LayerFile& file : explore::items_on(files_)) {
    const LoadedFile* loaded = loader_.find(file.path);
    if (loaded == nullptr || file.opacity <= 0) continue;
    for (const auto& layer : loaded->layers) searched.push_back({file.path, layer, 0});
  }
  return searched;
}

void LayersPanel::keep_picked(std::vector<explore::PickedFeature> found, std::span<const ShownFeature> searched,
                              mars::LonLat place) {
  picked_.clear();
  index_ = 0;
  picked_place_ = place;
  for (const explore::PickedFeature& one : found) {
    picked_.push_back(searched[one.layer]);
    picked_.back().feature = one.feature;
  }
}

void LayersPanel::handle(const Event& event, std::optional<glm::dvec2> xy, const explore::Session& session,
                         const core::View& view) {
  switch (event.kind) {
    case Event::Kind::kPress:
      click_.cancel();
      if (xy && is_shown() && event.code == GLFW_MOUSE_BUTTON_LEFT &&
          (event.modifiers & (GLFW_MOD_SHIFT | GLFW_MOD_CONTROL | GLFW_MOD_ALT)) == 0)
        click_.press(*xy);
      break;
    case Event::Kind::kMove:
      if (xy)
        click_.move(*xy);
      else
        click_.cancel();
      break;
    case Event::Kind::kRelease:
      if (event.code == GLFW_MOUSE_BUTTON_LEFT)
        if (const auto clicked = click_.release()) pick(*clicked, session, view);
      break;
    case Event::Kind::kFocusLost: click_.cancel(); break;
    default: break;
  }
}

void LayersPanel::pick(glm::dvec2 xy, const explore::Session& session, const core::View& view) {
  const std::vector<ShownFeature> searched = searched_layers();
  picked_.clear();
  picked_place_.reset();
  if (searched.empty()) return;
  const auto query = explore::query_in_view(session.ground(), view, xy, reach_px());
  if (!query) return;
  std::vector<const mars::FeatureLayer*> layers;
  for (const ShownFeature& one : searched) layers.push_back(&one.layer->layer());
  keep_picked(explore::pick_features(layers, *query), searched, query->place);
}

bool LayersPanel::pick_on_map(const explore::MapView& map, mars::LonLat place) {
  if (!is_shown()) return false;
  const std::vector<ShownFeature> searched = searched_layers();
  std::vector<const mars::FeatureLayer*> layers;
  for (const ShownFeature& one : searched) layers.push_back(&one.layer->layer());
  const auto found = explore::pick_features(layers, explore::query_on_map(map, place, reach_px()));
  if (found.empty()) return false;
  keep_picked(found, searched, place);
  return true;
}

void LayersPanel::draw_picked(explore::Session& session, Widgets& widgets) {
  if (widgets.button("Middle##pick",
                     "the features in the middle of the view; a click picks those under the cursor"))
    pick({session.screen().width / 2.0, session.screen().height / 2.0}, session, session.view());
  if (picked_.empty()) {
    draw_hint(picked_place_ ? "There is no feature of a layer there."
                            : "Click on a feature in the view or on the map.");
    return;
  }
  ImGui::SameLine();
  ImGui::BeginDisabled(picked_.size() < 2);
  if (widgets.button("Next##picked", "the feature below this one, and after the last one the first"))
    index_ = (index_ + 1) % picked_.size();
  ImGui::EndDisabled();
  ImGui::SameLine();
  if (widgets.button("Clear##picked")) {
    picked_.clear();
    picked_place_.reset();
    return;
  }
  ImGui::SameLine();
  ImGui::Text("%zu of %zu", index_ + 1, picked_.size());
  const ShownFeature& shown = picked_[index_];
  const mars::FeatureLayer& layer = shown.layer->layer();
  const mars::Feature& feature = layer.features[shown.feature];
  const ValueTable table("attributes");
  table.add("File", std::filesystem::path(shown.file).filename().string());
  table.add("Layer", layer.name);
  table.add("Feature", std::to_string(feature.number));
  for (const auto& [name, text] : explore::field_texts(layer, feature)) table.add(name.c_str(), text);
}

void LayersPanel::draw_marks(ImDrawList& list, const explore::Session& session, const EyeImage& eye) const {
  if (!is_shown() || !picked_place_ || picked_.empty()) return;
  const GroundView ground(session, eye.view);
  const core::Projected at_px = ground.seen(ground.on_ground(mars::direction(*picked_place_)));
  if (!ground.is_in_view(at_px)) return;
  const ImVec2 middle = at(eye.x0 + at_px.xy.x, eye.y0 + at_px.xy.y);
  const float radius = ImGui::GetFontSize() * 0.5F;
  list.AddCircle(middle, radius, kPickedDark, 0, 4);
  list.AddCircle(middle, radius, kPickedRing, 0, 2);
}

}  // namespace vpe::window
