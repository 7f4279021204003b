// Helpers for Dear ImGui that the panels share: positions, coloured text, tables of values, texts of numbers.
#pragma once

#include <imgui.h>

#include <cstdio>
#include <string>

namespace vpe::window {

// Describes a part of the window, in framebuffer pixels.
struct ViewArea {
  double x = 0;
  double y = 0;
  double width = 16;
  double height = 16;
  bool holds(double px, double py) const { return px >= x && py >= y && px < x + width && py < y + height; }
};

// Flags of a part of the window that neither moves nor changes its size.
inline constexpr ImGuiWindowFlags kFixed =
    ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
    ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus;

// Begins a part of a panel that scrolls by itself; keys lead into and out of it like over any widget.
inline void begin_part(const char* name, const ImVec2& size = {0, 0}, bool has_border = false) {
  ImGui::BeginChild(name, size, has_border, ImGuiWindowFlags_NavFlattened);
}

// Converts a position from doubles to Dear ImGui's floats.
inline ImVec2 at(double x, double y) { return {static_cast<float>(x), static_cast<float>(y)}; }

inline const ImVec4 kErrorColour{1, 0.5F, 0.4F, 1};
inline const ImVec4 kSuccessColour{0.7F, 0.9F, 0.7F, 1};

// Draw coloured text: wrapped at the panel's edge, or in one line.
void coloured(const ImVec4& colour, const std::string& text);
void coloured_line(const ImVec4& colour, const std::string& text);

// Returns a colour for what the ground hides.
inline ImU32 faint(ImU32 colour) {
  constexpr unsigned kFaintAlpha = 130;
  return (colour & ~IM_COL32_A_MASK) | (kFaintAlpha << static_cast<unsigned>(IM_COL32_A_SHIFT));
}

// Draws a text whose letters have a border of another colour. `corner` is its upper left one.
void draw_bordered(ImDrawList& list, const ImVec2& corner, const std::string& text, ImU32 colour, ImU32 border);

// Draws a message in the middle of a view that has no image, wrapped at 80 % of its width.
void draw_message(ImDrawList& list, const ViewArea& area, const std::string& text);

// Returns a length for panels: "12.3 km", "340 m", "2.54 m".
std::string panel_length_text(double length_m);

// Formats as printf does, up to 255 bytes.
template <class... Args>
std::string formatted(const char* format, Args... args) {
  char text[256];
  std::snprintf(text, sizeof text, format, args...);
  return text;
}

// Draws what a user can do here, in subdued letters and as many lines as the panel's width needs.
void draw_hint(const char* text);

// Draws a table of two columns, a label and a value in each row, while it is in scope.
//
// Typical usage:
//   const ValueTable table("figures");
//   table.add("Lowest", "-2103.4 m");
class ValueTable {
 public:
  explicit ValueTable(const char* id);
  ~ValueTable();
  ValueTable(const ValueTable&) = delete;
  ValueTable& operator=(const ValueTable&) = delete;

  void add(const char* label, const std::string& value) const;

 private:
  bool open_;
};

}  // namespace vpe::window
