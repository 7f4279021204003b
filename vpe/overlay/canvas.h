// Vector drawing and text on a transparent image. The only header of the project whose source includes Cairo.
// Positions are in pixels: x right, y down, pixel centres at +0.5.
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

// Describes text with an outline that separates it from any background.
struct Lettering {
  Font font;
  Ink ink;
  Ink halo;
};

// Holds the size of the upright box of a line of text. Capitals are centred in the box.
struct TextSize {
  double width;
  double height;
};

// Draws shapes and text: lines up to kWidestThinLine_px by StrokeMask, all else with Cairo. For one thread at a time.
class Canvas {
 public:
  // Throws std::runtime_error if there is not enough memory.
  Canvas(int width, int height);
  ~Canvas();
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;

  int width() const { return width_; }
  int height() const { return height_; }

  void line(std::span<const glm::dvec2> points, bool closed, double width_px, const Ink& ink);
  // Draws a line that is open, in strokes and gaps in turn of these lengths; without lengths it is solid.
  void dashed(std::span<const glm::dvec2> points, double width_px, const Ink& ink,
              std::span<const double> lengths_px);
  // Lays an image of the canvas's size over what is drawn.
  void paint(const Layer& image);
  void polygon(std::span<const glm::dvec2> points, const Ink& ink);
  TextSize measure(std::string_view text, const Font& font) const;
  void text(std::string_view text, glm::dvec2 centre, double angle_rad, const Lettering& style);
  // Erases everything drawn so far in a box that is rotated about its centre.
  void clear(glm::dvec2 centre, TextSize size, double angle_rad);

  // Returns what was drawn. Throws std::runtime_error with Cairo's message if any call failed so far.
  Layer layer() const;

 private:
  struct State;
  int width_;
  int height_;
  std::unique_ptr<State> state_;
};

// Returns the text with every byte that is not valid UTF-8 replaced by U+FFFD, and control characters by
// spaces.
std::string printable_utf8(std::string_view text);

}  // namespace vpe::overlay
