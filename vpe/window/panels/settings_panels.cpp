#include "vpe/window/panels/settings_panels.h"

#include <cmath>
#include <optional>
#include <vector>

#include "lod/tree/posts.h"
#include "mars/geodesy/place_text.h"
#include "vpe/window/panels/setting_rows.h"
#include "vpe/window/ui/imgui_helpers.h"

namespace vpe::window {

namespace {

void draw_regions(explore::Session& session, Widgets& widgets) {
  if (!widgets.header("Regions of interest", true)) return;
  std::vector<core::InterestRegion> regions(session.interest().begin(), session.interest().end());
  if (regions.empty()) {
    ImGui::TextDisabled("Shift + drag on the map: a level more;");
    ImGui::TextDisabled("Ctrl + Shift + drag: a level less");
    return;
  }
  bool changed = false;
  std::optional<std::size_t> gone;
  for (std::size_t n = 0; n < regions.size(); ++n) {
    core::InterestRegion& region = regions[n];
    const std::string id = "##region " + std::to_string(n);
    if (widgets.button(("x" + id).c_str(), "remove this region")) gone = n;
    ImGui::SameLine();
    double levels = region.levels;
    ImGui::SetNextItemWidth(ImGui::GetFontSize() * 6);
    if (widgets.number(("levels" + id).c_str(), levels, -core::InterestLimits::kMaxLevels,
                       core::InterestLimits::kMaxLevels, 1, "%+.0f",
                       "finer (+) or coarser (-) than elsewhere")) {
      region.levels = static_cast<int>(std::lround(levels));
      changed = true;
    }
    ImGui::SameLine();
    double radius_km = region.radius_m / 1e3;
    ImGui::SetNextItemWidth(ImGui::GetFontSize() * 5);
    if (widgets.number(("km" + id).c_str(), radius_km, 0.001, core::InterestLimits::kMaxRadius_m / 1e3, 0,
                       "%.4g", (mars::place_text({region.lon_deg, region.lat_deg}) + ": radius").c_str())) {
      region.radius_m = radius_km * 1e3;
      changed = true;
    }
  }
  if (gone) regions.erase(regions.begin() + static_cast<std::ptrdiff_t>(*gone));
  if (widgets.button("Remove all")) regions.clear();
  if (changed || regions.size() != session.interest().size()) session.set_interest(std::move(regions));
}

}  // namespace

std::string draw_detail_panel(explore::Session& session, const DrawnImage* drawn,
                              const paging::PlanetFile& planet, Widgets& widgets) {
  SettingRows rows(session, drawn, widgets);
  begin_part("detail");
  draw_regions(session, widgets);
  if (ImGui::CollapsingHeader("Level of detail", ImGuiTreeNodeFlags_DefaultOpen)) rows.group("lod.");
  if (ImGui::CollapsingHeader("Rays", ImGuiTreeNodeFlags_DefaultOpen)) rows.group("rays.");
  if (ImGui::CollapsingHeader("Image", ImGuiTreeNodeFlags_DefaultOpen)) {
    for (const char* prefix : {"samples", "edges", "cull.", "inspect"}) rows.group(prefix);
  }
  if (drawn != nullptr && ImGui::CollapsingHeader("Tiles by level", ImGuiTreeNodeFlags_DefaultOpen)) {
    const std::vector<int>& levels = drawn->result.stats.tiles_by_level;
    for (std::size_t n = 0; n < levels.size(); ++n) {
      if (levels[n] == 0) continue;
      const int level = static_cast<int>(n);
      const double spacing_m = lod::post_spacing_m(level, planet.meta().tile.intervals(), planet.radius_m());
      ImGui::Text("%2d   %4d tiles   posts every %s", level, levels[n], panel_length_text(spacing_m).c_str());
    }
  }
  ImGui::EndChild();
  return rows.error();
}

}  // namespace vpe::window
