#include "vpe/window/panels/appearance_panel.h"

#include <imgui_stdlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "vpe/base/number.h"
#include "vpe/core/appearance/palette_tables.h"
#include "vpe/window/panels/setting_rows.h"
#include "vpe/window/ui/imgui_helpers.h"

namespace vpe::window {

namespace {

struct Look {
  const char* name;
  const char* mode;
  const char* colour;  // "": any
  const char* tip;
};

constexpr std::array kLooks{
    Look{"Photo", "textured", "", "imagery, lit unless it holds its own light"},
    Look{"Elevation", "coloured", "elevation", "colours of elevation, with light"},
    Look{"Slope", "coloured", "slope", "colours of slope, with light"},
    Look{"Aspect", "coloured", "aspect", "colours of the direction of descent, with light"},
    Look{"Relief", "lit", "", "light alone"},
    Look{"Wireframe", "wireframe", "", "edges of the triangles that are drawn; by triangles only"}};

constexpr double kHorizon_deg = 90;

// Reads a season and hour of the sun's setting. Returns false for other texts.
bool read_season(const std::string& text, double& ls_deg, double& hour) {
  int hours = 0;
  int minutes = 0;
  if (std::sscanf(text.c_str(), "Ls%lf,%d:%d", &ls_deg, &hours, &minutes) != 3) return false;
  hour = hours + minutes / 60.0;
  return true;
}

std::string season_text(double ls_deg, double hour) {
  const int minutes = std::clamp(static_cast<int>(std::lround(hour * 60)), 0, 24 * 60 - 1);
  return "Ls" + base::format_display(ls_deg, 0) + formatted(",%02d:%02d", minutes / 60, minutes % 60);
}

void draw_strip(const core::Palette& palette, double width, double height) {
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  constexpr int kParts = 32;
  const double low = palette.stops().front().at;
  const double high = palette.stops().back().at;
  for (int n = 0; n < kParts; ++n) {
    const glm::dvec3 c = palette.colour(low + (high - low) * (n + 0.5) / kParts);
    ImGui::GetWindowDrawList()->AddRectFilled(
        at(corner.x + width * n / kParts, corner.y), at(corner.x + width * (n + 1) / kParts, corner.y + height),
        IM_COL32(static_cast<int>(c.x), static_cast<int>(c.y), static_cast<int>(c.z), 255));
  }
  ImGui::Dummy(at(width, height));
}

}  // namespace

std::string AppearancePanel::get(const char* key) const { return session_->settings().get(key).value_or(""); }

void AppearancePanel::set(const std::string& key, const std::string& text) {
  if (std::string problem = session_->set(key, text); !problem.empty()) error_ = std::move(problem);
}

void AppearancePanel::set(const std::string& key, double value) { set(key, base::format_number(value)); }

std::string AppearancePanel::draw(explore::Session& session, const DrawnImage* drawn, bool has_imagery,
                                  Widgets& widgets) {
  session_ = &session;
  has_imagery_ = has_imagery;
  widgets_ = &widgets;
  error_.clear();
  begin_part("appearance");
  draw_looks();
  draw_palette();
  double exaggeration = session.settings().values().exaggeration;
  ImGui::SetNextItemWidth(ImGui::GetFontSize() * 11);
  if (widgets.slide("Exaggeration", exaggeration, 1, 20, "%.1f x", true,
                    "factor on every elevation; Ctrl + click to type a number"))
    set("exaggeration", std::round(exaggeration * 10) / 10);
  draw_sun();
  draw_air();
  draw_imagery();
  if (widgets.header("All settings", false)) {
    SettingRows rows(session, drawn, widgets);
    ImGui::SetNextItemWidth(ImGui::GetFontSize() * 11);
    ImGui::InputTextWithHint("##filter", "filter: a key or a word", &filter_);
    widgets.record("filter");
    if (filter_.empty())
      rows.group("", {"lod.", "rays.", "cull.", "samples", "edges", "inspect"});
    else
      rows.matching(filter_);
    if (!rows.error().empty()) error_ = rows.error();
  }
  ImGui::EndChild();
  return error_;
}

void AppearancePanel::draw_looks() {
  const std::string mode = get("mode");
  const std::string colour = get("colour");
  const float wide = (ImGui::GetContentRegionAvail().x - 2 * ImGui::GetStyle().ItemSpacing.x) / 3;
  for (std::size_t n = 0; n < kLooks.size(); ++n) {
    const Look& look = kLooks[n];
    bool is_on = mode == look.mode && (*look.colour == 0 || colour == look.colour);
    if (n % 3 != 0) ImGui::SameLine();
    if (!widgets_->toggle(look.name, is_on, look.tip, static_cast<double>(wide)) || !is_on) continue;
    set("mode", look.mode);
    if (*look.colour != 0) set("colour", look.colour);
  }
}

void AppearancePanel::draw_palette() {
  const std::string shown = get("palette");
  const std::string colour = get("colour");
  const bool is_used =
      get("mode") == "coloured" && (colour == "elevation" || colour == "slope" || colour == "aspect");
  ImGui::BeginDisabled(!is_used);
  ImGui::SetNextItemWidth(ImGui::GetFontSize() * 11);
  const bool is_open = ImGui::BeginCombo("Palette", shown.c_str(), ImGuiComboFlags_HeightLarge);
  widgets_->record("Palette");
  if (is_open) {
    const double height = static_cast<double>(ImGui::GetTextLineHeight());
    const auto row = [&](const std::string& name) {
      ImGui::PushID(name.c_str());
      if (ImGui::Selectable(name.c_str(), name == shown, 0, at(0, height))) set("palette", name);
      widgets_->record("Palette=" + name);
      ImGui::PopID();
    };
    row("auto");
    for (const std::string_view name : core::palette_names()) {
      row(std::string(name));
      ImGui::SameLine(ImGui::GetFontSize() * 7);
      draw_strip(*core::built_in_palette(name), height * 5, height * 0.8);
    }
    ImGui::EndCombo();
  }
  ImGui::EndDisabled();
}

void AppearancePanel::draw_sun() {
  ImGui::Separator();
  const std::string sun = get("sun");
  double ls_deg = 0;
  double hour = 12;
  const bool is_season = read_season(sun, ls_deg, hour);
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("Sun");
  ImGui::SameLine();
  bool local = sun == "local";
  if (widgets_->toggle("By direction", local, "stands where the dial says, at the ground below the camera") &&
      local)
    set("sun", "local");
  ImGui::SameLine();
  bool season = is_season;
  if (widgets_->toggle("By season", season, "stands where it is at that season and hour below the camera") &&
      season)
    set("sun", season_text(ls_deg, hour));
  const core::SettingsValues& values = session_->settings().values();
  // Both have the same height, so that what is below stays at its place.
  begin_part("sun", ImVec2(0, ImGui::GetFontSize() * 6.2F));
  if (is_season)
    draw_season();
  else if (sun == "local")
    draw_dial(values.sun_azimuth_deg, values.sun_elevation_deg);
  else
    ImGui::TextWrapped("as on %s", sun.c_str());
  ImGui::EndChild();
}

void AppearancePanel::draw_dial(double azimuth_deg, double elevation_deg) {
  const double radius = static_cast<double>(ImGui::GetFontSize()) * 2.8;
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImGui::InvisibleButton("dial", at(2 * radius, 2 * radius));
  widgets_->record("sun dial");
  const glm::dvec2 middle{static_cast<double>(corner.x) + radius, static_cast<double>(corner.y) + radius};
  if (ImGui::IsItemActive()) {
    const ImVec2 cursor = ImGui::GetIO().MousePos;
    const glm::dvec2 by{static_cast<double>(cursor.x) - middle.x, static_cast<double>(cursor.y) - middle.y};
    const double share = std::min(1.0, std::hypot(by.x, by.y) / radius);
    azimuth_deg = std::atan2(by.x, -by.y) / mars::kRadiansPerDegree;
    if (azimuth_deg < 0) azimuth_deg += 360;
    elevation_deg = kHorizon_deg * (1 - share);
    set("sun.azimuth", std::round(azimuth_deg));
    set("sun.elevation", std::round(elevation_deg));
  }
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddCircleFilled(at(middle.x, middle.y), static_cast<float>(radius), IM_COL32(46, 48, 54, 255), 48);
  list.AddCircle(at(middle.x, middle.y), static_cast<float>(radius), IM_COL32(130, 130, 135, 255), 48);
  list.AddText(
      at(middle.x - static_cast<double>(ImGui::CalcTextSize("N").x) / 2, static_cast<double>(corner.y)),
      IM_COL32(170, 170, 175, 255), "N");
  const double share = 1 - elevation_deg / kHorizon_deg;
  const double angle = azimuth_deg * mars::kRadiansPerDegree;
  list.AddCircleFilled(
      at(middle.x + radius * share * std::sin(angle), middle.y - radius * share * std::cos(angle)),
      ImGui::GetFontSize() * 0.35F, IM_COL32(255, 210, 90, 255));
  ImGui::SameLine();
  ImGui::BeginGroup();
  ImGui::PushItemWidth(ImGui::GetFontSize() * 7);
  if (widgets_->slide("Azimuth", azimuth_deg, 0, 360, "%.0f\u00b0", false, "clockwise from north"))
    set("sun.azimuth", std::round(azimuth_deg));
  if (widgets_->slide("Height", elevation_deg, 0, 90, "%.0f\u00b0", false, "of the sun above the horizon"))
    set("sun.elevation", std::round(elevation_deg));
  ImGui::PopItemWidth();
  ImGui::EndGroup();
}

void AppearancePanel::draw_season() {
  double ls_deg = 0;
  double hour = 0;
  (void)read_season(get("sun"), ls_deg, hour);
  ImGui::PushItemWidth(ImGui::GetFontSize() * 11);
  bool changed = widgets_->slide("Season", ls_deg, 0, 359, "Ls %.0f\u00b0", false,
                                 "solar longitude: 0 spring in the north, 90 summer, 180 autumn, 270 winter");
  changed |= widgets_->slide(
      "Hour", hour, 0, 23.99,
      formatted("%02d:%02d", static_cast<int>(hour), static_cast<int>(std::lround(hour * 60)) % 60).c_str(),
      false, "local true solar time below the camera");
  ImGui::PopItemWidth();
  if (changed) set("sun", season_text(std::round(ls_deg), hour));
}

void AppearancePanel::draw_air() {
  static const std::array<std::string, 3> kLights{"auto", "on", "off"};
  int light = static_cast<int>(std::find(kLights.begin(), kLights.end(), get("light")) - kLights.begin());
  ImGui::SetNextItemWidth(ImGui::GetFontSize() * 5);
  if (widgets_->choose("Light", light, kLights,
                       "on: the sun lights the ground; auto: except on photographs that hold their own light"))
    set("light", kLights[static_cast<std::size_t>(light)]);
  ImGui::SameLine();
  bool shadows = session_->settings().values().shadows;
  if (widgets_->check("Cast shadows", shadows, "ground casts shadows on ground; takes longer"))
    set("shadows", shadows ? "on" : "off");
  ImGui::PushItemWidth(ImGui::GetFontSize() * 11);
  // The slider's left end is clear air.
  constexpr double kNearest_m = 1e3;
  constexpr double kFarthest_m = 1e6;
  const double visibility_m = session_->settings().values().haze_visibility_m;
  double haze =
      visibility_m > 0
          ? std::clamp(std::log(kFarthest_m / visibility_m) / std::log(kFarthest_m / kNearest_m), 0.01, 1.0)
          : 0;
  const std::string seen = visibility_m > 0 ? panel_length_text(visibility_m) : "clear";
  if (widgets_->slide("Haze", haze, 0, 1, seen.c_str(), false, "distance at which 2 % of the contrast is left"))
    set("haze.visibility",
        haze < 0.01 ? 0.0 : std::round(kFarthest_m * std::pow(kNearest_m / kFarthest_m, haze) / 100) * 100);
  double gamma = session_->settings().values().gamma;
  if (widgets_->slide("Brightness", gamma, 0.5, 3, "%.2f", true, "gamma correction: larger is brighter"))
    set("gamma", std::round(gamma * 100) / 100);
  ImGui::PopItemWidth();
}

// Draws the stretch of imagery, where the planet has any.
void AppearancePanel::draw_imagery() {
  if (!has_imagery_ || !widgets_->header("Stretch of imagery", false)) return;
  const core::SettingsValues& values = session_->settings().values();
  ImGui::PushItemWidth(ImGui::GetFontSize() * 11);
  double low = values.image_low;
  if (widgets_->slide("Black", low, 0, 255, "%.0f", false,
                      "value that is shown black; above White: the negative"))
    set("image.low", std::round(low));
  double high = values.image_high;
  if (widgets_->slide("White", high, 0, 255, "%.0f", false, "value that is shown white"))
    set("image.high", std::round(high));
  double gamma = values.image_gamma;
  if (widgets_->slide("Gamma", gamma, 0.1, 10, "%.2f", true, "between both; larger is brighter"))
    set("image.gamma", std::round(gamma * 100) / 100);
  ImGui::PopItemWidth();
  if (!widgets_->button("As stored", "shows the imagery without a stretch")) return;
  const core::SettingsValues usual;
  set("image.low", usual.image_low);
  set("image.high", usual.image_high);
  set("image.gamma", usual.image_gamma);
}

}  // namespace vpe::window
