// Palettes, by name or from a file, and the scale from a value of the ground to its colour.
//
// Typical usage:
//   const ColourScale scale(settings.values());  // reads the palette's file, if it is one
//   const glm::dvec3 rgb = scale(elevation_m);
//   draw_legend(scale.low(), scale.high(), scale.unit(), scale.stops());
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

// Maps numbers to colours: linear between stops, constant beyond the first and the last. Regular type.
class Palette {
 public:
  enum class Scale {
    kFraction,  // stops from 0 to 1, stretched over the range shown
    kValue,     // stops at values, metres or degrees
  };

  // Takes at least one stop, in rising order of `at`. Two stops at the same value make a step; the value itself
  // has the second colour. Throws std::invalid_argument for other orders, three stops at one value, fractions
  // outside [0, 1], values beyond 1e12 and colours outside 0 to 255.
  Palette(Scale scale, std::vector<PaletteStop> stops);

  Scale scale() const { return scale_; }
  std::span<const PaletteStop> stops() const { return stops_; }

  // Returns the exact colour, not one from a table, in some 20 ns for any number of stops. Returns the first
  // stop's colour for NaN.
  glm::dvec3 colour(double at) const;

  bool operator==(const Palette& other) const { return scale_ == other.scale_ && stops_ == other.stops_; }

 private:
  std::size_t bucket(double at) const;

  Scale scale_;
  std::vector<PaletteStop> stops_;
  // Divides the range of the stops into equal buckets. before_[b] is the number of stops in buckets below b.
  double buckets_per_unit_ = 0;
  std::vector<std::uint32_t> before_;
};

// Returns the names of the built-in palettes, without auto and hsv. palette_tables.cpp documents their origin.
std::span<const std::string_view> palette_names();

// Reads the text of a palette file. There are two forms, distinguished by their content:
// - `fraction r g b`, with all fractions in [0, 1] and the outermost 0 and 1: stretched over the range shown;
// - `value r g b [a]` as gdaldem color-relief reads it: at values, metres or degrees. Instead, all values may
//   be percentages of the range shown (0 % to 100 %). Lines with nv and alpha are ignored; names of colours are
//   not known.
// Lines may have any order. Two with the same value make a step, in the order of the file (reversed if the
// file falls). r g b are 0 to 255; separators are blanks, tabs, commas or colons; # begins a comment. Throws
// std::runtime_error that names `name`, the line and what was expected.
Palette parse_palette(std::string_view text, std::string_view name);

// Reads a file of at most 1 MiB. Throws std::runtime_error, FileError if it cannot be read.
Palette read_palette(const std::filesystem::path& file);

// Returns the file that a value of Appearance::palette means, or nullopt for names, auto and hsv. These take
// precedence over files of the same name (write ./grey for such a file).
std::optional<std::filesystem::path> palette_file(const std::string& palette);

// Returns "" if a value of Appearance::palette can be used, else what is wrong (an unknown name, a file that
// cannot be read or parsed).
std::string palette_problem(const std::string& palette);

// Returns what palette_problem() accepts, in words.
std::string palette_grammar();

// The values at the ends of a palette.
struct PaletteEnds {
  double low = 0;
  double high = 0;

  bool operator==(const PaletteEnds&) const = default;
};

// Returns true if an end of the palette is to be taken from the view (palette.low=auto, palette.high=auto).
inline bool has_auto_ends(const Appearance& a) { return !a.palette_low || !a.palette_high; }

// Returns both ends with those of the view in place of auto. Ends that are equal then, of a view without ground
// or of flat ground, mean the range that suits the value shown.
PaletteEnds ends_of(const Appearance& a, const PaletteEnds& view);

// Maps the value that `colour` shows to its colour. Regular type; const functions may be called from any
// thread.
//
// The range is palette_low to palette_high if they differ: the palette's first colour is at low, its last at
// high. Low may exceed high, which reverses the palette. If they are equal, a palette of values keeps its own
// range (but built-in ones, whose values are metres, are stretched for slope and aspect), and any other palette
// is stretched over elevation -8200 to 21300 m, slope 0 to 45 or aspect 0 to 360 degrees.
class ColourScale {
 public:
  // Reads the palette's file. Throws std::invalid_argument unless the colour is elevation, slope or aspect and
  // both ends are numbers, and std::runtime_error as read_palette() does.
  explicit ColourScale(const Appearance& appearance);

  double low() const { return low_; }  // ends of the range that a legend shows; low > high if reversed
  double high() const { return high_; }
  std::string_view unit() const { return unit_; }                          // "m" or "deg"
  std::span<const PaletteStop> stops() const { return palette_.stops(); }  // at values, rising

  // Returns the colour, 0 to 255. It is exact as in Palette::colour(), but palette=hsv is within 0.1 of HSV's
  // own curve. Returns the colour at low() for NaN.
  glm::dvec3 operator()(double value) const;

  bool operator==(const ColourScale&) const = default;

 private:
  Palette palette_;  // at values, rising
  double low_;
  double high_;
  std::string_view unit_;
};

// A colour by hue in degrees [0, 360), saturation and value 0 to 1. Grey has hue 0, black saturation 0.
struct Hsv {
  double hue_deg;
  double saturation;
  double value;
};

// Convert between HSV and rgb of 0 to 255. to_rgb() accepts any finite hue.
Hsv to_hsv(const glm::dvec3& rgb);
glm::dvec3 to_rgb(const Hsv& hsv);

// Returns hue and saturation of one colour with the value (the largest component) of the other. Black has no
// hue: it gives grey.
glm::dvec3 colourised(const glm::dvec3& image_rgb, const glm::dvec3& colour_rgb);

}  // namespace vpe::core
