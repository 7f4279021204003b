#include "vpe/explore/files/text_lines.h"

#include <algorithm>

#include "vpe/base/number.h"
#include "vpe/base/quote.h"

namespace vpe::explore {

namespace {

constexpr std::string_view kBlanks = " \t\r\v\f";

bool is_control(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte < 0x20 || byte == 0x7f;
}

}  // namespace

std::vector<std::string_view> lines_of(std::string_view text) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    if (line.ends_with('\r')) line.remove_suffix(1);
    lines.push_back(line);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return lines;
}

std::vector<std::string> split_words(std::string_view line, std::string& fault) {
  std::vector<std::string> words;
  const auto ends_word = [&](std::size_t at) {
    return at == line.size() || line[at] == '#' || kBlanks.find(line[at]) != std::string_view::npos;
  };
  for (std::size_t at = line.find_first_not_of(kBlanks); at < line.size() && line[at] != '#';
       at = line.find_first_not_of(kBlanks, at)) {
    std::string& word = words.emplace_back();
    if (line[at] != '"') {
      while (!ends_word(at)) word += line[at++];
      continue;
    }
    for (++at; at < line.size() && line[at] != '"'; ++at) {
      if (line[at] == '\\' && at + 1 < line.size()) ++at;
      word += line[at];
    }
    if (at == line.size()) {
      fault = "a closing quote after " + base::quote_text(word);
      return {};
    }
    if (!ends_word(++at)) {
      fault = "a blank after a closing quote, found " + base::quote_text(line.substr(at));
      return {};
    }
  }
  return words;
}

std::string as_word(std::string_view text) {
  if (!text.empty() && text.find_first_of(" \t\r\v\f#\"") == std::string_view::npos) return std::string(text);
  std::string word = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') word += '\\';
    word += c;
  }
  return word + "\"";
}

std::optional<double> number_word(std::string_view word, std::string_view what, double min, double max,
                                  std::string& fault) {
  const std::optional<double> number = base::parse_number(word);
  if (number && *number >= min && *number <= max) return number;
  fault = std::string(what) + " from " + base::format_number(min) + " to " + base::format_number(max) +
          ", found " + base::quote_text(word);
  return std::nullopt;
}

bool is_one_line(std::string_view text) { return std::none_of(text.begin(), text.end(), is_control); }

}  // namespace vpe::explore
