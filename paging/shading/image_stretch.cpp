#include "paging/shading/image_stretch.h"

#include <algorithm>
#include <cmath>

namespace paging {

std::array<std::uint8_t, 256> stretch_table(const ImageStretch& stretch) {
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
