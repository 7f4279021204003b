// The bar and the help of the overlook window.
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "vpe/window/overlook_window.h"
#include "vpe/window/ui/imgui_helpers.h"

namespace vpe::window {

namespace {

using explore::ActionKind;

constexpr const char* kFirstView = "First view";
constexpr const char* kSave = "Save";
constexpr const char* kHelp = "Help";

double normalized_azimuth(double azimuth_deg) {
  const double rest = azimuth_deg - 360.0 * std::floor(azimuth_deg / 360.0);
  return rest < 360.0 ? rest : 0.0;
}

std::string up_or_down(double elevation_deg, int digits) {
  return formatted("%.*f° %s", digits, std::abs(elevation_deg), elevation_deg < 0 ? "down" : "up");
}

// Returns a value as "1.23 km away" or "lon 137.441600°". Units of known names follow the number.
std::string value_text(const panorama::PlaneValue& value) {
  const double v = *value.value;
  if (value.name == "range_m") return panel_length_text(v) + " away";
  if (value.name == "elevation_m") return formatted("elevation %.1f m", v);
  if (value.name == "lon_deg" || value.name == "lat_deg")
    return value.name.substr(0, 3) + formatted(" %.6f°", v);
  if (value.name.ends_with("_deg")) return value.name.substr(0, value.name.size() - 4) + formatted(" %.2f°", v);
  return value.name + formatted(" %.6g", v);
}

std::string reading_text(const OverlookReading& reading) {
  std::string line = formatted("under the cursor: azimuth %.3f°, ", reading.direction.azimuth_deg) +
                     up_or_down(reading.direction.elevation_deg, 3);
  if (!reading.place) return line + "   outside of the image";
  bool any = false;
  for (const panorama::PlaneValue& value : reading.place->values) {
    if (!value.value) continue;
    any = true;
    line += "   " + value_text(value);
  }
  if (!any && !reading.place->values.empty()) line += "   sky, or nodata";
  return line;
}

}  // namespace

void OverlookWindow::draw_bar() {
  ImGui::SetNextWindowPos(at(0, height_ - bar_height_));
  ImGui::SetNextWindowSize(at(width_, bar_height_));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, at(8 * display_.scale(), 6 * display_.scale()));
  ImGui::Begin("bar", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse |
                   ImGuiWindowFlags_NoBringToFrontOnFocus);
  const ImGuiStyle& style = ImGui::GetStyle();
  double buttons = view_.is_pair() ? static_cast<double>(ImGui::GetFontSize() * 10 + style.ItemSpacing.x) : 0.0;
  for (const char* label : {kFirstView, kSave, kHelp})
    buttons +=
        static_cast<double>(ImGui::CalcTextSize(label).x + 2 * style.FramePadding.x + style.ItemSpacing.x);
  const double inside = static_cast<double>(ImGui::GetContentRegionAvail().x);
  ImGui::BeginChild("figures", at(std::max(1.0, inside - buttons), 0), false,
                    ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
  draw_values();
  ImGui::EndChild();
  ImGui::SameLine();
  draw_buttons();
  ImGui::End();
  ImGui::PopStyleVar();
}

void OverlookWindow::draw_values() {
  const panorama::Viewer& viewer = view_.viewer();
  if (!view_.message().empty()) {
    coloured_line(view_.message_is_error() ? kErrorColour : kSuccessColour, view_.message());
  } else if (!device_error_.empty()) {
    coloured_line(kErrorColour, device_error_);
  } else {
    std::string line = formatted("azimuth %.2f°   ", normalized_azimuth(viewer.yaw_deg())) +
                       up_or_down(viewer.pitch_deg(), 2) +
                       formatted("   field of view %.4g°", viewer.fov_deg());
    if (!view_.panorama().heading_is_known)
      line += "   north is not known: azimuths are from the middle of the image";
    ImGui::TextUnformatted(line.c_str());
  }
  const auto reading = view_.reading();
  if (reading)
    ImGui::TextUnformatted(reading_text(*reading).c_str());
  else
    ImGui::TextDisabled("drag to look around, wheel to zoom, F1 for more");
}

void OverlookWindow::draw_buttons() {
  if (view_.is_pair()) {
    static const std::array<std::string, 4> kEyes{"one eye", "side by side", "over and under", "red and cyan"};
    int eyes = view_.stereo() ? 1 + static_cast<int>(*view_.stereo()) : 0;
    ImGui::SetNextItemWidth(ImGui::GetFontSize() * 10);
    if (widgets_.choose("##eyes", eyes, kEyes, "layout of the two eyes' images")) {
      view_.set_stereo(eyes == 0 ? std::nullopt : std::optional(static_cast<core::StereoLayout>(eyes - 1)));
    }
    ImGui::SameLine();
  }
  if (widgets_.button(kFirstView, "R")) view_.act({ActionKind::kReset});
  ImGui::SameLine();
  if (widgets_.button(kSave, "F12: save this view as an image")) view_.act({ActionKind::kScreenshot});
  ImGui::SameLine();
  if (widgets_.button(kHelp, "F1")) help_ = !help_;
}

void OverlookWindow::draw_help() {
  static constexpr const char* kLines[][2] = {
      {"drag", "move the panorama with the cursor"},
      {"wheel", "zoom at the cursor"},
      {"arrow keys, right stick, head tracker", "turn"},
      {"+  -  0, cross up and down", "zoom; reset the field of view"},
      {"N, G, R", "look north; level; first view"},
      {"C", "head tracker: this is straight ahead"},
      {"H, F1, F11", "hide the bar; this help; full screen"},
      {"F12", "save the view as an image"},
      {"Esc", "close"},
  };
  ImGui::SetNextWindowPos(at(width_ / 2.0, (height_ - bar_height_) / 2), ImGuiCond_Always, {0.5F, 0.5F});
  ImGui::Begin("help", &help_,
               ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_AlwaysAutoResize |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoTitleBar);
  if (ImGui::BeginTable("keys", 2, ImGuiTableFlags_SizingFixedFit)) {
    for (const auto& line : kLines) {
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(line[0]);
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(line[1]);
    }
    ImGui::EndTable();
  }
  ImGui::End();
}

}  // namespace vpe::window
