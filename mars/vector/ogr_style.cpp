#include "mars/vector/ogr_style.h"

#include <algorithm>
#include <cctype>
#include <string_view>

namespace mars {
namespace {

// Reads a style string from its beginning.
class StyleText {
 public:
  explicit StyleText(std::string_view text) : text_(text) {}

  bool at_end() {
    skip_blanks();
    return at_ >= text_.size();
  }

  bool take(char c) {
    if (at_end() || text_[at_] != c) return false;
    ++at_;
    return true;
  }

  std::string word() {
    skip_blanks();
    const std::size_t begin = at_;
    while (at_ < text_.size() && std::isalnum(static_cast<unsigned char>(text_[at_])) != 0) ++at_;
    return std::string(text_.substr(begin, at_ - begin));
  }

  // A quoted text with \" within, or all up to the next comma or parenthesis.
  std::optional<std::string> value() {
    if (!take('"')) {
      const std::size_t end = std::min(text_.find_first_of(",)", at_), text_.size());
      std::string plain(text_.substr(at_, end - at_));
      at_ = end;
      while (plain.ends_with(' ')) plain.pop_back();
      return plain;
    }
    std::string quoted;
    for (; at_ < text_.size(); ++at_) {
      if (text_[at_] == '"') {
        ++at_;
        return quoted;
      }
      if (text_[at_] == '\\' && at_ + 1 < text_.size() && (text_[at_ + 1] == '"' || text_[at_ + 1] == '\\'))
        ++at_;
      quoted += text_[at_];
    }
    return std::nullopt;
  }

 private:
  void skip_blanks() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

std::optional<StyleTool> read_tool(StyleText& text) {
  StyleTool tool;
  tool.name = text.word();
  std::ranges::transform(tool.name, tool.name.begin(),
                         [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  if (tool.name.empty() || !text.take('(')) return std::nullopt;
  if (text.take(')')) return tool;
  do {
    std::string key = text.word();
    std::ranges::transform(key, key.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (key.empty() || !text.take(':')) return std::nullopt;
    auto value = text.value();
    if (!value) return std::nullopt;
    tool.parameters.emplace_back(std::move(key), std::move(*value));
  } while (text.take(','));
  if (!text.take(')')) return std::nullopt;
  return tool;
}

}  // namespace

std::optional<std::vector<StyleTool>> parse_ogr_style(const std::string& text) {
  std::vector<StyleTool> tools;
  if (text.starts_with('@')) return tools;
  StyleText rest(text);
  while (!rest.at_end()) {
    auto tool = read_tool(rest);
    if (!tool) return std::nullopt;
    tools.push_back(std::move(*tool));
    if (!rest.take(';') && !rest.at_end()) return std::nullopt;
  }
  return tools;
}

}  // namespace mars
