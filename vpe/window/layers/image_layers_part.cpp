// The rows of the planet's image layers.
#include <cmath>

#include "vpe/window/layers/layers_panel.h"
#include "vpe/window/ui/imgui_helpers.h"

namespace vpe::window {

namespace {

constexpr const char* kLooksKey = "image.layers";
constexpr double kMostValue = 255;
constexpr double kLeastGamma = 0.1;
constexpr double kMostGamma = 10;

}  // namespace

void LayersPanel::draw_images(explore::Session& session, std::span<const std::string> names, Widgets& widgets) {
  if (names.empty())
    return draw_hint(
        "This planet file holds its imagery as one. Build it with --images-apart to have its images as layers.");
  const std::string setting = session.settings().get(kLooksKey).value_or("");
  bool is_composed = setting.empty();
  if (widgets.check("As the planet was built", is_composed,
                    "the images as they were put together when the planet file was built"))
    set(session, kLooksKey, is_composed ? "" : explore::setting_of(images_));
  ImGui::BeginDisabled(is_composed);
  explore::ImageRows next = images_;
  for (std::size_t n = next.size(); n-- > 0;) {
    const std::string name = next[n].item.name;
    ImGui::PushID(name.c_str());
    widgets.group("image " + name);
    const RowAct act = draw_image(next[n], n + 1 == next.size(), n == 0, widgets);
    widgets.group("");
    ImGui::PopID();
    if (act == RowAct::kUp || act == RowAct::kDown) explore::move_by_one(next, n, act == RowAct::kUp);
    if (act != RowAct::kNone) break;
  }
  ImGui::EndDisabled();
  if (is_composed || next == images_) return;
  images_ = std::move(next);
  set(session, kLooksKey, explore::setting_of(images_));
}

LayersPanel::RowAct LayersPanel::draw_image(explore::Switched<core::ImageLayerLook>& row, bool is_top,
                                            bool is_bottom, Widgets& widgets) {
  RowAct act = RowAct::kNone;
  const auto button = [&](const char* label, const char* tip, bool is_off, RowAct meaning) {
    ImGui::BeginDisabled(is_off);
    if (widgets.button(label, tip)) act = meaning;
    ImGui::EndDisabled();
    ImGui::SameLine();
  };
  button("\u2191", "up: above the next layer", is_top, RowAct::kUp);
  button("\u2193", "down: below the next layer", is_bottom, RowAct::kDown);
  if (widgets.check((row.item.name + "##on").c_str(), row.is_on, "shows or hides the layer"))
    act = RowAct::kChanged;
  if (!row.is_on) return act;
  const auto slide = [&](const char* label, double& value, double least, double most, double parts,
                         const char* format, bool is_logarithmic, const char* tip) {
    double shown = value;
    if (!widgets.slide(label, shown, least, most, format, is_logarithmic, tip)) return;
    value = std::round(shown * parts) / parts;
    act = RowAct::kChanged;
  };
  ImGui::PushItemWidth(ImGui::GetFontSize() * 6);
  double percent = row.item.opacity * 100;
  slide("Opacity", percent, 0, 100, 1, "%.0f %%", false, "how much of what lies below is covered");
  if (percent != row.item.opacity * 100) row.item.opacity = percent / 100;
  ImGui::SameLine();
  slide("Gamma", row.item.gamma, kLeastGamma, kMostGamma, 100, "%.2f", true, "larger: brighter");
  slide("Black", row.item.low, 0, kMostValue, 1, "%.0f", false, "value of the image that is shown black");
  ImGui::SameLine();
  slide("White", row.item.high, 0, kMostValue, 1, "%.0f", false,
        "value that is shown white; below that of black: the negative");
  ImGui::PopItemWidth();
  return act;
}

}  // namespace vpe::window
