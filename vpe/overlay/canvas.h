// Vectors and text on a transparent image: all that the overlays need of Cairo, which nothing else includes.
// Positions are in pixels, x right, y down, pixel centres at +0.5.
#pragma once

#include <glm/vec2.hpp>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "vpe/overlay/overlay.h"

namespace vpe::overlay {

struct Ink {
  double r, g, b, a;  // 0 to 1
};

struct Font {
  double size_px;
  bool bold = false;
};

// Text with an outline that separates it from any ground.
struct Lettering {
  Font font;
  Ink ink;
  Ink halo;
};

// Upright box of a line of text about its centre; capitals are centred in it.
struct TextSize {
  double width;
  double height;
};

// One thread.
class Canvas {
 public:
  // Throws std::runtime_error when there is no memory.
  Canvas(int width, int height);
  ~Canvas();
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;

  int width() const { return width_; }
  int height() const { return height_; }

  void line(std::span<const glm::dvec2> points, bool closed, double width_px, const Ink& ink);
  void polygon(std::span<const glm::dvec2> points, const Ink& ink);
  TextSize measure(std::string_view text, const Font& font) const;
  void text(std::string_view text, glm::dvec2 centre, double angle_rad, const Lettering& style);
  // Takes away what is drawn so far in a box turned about its centre.
  void clear(glm::dvec2 centre, TextSize size, double angle_rad);

  // Throws std::runtime_error with the library's words when anything failed so far.
  Layer layer() const;

 private:
  struct State;
  int width_;
  int height_;
  std::unique_ptr<State> state_;
};

// The text with everything that is not UTF-8 replaced by U+FFFD, and control characters by blanks.
std::string printable_utf8(std::string_view text);

}  // namespace vpe::overlay
