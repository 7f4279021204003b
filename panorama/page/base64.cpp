#include "panorama/page/base64.h"

namespace panorama {

std::string to_base64(std::span<const std::uint8_t> bytes) {
  static constexpr char kLetters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t n = 0; n < bytes.size(); n += 3) {
    const std::size_t count = bytes.size() - n < 3 ? bytes.size() - n : 3;
    std::uint32_t group = static_cast<std::uint32_t>(bytes[n]) << 16;
    if (count > 1) group |= static_cast<std::uint32_t>(bytes[n + 1]) << 8;
    if (count > 2) group |= bytes[n + 2];
    text += kLetters[group >> 18];
    text += kLetters[group >> 12 & 63];
    text += count > 1 ? kLetters[group >> 6 & 63] : '=';
    text += count > 2 ? kLetters[group & 63] : '=';
  }
  return text;
}

}  // namespace panorama
