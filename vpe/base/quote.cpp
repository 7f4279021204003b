#include "vpe/base/quote.h"

#include <cstddef>

namespace vpe::base {

namespace {

// Returns the length of the character at the beginning, 0 for bytes that are not UTF-8. Overlong forms are not
// told apart, as a terminal shows them harmlessly.
std::size_t character_length(std::string_view text) {
  const auto first = static_cast<unsigned char>(text.front());
  const std::size_t length = first < 0x80   ? 1
                             : first < 0xc2 ? 0
                             : first < 0xe0 ? 2
                             : first < 0xf0 ? 3
                             : first < 0xf5 ? 4
                                            : 0;
  if (length > text.size()) return 0;
  for (std::size_t n = 1; n < length; ++n)
    if ((static_cast<unsigned char>(text[n]) & 0xc0) != 0x80) return 0;
  return length;
}

// Returns true for the controls of ASCII and for those from U+0080 to U+009F.
bool is_control(std::string_view character) {
  const auto first = static_cast<unsigned char>(character.front());
  if (character.size() == 1) return first < 0x20 || first == 0x7f;
  return character.size() == 2 && first == 0xc2 && static_cast<unsigned char>(character[1]) < 0xa0;
}

}  // namespace

std::string quote_text(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  std::string out = "\"";
  std::size_t at = 0;
  while (at < text.size() && at < kLongest) {
    const std::size_t length = character_length(text.substr(at));
    const std::string_view character = text.substr(at, length == 0 ? 1 : length);
    if (length == 0 || is_control(character))
      out += '?';
    else
      out += character;
    at += character.size();
  }
  return out + (at < text.size() ? "...\"" : "\"");
}

}  // namespace vpe::base
