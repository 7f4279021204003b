#include "mars/vector/style_values.h"

#include <array>
#include <cstdint>
#include <utility>

#include "vpe/base/number.h"

namespace mars {
namespace {

constexpr double kPixelsPerInch = 96;
constexpr double kLongest = 1e6;

std::optional<int> style_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return std::nullopt;
}

}  // namespace

std::optional<StyleColour> parse_style_colour(std::string_view text) {
  if (text.starts_with('#')) text.remove_prefix(1);
  if (text.size() != 3 && text.size() != 6 && text.size() != 8) return std::nullopt;
  const std::size_t digits = text.size() == 3 ? 1 : 2;
  std::array<std::uint8_t, 4> bytes{0, 0, 0, 255};
  for (std::size_t n = 0; n * digits < text.size(); ++n) {
    const auto high = style_digit(text[n * digits]);
    const auto low = style_digit(text[n * digits + digits - 1]);
    if (!high || !low) return std::nullopt;
    bytes[n] = static_cast<std::uint8_t>(*high * 16 + *low);
  }
  return StyleColour{{bytes[0], bytes[1], bytes[2]}, bytes[3] / 255.0};
}

std::optional<StyleMeasure> parse_style_length(std::string_view text) {
  constexpr std::array<std::pair<std::string_view, double>, 5> kUnits{{{"px", 1},
                                                                       {"pt", kPixelsPerInch / 72},
                                                                       {"mm", kPixelsPerInch / 25.4},
                                                                       {"cm", kPixelsPerInch / 2.54},
                                                                       {"in", kPixelsPerInch}}};
  StyleMeasure measure;
  double factor = 1;
  if (text.ends_with('g')) {
    measure = {{0, true}, true};
    text.remove_suffix(1);
  }
  for (const auto& [unit, pixels] : kUnits) {
    if (measure.has_unit || !text.ends_with(unit)) continue;
    measure.has_unit = true;
    factor = pixels;
    text.remove_suffix(unit.size());
  }
  const auto value = vpe::base::parse_number(text);
  if (!value || *value < 0 || *value > kLongest) return std::nullopt;
  measure.length.value = *value * factor;
  return measure;
}

}  // namespace mars
