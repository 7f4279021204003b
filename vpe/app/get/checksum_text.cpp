#include <algorithm>
#include <cctype>
#include <sstream>

#include "vpe/app/get/checksum.h"

namespace vpe::app {

std::optional<std::string> parse_md5_file(std::string_view text, std::string_view name) {
  constexpr std::size_t kDigits = 32;
  std::istringstream lines{std::string(text)};
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string digits;
    std::string file;
    words >> digits >> file;
    std::ranges::transform(digits, digits.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (digits.size() != kDigits || digits.find_first_not_of("0123456789abcdef") != std::string::npos) continue;
    if (file.starts_with('*')) file.erase(0, 1);  // a file that md5sum read as binary
    file.erase(0, file.rfind('/') + 1);
    if (file.empty() || file == name) return digits;
  }
  return std::nullopt;
}

}  // namespace vpe::app
