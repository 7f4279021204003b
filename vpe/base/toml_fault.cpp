#include "vpe/base/toml_fault.h"

#include <algorithm>
#include <cctype>
#include <string>

namespace vpe::base {

namespace {

constexpr int kMostDots = 8;  // in a key
constexpr std::string_view kBeforeText = " \t\n=[{,";
constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

// Returns true for the name of a table that begins here, or for anything but a table.
bool is_table_name(std::string_view line) {
  const auto skip_spaces = [&line] {
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
  };
  skip_spaces();
  if (!line.starts_with('[')) return true;
  line.remove_prefix(1);
  skip_spaces();
  if (line.starts_with('[')) line.remove_prefix(1);
  skip_spaces();
  if (line.empty()) return true;
  const auto c = static_cast<unsigned char>(line.front());
  return c < 0x80 && (std::isalnum(c) != 0 || std::string_view("_-\"']").find(line.front()) != line.npos);
}

// Returns the place behind a text in three quotation marks that begins here, or the end of all.
std::size_t end_of_long_text(std::string_view text, std::size_t begin) {
  const char quote = text[begin];
  const std::string marks(3, quote);
  for (std::size_t n = begin + 3; n < text.size(); ++n) {
    if (text[n] == '\\' && quote == '"') {
      ++n;
    } else if (text.substr(n, 3) == marks) {
      // One or two more belong to the text.
      n += 3;
      while (n < text.size() && text[n] == quote) ++n;
      return n;
    }
  }
  return text.size();
}

}  // namespace

TomlFault hostile_toml(std::string_view text, bool has_long_texts) {
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  std::size_t line = 1;
  int dots = 0;
  std::string open;  // brackets
  char quote = 0;
  const TomlFault no_name{1, "expected the name of a table in the brackets"};
  if (!is_table_name(text)) return no_name;
  for (std::size_t n = 0; n < text.size(); ++n) {
    const char c = text[n];
    if (c == '\n') {
      ++line;
      dots = 0;
      quote = 0;
      if (open.empty() && !is_table_name(text.substr(n + 1))) return {line, no_name.what};
    } else if ((quote == 0 || !has_long_texts) && (c == '"' || c == '\'') &&
               (text.substr(n, 3) == R"(""")" || text.substr(n, 3) == "'''")) {
      if (!has_long_texts) return {line, "expected a text on one line", true};
      const std::size_t end = end_of_long_text(text, n);
      line += static_cast<std::size_t>(std::count(text.begin() + static_cast<std::ptrdiff_t>(n),
                                                  text.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
      n = end - 1;
    } else if (quote != 0) {
      if (c == quote) quote = 0;
      if (c == '\\' && quote == '"' && text.substr(n + 1, 1) != "\n") ++n;
    } else if (c == '"' || c == '\'') {
      // The parser reads a quotation mark within a number as a part of it.
      if (n > 0 && kBeforeText.find(text[n - 1]) == kBeforeText.npos)
        return {line, "expected a separator before the quotation mark"};
      quote = c;
    } else if (c == '#') {
      n = std::min(text.find('\n', n), text.size()) - 1;
    } else if (static_cast<unsigned char>(c) >= 0x80) {
      return {line, "expected letters of ASCII outside of texts and comments"};
    } else if (c == ':' || (c == '-' && n > 0 && std::isdigit(static_cast<unsigned char>(text[n - 1])) != 0)) {
      return {line, "expected a number, a text, a list or true or false, not a date or time", true};
    } else if (c == '.') {
      if (++dots > kMostDots) return {line, "expected keys with fewer dots", true};
    } else if (c == ',' || c == '=' || c == '[' || c == ']' || c == '{' || c == '}') {
      dots = 0;
      if (c == '[' || c == '{') {
        open += c;
      } else if (c == ']' || c == '}') {
        if (open.empty() || open.back() != (c == ']' ? '[' : '{')) return {line, "expected brackets in pairs"};
        open.pop_back();
      }
    }
  }
  return {};
}

}  // namespace vpe::base
