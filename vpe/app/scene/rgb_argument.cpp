#include "vpe/app/scene/rgb_argument.h"

#include <array>
#include <cstdint>

namespace vpe::app {

std::optional<base::Rgb> parse_rgb(std::string text) {
  if (text.size() == 6) text.insert(0, 1, '#');
  if (text.size() != 7 || text.front() != '#') return std::nullopt;
  std::array<std::uint8_t, 3> channels{};
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t k = 0; k < 2; ++k) {
      const char digit = text[1 + 2 * c + k];
      const int value = digit >= '0' && digit <= '9'   ? digit - '0'
                        : digit >= 'a' && digit <= 'f' ? digit - 'a' + 10
                        : digit >= 'A' && digit <= 'F' ? digit - 'A' + 10
                                                       : -1;
      if (value < 0) return std::nullopt;
      channels[c] = static_cast<std::uint8_t>(channels[c] * 16 + value);
    }
  }
  return base::Rgb{channels[0], channels[1], channels[2]};
}

}  // namespace vpe::app
