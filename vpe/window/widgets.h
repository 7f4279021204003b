// Dear ImGui's widgets as this program uses them. Each notes where it is, under its label, so that somebody who
// has no eyes, as a test, can find it.
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

class Widgets {
 public:
  void begin_frame() { places_.clear(); }
  // Of the frame drawn last, by label; of widgets inside of a group "GROUP/LABEL".
  const std::map<std::string, WidgetPlace>& places() const { return places_; }
  void group(std::string name) { group_ = std::move(name); }

  // True when pressed or changed.
  bool button(const char* label, const char* tip = nullptr);
  bool toggle(const char* label, bool& on, const char* tip = nullptr);  // a button that stays down
  bool check(const char* label, bool& on, const char* tip = nullptr);
  bool tab(const char* label);  // then ImGui::EndTabItem()
  bool choose(const char* label, int& index, std::span<const std::string> names, const char* tip = nullptr);
  // A number typed or stepped; what is typed counts with Enter.
  bool number(const char* label, double& value, double low, double high, double step, const char* format,
              const char* tip = nullptr);
  bool slide(const char* label, double& value, double low, double high, const char* format, bool logarithmic,
             const char* tip = nullptr);
  // True when Enter is pressed or the field is left with another text.
  bool text(const char* label, std::string& value, const char* tip = nullptr);
  // Notes the item drawn last under a name.
  void note(std::string_view label);

 private:
  void tip(const char* words) const;

  std::map<std::string, WidgetPlace> places_;
  std::string group_;
  std::map<unsigned, std::string> drafts_;  // texts being typed
  unsigned editing_ = 0;
};

}  // namespace vpe::window
