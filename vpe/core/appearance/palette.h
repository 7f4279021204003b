// Colours of numbers: palettes, by name or from a file, and the scale from the value shown to its colour.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "vpe/core/appearance/appearance.h"

namespace vpe::core {

struct PaletteStop {
  double at;
  glm::dvec3 rgb;  // 0 to 255

  bool operator==(const PaletteStop&) const = default;
};

// Straight between stops, constant beyond the first and the last. Regular type.
class Palette {
 public:
  enum class Scale {
    kFraction,  // stops from 0 to 1, stretched over the range shown
    kValue,     // stops at values: metres or degrees
  };

  // Stops in rising order of `at`, two at the same place make a step (the place itself has the second's
  // colour); at least one. Throws std::invalid_argument, also for three at one place, fractions outside [0, 1],
  // values beyond 1e12 and colours outside 0 to 255.
  Palette(Scale scale, std::vector<PaletteStop> stops);

  Scale scale() const { return scale_; }
  std::span<const PaletteStop> stops() const { return stops_; }

  // Exact: no table is in between. Some 20 ns, however many stops. NaN: the first stop's colour.
  glm::dvec3 colour(double at) const;

  bool operator==(const Palette& other) const { return scale_ == other.scale_ && stops_ == other.stops_; }

 private:
  std::size_t bucket(double at) const;

  Scale scale_;
  std::vector<PaletteStop> stops_;
  // Even buckets from the first stop to the last: how many stops lie in buckets before each.
  double buckets_per_unit_ = 0;
  std::vector<std::uint32_t> before_;
};

// The names of palettes that are always there, auto and hsv not among them. palette_tables.cpp says what they
// are and where from.
std::span<const std::string_view> palette_names();

// text: of a file. Two forms, told apart by what they hold:
// - `fraction r g b`, all fractions in [0, 1] and the outermost 0 and 1: stretched over the range shown;
// - `value r g b [a]` as gdaldem color-relief reads it: at values, metres or degrees. All values may be
//   percentages of the range shown (0 % to 100 %) instead. Lines with nv and alpha are not used; names of
//   colours are not known.
// Lines are in any order; two with the same value make a step, in the order of the file (turned round where the
// file falls). r g b are 0 to 255; separators are blanks, tabs, commas or colons; # begins a comment. Throws
// std::runtime_error that names `name`, the line and what was expected.
Palette parse_palette(std::string_view text, std::string_view name);

// The same from a file of at most 1 MiB. Throws std::runtime_error (FileError when it cannot be read).
Palette read_palette(const std::filesystem::path& file);

// A value of Appearance::palette that means a file: that file. Nothing for names, auto and hsv, which go before
// files of the same name (write ./grey for those).
std::optional<std::filesystem::path> palette_file(const std::string& palette);

// A value of Appearance::palette: empty when it can be used, else what is wrong (a name that is not known, a
// file that cannot be read or parsed).
std::string palette_problem(const std::string& palette);

// What palette_problem() takes, in words.
std::string palette_grammar();

// From the value that `colour` shows to its colour. Regular type; const functions may be called from any
// thread.
//
// The range: palette_low and palette_high where they differ; the palette's first colour is at low, its last at
// high, also when low > high, which turns the palette round. Where they are equal: a palette of values keeps
// its own (but built-in ones, which are of metres, are stretched for slope and aspect), any other is stretched
// over elevation -8200 to 21300 m, slope 0 to 45 or aspect 0 to 360 degrees.
class ColourScale {
 public:
  // For colour elevation, slope or aspect (std::invalid_argument for others). Reads the palette's file. Throws
  // std::runtime_error.
  explicit ColourScale(const Appearance& appearance);

  double low() const { return low_; }  // of the range that a legend shows; low > high when turned round
  double high() const { return high_; }
  std::string_view unit() const { return unit_; }                          // "m" or "deg"
  std::span<const PaletteStop> stops() const { return palette_.stops(); }  // at values, rising

  // 0 to 255. As Palette::colour: exact, but for palette=hsv, which is within 0.1 of HSV's own curve. NaN: the
  // colour at low().
  glm::dvec3 operator()(double value) const;

  bool operator==(const ColourScale&) const = default;

 private:
  Palette palette_;  // at values, rising
  double low_;
  double high_;
  std::string_view unit_;
};

// Hue in degrees [0, 360), saturation and value 0 to 1; rgb 0 to 255. Grey has hue 0, black saturation 0.
struct Hsv {
  double hue_deg;
  double saturation;
  double value;
};
Hsv to_hsv(const glm::dvec3& rgb);
glm::dvec3 to_rgb(const Hsv& hsv);  // any finite hue

// Hue and saturation of one colour, value of another: its largest component. Black gives no hue: then grey.
glm::dvec3 colourised(const glm::dvec3& image_rgb, const glm::dvec3& colour_rgb);

}  // namespace vpe::core
