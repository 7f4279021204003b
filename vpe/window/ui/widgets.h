// Dear ImGui's widgets with tooltips. Records where each widget is, by its label, so that tests can operate it.
#pragma once

#include <imgui.h>

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace vpe::window {

struct WidgetPlace {
  double x0 = 0;  // framebuffer pixels
  double y0 = 0;
  double x1 = 0;
  double y1 = 0;
};

// Draws widgets in the present ImGui window. For the window's thread.
//
// Typical usage:
//   widgets.begin_frame();
//   if (widgets.button("Save", "F12")) save();
//   widgets.places().at("Save");   // where it was drawn
class Widgets {
 public:
  // Seconds for which the cursor rests on a widget before its tooltip appears.
  static constexpr double kTip_s = 0.5;

  void begin_frame();
  // Returns the seconds until a tooltip is due that the last frame did not show yet, else nullopt.
  std::optional<double> tip_due_s() const { return tip_due_s_; }
  // Returns the visible parts of the last frame's widgets by label; inside a group by "GROUP/LABEL".
  const std::map<std::string, WidgetPlace>& places() const { return places_; }
  void group(std::string name) { group_ = std::move(name); }

  // Return true if pressed or changed.
  bool button(const char* label, const char* tip = nullptr);
  // A button that stays down; as wide as its label, or `width` pixels.
  bool toggle(const char* label, bool& on, const char* tip = nullptr, double width = 0);
  bool check(const char* label, bool& on, const char* tip = nullptr);
  bool tab(const char* label);                   // if true, call ImGui::EndTabItem() after it
  bool header(const char* label, bool is_open);  // true while it is open; `is_open` at first
  // `hint` stands in the field while nothing is chosen.
  bool choose(const char* label, int& index, std::span<const std::string> names, const char* tip = nullptr,
              const char* hint = "");
  // A number that is typed or stepped. Typed text takes effect with Enter, or when the field is left; Esc drops
  // it.
  bool number(const char* label, double& value, double low, double high, double step, const char* format,
              const char* tip = nullptr);
  bool slide(const char* label, double& value, double low, double high, const char* format, bool logarithmic,
             const char* tip = nullptr);
  // A text field. Returns true if Enter is pressed or the field is left with another text. `hint` stands in the field
  // while it is empty.
  bool text(const char* label, std::string& value, const char* tip = nullptr, const char* hint = "");
  // Keeps a text that was refused in its field, to be corrected.
  void refuse(const char* label, const std::string& text) { refused_[name_of(label)] = {text, {}}; }
  // Shows a tooltip of the item drawn last once the cursor has rested on it.
  void tip(const char* text) { show_tip(text); }
  // Records the place of the item drawn last under a label.
  void record(std::string_view label);

 private:
  void show_tip(const char* text);
  std::string name_of(std::string_view label) const;

  std::map<std::string, WidgetPlace> places_;
  std::string group_;
  std::map<unsigned, std::string> drafts_;  // texts that are being typed
  struct Refused {
    std::string text;
    std::optional<std::string> instead;  // the value that stayed
  };
  std::map<std::string, Refused> refused_;
  unsigned editing_ = 0;
  std::optional<double> tip_due_s_;
  std::optional<std::pair<std::string, double>> typed_;  // field and number that is being typed
};

}  // namespace vpe::window
