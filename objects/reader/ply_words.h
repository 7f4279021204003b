// Lines and words of PLY files, which have the line ends of any system.
//
// Typical usage:
//   for (std::string_view line; next_line(text, line);) use(next_word(line));
#pragma once

#include <algorithm>
#include <string_view>

namespace objects {

// Takes the next line off `rest`. Returns false at the end; a line that the end cuts off counts.
inline bool next_line(std::string_view& rest, std::string_view& line) {
  if (rest.empty()) return false;
  const std::size_t end = std::min(rest.find('\n'), rest.size());
  line = rest.substr(0, end);
  rest.remove_prefix(std::min(end + 1, rest.size()));
  return true;
}

// Takes the next word off a line. Returns an empty word at its end.
inline std::string_view next_word(std::string_view& line) {
  constexpr std::string_view kBlanks = " \t\r\f\v";
  line.remove_prefix(std::min(line.find_first_not_of(kBlanks), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(kBlanks));
  line.remove_prefix(word.size());
  return word;
}

}  // namespace objects
