#include "vpe/app/cli/parsing.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string_view>

#include "mars/geodesy/place_text.h"
#include "vpe/app/cli/program.h"
#include "vpe/base/number.h"

namespace vpe::app {

bool is_sqlite(const std::string& path) {
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
  char head[16] = {};
  return file && std::fread(head, 1, sizeof head, file.get()) == sizeof head &&
         std::memcmp(head, "SQLite format 3", 16) == 0;
}

std::optional<std::vector<double>> parse_numbers(const std::string& text) {
  std::vector<double> numbers;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const auto number = base::parse_number(std::string_view(text).substr(begin, end - begin));
    if (!number) return std::nullopt;
    numbers.push_back(*number);
    begin = end + 1;
  }
  return numbers;
}

mars::LonLat parse_place(const std::string& text, const std::string& where) {
  std::string fault;
  const auto place = mars::parse_place(text, fault);
  if (!place) throw UsageError(where + "'" + text + "': " + fault);
  return *place;
}

}  // namespace vpe::app
