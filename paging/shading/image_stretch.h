// The stretch of imagery: which values are black and white, and how what lies between is distributed.
#pragma once

#include <array>
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
std::array<std::uint8_t, 256> stretch_table(const ImageStretch& stretch);

}  // namespace paging
