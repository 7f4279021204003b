#include "vpe/base/toml_table.h"

#include <algorithm>
#include <stdexcept>

#include "vpe/base/number.h"
#include "vpe/base/quote.h"
#include "vpe/base/toml_fault.h"

namespace vpe::base {

namespace {

std::string toml_found(const toml::node& node) {
  if (const auto* value = node.as_floating_point()) return format_number(value->get());
  if (const auto* value = node.as_integer()) return std::to_string(value->get());
  if (const auto* value = node.as_boolean()) return value->get() ? "true" : "false";
  if (const auto* value = node.as_string()) return quote_text(value->get());
  if (const auto* value = node.as_array()) return "a list of " + std::to_string(value->size());
  return "a table";
}

std::string words_text(std::initializer_list<std::string_view> words, std::string_view last) {
  std::string all;
  for (std::size_t n = 0; n < words.size(); ++n) {
    if (n > 0) all += n + 1 == words.size() ? last : ", ";
    all += words.begin()[n];
  }
  return all;
}

std::string_view line_of(std::string_view text, std::size_t number) {
  for (std::size_t n = 1; n < number; ++n) {
    const std::size_t end = text.find('\n');
    if (end == text.npos) return {};
    text.remove_prefix(end + 1);
  }
  return text.substr(0, text.find_first_of("\r\n"));
}

}  // namespace

toml::table parse_toml(std::string_view text, const std::string& file, bool has_long_texts) {
  if (const TomlFault fault = hostile_toml(text, has_long_texts); fault.line != 0)
    throw std::runtime_error(file + ":" + std::to_string(fault.line) + (fault.is_toml ? ": " : ": not TOML: ") +
                             std::string(fault.what) + ", found " + quote_text(line_of(text, fault.line)));
  try {
    return toml::parse(text, file);
  } catch (const toml::parse_error& e) {
    throw std::runtime_error(file + ":" + std::to_string(e.source().begin.line) +
                             ": not TOML: " + std::string(e.description()));
  }
}

std::string TomlTable::where() const {
  return file_ + ":" + std::to_string(std::max<std::uint32_t>(1, table_.source().begin.line));
}

void TomlTable::fail(const toml::node& node, const std::string& what) const {
  throw std::runtime_error(file_ + ":" + std::to_string(std::max<std::uint32_t>(1, node.source().begin.line)) +
                           ": " + what);
}

void TomlTable::fail_expecting(const toml::node& node, std::string_view what,
                               const std::string& expected) const {
  fail(node, std::string(what) + ": expected " + expected + ", found " + toml_found(node));
}

void TomlTable::require_known(std::initializer_list<std::string_view> keys) const {
  for (const auto& [key, node] : table_) {
    if (std::ranges::find(keys, key.str()) == keys.end())
      fail(node, "unknown key " + quote_text(key.str()) + " in " + std::string(title_) + "; keys are " +
                     words_text(keys, " and "));
  }
}

const toml::node& TomlTable::at(std::string_view key) const {
  const toml::node* node = table_.get(key);
  if (node == nullptr) fail(std::string(key) + " is missing in " + std::string(title_));
  return *node;
}

double TomlTable::number_of(const toml::node& node, std::string_view what, const NumberRange& range) const {
  const auto* real = node.as_floating_point();
  const auto* whole = node.as_integer();
  const double value = real != nullptr ? real->get() : whole != nullptr ? static_cast<double>(whole->get()) : 0;
  if ((real == nullptr && whole == nullptr) || !is_within(value, range))
    fail_expecting(node, what, range_text(range));
  return value;
}

double TomlTable::number(std::string_view key, const NumberRange& range) const {
  return number_of(at(key), key, range);
}

std::int64_t TomlTable::integer(std::string_view key, std::int64_t least, std::int64_t most) const {
  const toml::node& node = at(key);
  const auto* value = node.as_integer();
  if (value == nullptr || value->get() < least || value->get() > most)
    fail_expecting(node, key, "an integer in [" + std::to_string(least) + ", " + std::to_string(most) + "]");
  return value->get();
}

std::string TomlTable::text(std::string_view key, std::string (*problem_of)(std::string_view)) const {
  const toml::node& node = at(key);
  const auto* value = node.as_string();
  if (value == nullptr) fail_expecting(node, key, "a text");
  const std::string problem = problem_of(value->get());
  if (!problem.empty()) fail(node, std::string(key) + ": " + problem + ", found " + toml_found(node));
  return value->get();
}

std::size_t TomlTable::choice(std::string_view key, std::initializer_list<std::string_view> words) const {
  const toml::node& node = at(key);
  const auto* value = node.as_string();
  const auto found = value == nullptr ? words.end() : std::ranges::find(words, value->get());
  if (found == words.end()) fail_expecting(node, key, words_text(words, " or "));
  return static_cast<std::size_t>(found - words.begin());
}

bool TomlTable::truth(std::string_view key) const {
  const toml::node& node = at(key);
  const auto* value = node.as_boolean();
  if (value == nullptr) fail_expecting(node, key, "true or false");
  return value->get();
}

const toml::array& TomlTable::list(std::string_view key, std::string_view of) const {
  const toml::node& node = at(key);
  const toml::array* value = node.as_array();
  if (value == nullptr || value->empty()) fail_expecting(node, key, "a list of " + std::string(of));
  return *value;
}

const toml::array& TomlTable::list_of(const toml::node& node, std::string_view what, std::size_t least,
                                      std::size_t most, std::string_view form) const {
  const toml::array* parts = node.as_array();
  if (parts == nullptr || parts->size() < least || parts->size() > most)
    fail_expecting(node, what, std::string(form));
  return *parts;
}

}  // namespace vpe::base
