// The stretch of imagery: which values are black and white, and how what lies between is distributed.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace paging {

// Describes a stretch of values 0 to 255. Regular type; the default changes nothing.
struct ImageStretch {
  double low = 0;     // becomes black
  double high = 255;  // becomes white; below `low`: the negative
  double gamma = 1;   // larger: brighter between both
  bool operator==(const ImageStretch&) const = default;
};

// Returns what each value becomes: 255 ((v - low) / (high - low))^(1 / gamma), rounded, and cut to 0 to 255, as
// `gdal_translate -scale LOW HIGH 0 255 -exponent 1/GAMMA` makes it. With equal ends, values from `high` on are white. Pure.
inline std::array<std::uint8_t, 256> stretch_table(const ImageStretch& stretch) {
  std::array<std::uint8_t, 256> table{};
  const double span = stretch.high - stretch.low;
  for (std::size_t value = 0; value < table.size(); ++value) {
    const double from_low = static_cast<double>(value) - stretch.low;
    const double share = span == 0 ? (from_low >= 0 ? 1 : 0) : std::clamp(from_low / span, 0.0, 1.0);
    table[value] = static_cast<std::uint8_t>(std::lround(255 * std::pow(share, 1 / stretch.gamma)));
  }
  return table;
}

}  // namespace paging
