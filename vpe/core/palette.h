// Colours of numbers: palettes, by name or from a file, and the scale from the value shown to its colour.
#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "vpe/core/appearance.h"

namespace vpe::core {

struct PaletteStop {
  double at;
  glm::dvec3 rgb;  // 0 to 255
};

// Straight between stops, constant beyond the first and the last. Regular type.
class Palette {
 public:
  enum class Scale {
    kFraction,  // stops from 0 to 1, stretched over the range shown
    kValue,     // stops at values: metres or degrees
  };

  // Stops in rising order of `at`, two at the same place make a step; at least one. Throws
  // std::invalid_argument.
  Palette(Scale scale, std::vector<PaletteStop> stops);

  Scale scale() const { return scale_; }
  std::span<const PaletteStop> stops() const { return stops_; }
  glm::dvec3 colour(double at) const;

  bool operator==(const Palette&) const = default;

 private:
  Scale scale_;
  std::vector<PaletteStop> stops_;
};

// The names of palettes that are always there, auto and hsv not among them.
std::span<const std::string_view> palette_names();

// text: of a file. Two forms, told apart by what they hold: `value r g b [a]` as gdaldem color-relief reads it
// (values may be percentages; nv and alpha are not used; names of colours are not known), and `fraction r g b`
// with all fractions in [0, 1] and the outermost 0 and 1. r g b are 0 to 255; separators are blanks, tabs,
// commas or colons; # begins a comment. Throws std::runtime_error that names `name`, the line and what was
// expected.
Palette parse_palette(std::string_view text, std::string_view name);

// A value of Appearance::palette: empty when it can be used, else what is wrong (a name that is not known, a
// file that cannot be read or parsed).
std::string palette_problem(const std::string& palette);

// From the value that `colour` shows to its colour.
class ColourScale {
 public:
  // For colour elevation, slope or aspect. Reads the palette's file. Throws std::runtime_error.
  explicit ColourScale(const Appearance& appearance);

  double low() const { return low_; }  // of the range that a legend shows
  double high() const { return high_; }
  std::string_view unit() const { return unit_; }  // "m" or "deg"
  glm::dvec3 operator()(double value) const;       // 0 to 255

  bool operator==(const ColourScale&) const = default;

 private:
  Palette palette_;
  double low_;
  double high_;
  std::string_view unit_;
};

// Hue in degrees [0, 360), saturation and value 0 to 1; rgb 0 to 255.
struct Hsv {
  double hue_deg;
  double saturation;
  double value;
};
Hsv to_hsv(const glm::dvec3& rgb);
glm::dvec3 to_rgb(const Hsv& hsv);

// Hue and saturation of one colour, value of another.
glm::dvec3 colourised(const glm::dvec3& image_rgb, const glm::dvec3& colour_rgb);

}  // namespace vpe::core
