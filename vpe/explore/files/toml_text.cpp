#include "vpe/explore/files/toml_text.h"

#include <toml++/toml.h>

#include <string_view>

#include "vpe/base/number.h"

namespace vpe::explore {

std::string toml_string(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += {'\\', c};
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      constexpr std::string_view kDigits = "0123456789abcdef";
      const auto code = static_cast<unsigned char>(c);
      out += {'\\', 'u', '0', '0', kDigits[code >> 4U], kDigits[code & 15U]};
    } else {
      out += c;
    }
  }
  out += '"';
  try {
    (void)toml::parse("a = " + out);
  } catch (const toml::parse_error&) {
    return "\"\"";
  }
  return out;
}

std::string toml_number(double value) {
  std::string text = base::format_number(value);
  if (text.find_first_of(".eE") == std::string::npos) text += ".0";
  return text;
}

}  // namespace vpe::explore
