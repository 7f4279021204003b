#include "vpe/window/panels/devices_panel.h"

#include <array>
#include <cmath>

#include "vpe/window/ui/imgui_helpers.h"

namespace vpe::window {

namespace {

constexpr std::array<const char*, explore::kPadButtons> kButtonNames{
    "A",     "B",          "X",           "Y",  "left bumper", "right bumper", "Back", "Start",
    "Guide", "left stick", "right stick", "up", "right",       "down",         "left"};

// Never says -0.00.
double hundredths(double value) { return std::round(value * 100) / 100 + 0.0; }

void add_rates(const ValueTable& table, const explore::Controls& c) {
  const auto text = [](double a, double b, double d) {
    return formatted("%5.2f  %5.2f  %5.2f", hundredths(a), hundredths(b), hundredths(d));
  };
  table.add("Right, up, ahead", text(c.right, c.up, c.forward));
  table.add("Yaw, pitch, roll", text(c.yaw_right, c.pitch_up, c.roll_right));
}

std::string buttons_text(const ShownPad& pad) {
  std::string text;
  for (std::size_t n = 0; n < kButtonNames.size(); ++n)
    if (pad.buttons[n] != 0) text += (text.empty() ? "" : ", ") + std::string(kButtonNames[n]);
  return text.empty() ? "none" : text;
}

void draw_pad(const std::optional<ShownPad>& pad, bool is_on) {
  const ValueTable table("pad");
  if (!pad) return table.add("Gamepad", is_on ? "none is plugged in" : "off");
  const auto axis = [&](explore::PadAxis a) {
    return hundredths(static_cast<double>(pad->axes[static_cast<std::size_t>(a)]));
  };
  using A = explore::PadAxis;
  table.add("Gamepad", pad->name);
  table.add("Sticks", formatted("%5.2f %5.2f   %5.2f %5.2f", axis(A::kLeftX), axis(A::kLeftY), axis(A::kRightX),
                                axis(A::kRightY)));
  table.add("Triggers", formatted("%5.2f   %5.2f", axis(A::kLeftTrigger), axis(A::kRightTrigger)));
  table.add("Buttons", buttons_text(*pad));
  add_rates(table, pad->controls);
}

void draw_space_mouse(const std::optional<explore::Controls>& controls, bool is_on) {
  const ValueTable table("space mouse");
  table.add("Space mouse", !is_on ? "off" : controls ? "spacenavd is connected" : "spacenavd does not run");
  if (is_on && controls) add_rates(table, *controls);
}

void draw_tracker(const std::optional<ShownTracker>& tracker, bool is_on) {
  const ValueTable table("head tracker");
  if (!tracker) return table.add("Head tracker", is_on ? "cannot listen" : "off");
  table.add("Head tracker", (tracker->is_live ? "datagrams come to port " : "no datagrams at port ") +
                                std::to_string(tracker->port));
  table.add("Look", formatted("yaw %.1f\u00b0  pitch %.1f\u00b0  roll %.1f\u00b0", tracker->look.yaw_deg,
                              tracker->look.pitch_deg, tracker->look.roll_deg));
  table.add("Datagrams",
            std::to_string(tracker->received) +
                (tracker->ignored > 0 ? ", " + std::to_string(tracker->ignored) + " ignored" : ""));
}

}  // namespace

PreferencesActions draw_devices_panel(const DeviceStates& states, const explore::Preferences& preferences,
                                      Widgets& widgets) {
  PreferencesActions actions;
  const auto rows = [&](const char* prefix) {
    ImGui::PushID(prefix);
    draw_preference_rows(prefix, preferences, actions, widgets);
    ImGui::PopID();
  };
  widgets.group("devices");
  for (const std::string& error : states.errors) coloured(kErrorColour, error);
  draw_pad(states.pad, preferences.use_gamepad);
  rows("gamepad.");
  ImGui::Separator();
  draw_space_mouse(states.space_mouse, preferences.use_space_mouse);
  rows("space_mouse.");
  ImGui::Separator();
  draw_tracker(states.tracker, preferences.use_head_tracker);
  rows("head_tracker.");
  widgets.group("");
  return actions;
}

}  // namespace vpe::window
