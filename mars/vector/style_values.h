// Colours and lengths of styles as text.
#pragma once

#include <optional>
#include <string_view>

#include "mars/vector/feature_style.h"

namespace mars {

// Returns the colour of a text of 3, 6 or 8 hexadecimal digits, with or without #; the last two of 8 are the opacity.
// Returns nullopt for other texts.
std::optional<StyleColour> parse_style_colour(std::string_view text);

// Holds a length with a unit, or without one.
struct StyleMeasure {
  StyleLength length;
  bool has_unit = false;
};

// Returns the length of a text such as "2px", "0.5mm", "10g" or "3", which is not negative and at most 1e6. Returns
// nullopt for other texts.
std::optional<StyleMeasure> parse_style_length(std::string_view text);

}  // namespace mars
