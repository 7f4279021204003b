#include "scripts/flight_words.h"

#include <cmath>

#include "vpe/base/number.h"

namespace scripts {

using vpe::base::format_number;
using vpe::base::parse_number;

namespace {

constexpr std::string_view kBlanks = " \t\r\v\f";

// Returns true for commands that are followed by a name.
bool has_name(std::string_view command) {
  return command == "object" || command == "relief" || command == "patch";
}

}  // namespace

std::string quote(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  std::string quoted = "\"";
  for (const char c : text.substr(0, kLongest)) {
    const auto byte = static_cast<unsigned char>(c);
    quoted += byte >= 0x20 && byte < 0x7f ? c : '?';
  }
  return quoted + (text.size() > kLongest ? "...\"" : "\"");
}

Words split_words(std::string_view line, std::string& fault) {
  Words words;
  for (;;) {
    const std::size_t begin = line.find_first_not_of(kBlanks);
    if (begin == std::string_view::npos || line[begin] == '#') return words;
    line.remove_prefix(begin);
    std::string& word = words.emplace_back();
    std::size_t at = 0;
    // `at T object NAME` and the like: the name may be quoted.
    const bool is_quoted_name = words.size() == 4 && has_name(words[2]) && line.starts_with('"');
    while (at < line.size() && kBlanks.find(line[at]) == std::string_view::npos && line[at] != '#') {
      // Only the first equals sign can be before a quoted value.
      const bool opens =
          line[at] == '=' && word.find('=') == std::string::npos && line.substr(at + 1).starts_with('"');
      if (!is_quoted_name) word += line[at++];
      if (!opens && !is_quoted_name) continue;
      for (++at; at < line.size() && line[at] != '"'; ++at) {
        if (line[at] == '\\' && at + 1 < line.size()) ++at;
        word += line[at];
      }
      if (at == line.size()) {
        fault = "a closing quote after " + quote(word);
        return {};
      }
      ++at;
      if (at < line.size() && kBlanks.find(line[at]) == std::string_view::npos && line[at] != '#') {
        fault = "a blank after a closing quote, found " + quote(line.substr(at));
        return {};
      }
      break;
    }
    line.remove_prefix(at);
  }
}

std::optional<KeyValue> split_key_value(std::string_view word) {
  const std::size_t equals = word.find('=');
  if (equals == 0 || equals == std::string_view::npos) return std::nullopt;
  return KeyValue{word.substr(0, equals), word.substr(equals + 1)};
}

std::string what_is_allowed(const Field& field) {
  return std::string(field.key) + (field.whole ? "=WHOLE NUMBER" : "=NUMBER") + " from " +
         format_number(field.min) + " to " + format_number(field.max);
}

bool read(Field& field, std::string_view text) {
  const std::optional<double> number = parse_number(text);
  if (!number || *number < field.min || *number > field.max) return false;
  if (field.whole && std::nearbyint(*number) != *number) return false;
  field.value = *number;
  return true;
}

std::string join_keys(std::span<const Field> fields) {
  std::string keys;
  for (const Field& field : fields) keys.append(keys.empty() ? "" : ", ").append(field.key);
  return keys;
}

}  // namespace scripts
