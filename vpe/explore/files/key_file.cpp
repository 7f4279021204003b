#include "vpe/explore/files/key_file.h"

#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "vpe/base/number.h"
#include "vpe/base/toml_table.h"
#include "vpe/core/registry/former_names.h"
#include "vpe/explore/files/toml_text.h"

namespace vpe::explore {

namespace {

constexpr std::size_t kMaxShown = 60;
constexpr core::SwitchWords kTomlSwitch{"false", "true", "true or false"};

std::string_view table_of(std::string_view name) { return name.substr(0, name.find('.')); }
std::string_view key_of(std::string_view name) { return name.substr(name.find('.') + 1); }

std::string value_text(const core::KeyInfo& key, const core::KeyValue& value) {
  const std::string text = core::print_value(key, value, kTomlSwitch);
  const bool is_word =
      std::holds_alternative<core::ChoiceKey>(key.type) || std::holds_alternative<core::TextKey>(key.type);
  return is_word ? toml_string(text) : text;
}

// Returns NaN for a node that is not a number.
double number_of(const toml::node& node) {
  if (const auto* value = node.as_floating_point()) return value->get();
  if (const auto* value = node.as_integer()) return static_cast<double>(value->get());
  return std::nan("");
}

// Returns nullopt for a node that is neither six numbers nor an empty list.
std::optional<core::KeyValue> pose_value(const toml::node& node) {
  const toml::array* list = node.as_array();
  if (list == nullptr) return std::nullopt;
  if (list->empty()) return std::optional<mars::Pose>();
  mars::Pose pose;
  const std::array<double*, 6> numbers{&pose.lon_deg, &pose.lat_deg,   &pose.alt_m,
                                       &pose.yaw_deg, &pose.pitch_deg, &pose.roll_deg};
  if (list->size() != numbers.size()) return std::nullopt;
  for (std::size_t n = 0; n < numbers.size(); ++n) *numbers[n] = number_of((*list)[n]);
  return std::optional<mars::Pose>(pose);
}

// Returns nullopt for a node of another type than the key's. The value may be one that is not allowed.
std::optional<core::KeyValue> value_of(const toml::node& node, const core::KeyInfo& key) {
  if (std::holds_alternative<core::NumberKey>(key.type)) return number_of(node);
  if (std::holds_alternative<core::PoseKey>(key.type)) return pose_value(node);
  if (const auto* limits = std::get_if<core::IntegerKey>(&key.type)) {
    const auto* value = node.as_integer();
    if (value == nullptr || value->get() < limits->min || value->get() > limits->max) return std::nullopt;
    return static_cast<int>(value->get());
  }
  if (std::holds_alternative<core::SwitchKey>(key.type)) {
    const auto* value = node.as_boolean();
    if (value == nullptr) return std::nullopt;
    return value->get();
  }
  const auto* text = node.as_string();
  if (text == nullptr) return std::nullopt;
  if (const auto* choice = std::get_if<core::ChoiceKey>(&key.type)) {
    return core::word_value(*choice,
                            core::current_value(core::NameKind::kPreferenceValue, key.name, text->get()));
  }
  if (std::holds_alternative<core::TextKey>(key.type)) return text->get();
  std::string problem;
  return core::parse_value(key, text->get(), problem);
}

std::string shown(const toml::node& node) {
  if (const auto* value = node.as_floating_point()) return base::format_number(value->get());
  std::ostringstream out;
  node.visit([&out](const auto& value) { out << value; });
  std::string text = std::move(out).str();
  if (text.size() > kMaxShown) text = text.substr(0, kMaxShown) + " ...";
  return text;
}

class Reader {
 public:
  Reader(const std::string& file, std::span<const core::KeyInfo> keys,
         const std::function<void(std::size_t, const core::KeyValue&)>& set)
      : file_(file), keys_(keys), set_(set) {}

  void read(std::string_view text) const {
    toml::table top;
    try {
      top = base::parse_toml(text, file_);
    } catch (const std::runtime_error& e) {
      throw KeyFileError(std::string(e.what()) + "; correct it, or remove the file");
    }
    for (const auto& [name, node] : top) {
      const std::vector<std::string_view> known = keys_in(name.str());
      if (known.empty())
        fail(node, "unknown table or key '" + std::string(name.str()) + "'; tables are " + tables());
      const toml::table* table = node.as_table();
      if (table == nullptr)
        fail(node, "'" + std::string(name.str()) + "' is a table; its keys are " + core::join(known));
      for (const auto& [key, value] : *table)
        read_key(std::string(name.str()) + "." + std::string(key.str()), value);
    }
  }

 private:
  [[noreturn]] void fail(const toml::node& node, const std::string& what) const {
    throw KeyFileError(file_ + ":" + std::to_string(node.source().begin.line) + ": " + what);
  }

  void read_key(const std::string& former_or_current, const toml::node& node) const {
    const std::string name(core::current_name(core::NameKind::kPreference, former_or_current));
    const auto found = std::find_if(keys_.begin(), keys_.end(),
                                    [&name](const core::KeyInfo& key) { return key.name == name; });
    if (found == keys_.end()) {
      fail(node, "unknown key '" + name + "'; keys of [" + std::string(table_of(name)) + "] are " +
                     core::join(keys_in(table_of(name))));
    }
    const std::optional<core::KeyValue> value = value_of(node, *found);
    if (!value || !core::is_allowed(*found, *value)) {
      fail(node, name + ": expected " + core::allowed_text(*found, kTomlSwitch) + ", found " + shown(node));
    }
    set_(static_cast<std::size_t>(found - keys_.begin()), *value);
  }

  std::vector<std::string_view> keys_in(std::string_view table) const {
    std::vector<std::string_view> all;
    for (const core::KeyInfo& key : keys_) {
      if (table_of(key.name) == table) all.push_back(key_of(key.name));
    }
    return all;
  }

  std::string tables() const {
    std::vector<std::string_view> all;
    for (const core::KeyInfo& key : keys_) {
      if (all.empty() || all.back() != table_of(key.name)) all.push_back(table_of(key.name));
    }
    return core::join(all);
  }

  const std::string& file_;
  std::span<const core::KeyInfo> keys_;
  const std::function<void(std::size_t, const core::KeyValue&)>& set_;
};

}  // namespace

void read_keys(std::string_view toml, const std::string& file, std::span<const core::KeyInfo> keys,
               const std::function<void(std::size_t, const core::KeyValue&)>& set) {
  Reader(file, keys, set).read(toml);
}

std::string write_keys(std::span<const core::KeyInfo> keys, std::span<const core::KeyValue> values,
                       std::span<const core::KeyValue> defaults, KeysShown shown_keys) {
  std::string text;
  std::string_view table;
  for (std::size_t n = 0; n < keys.size(); ++n) {
    const core::KeyInfo& key = keys[n];
    if (table_of(key.name) != table) {
      table = table_of(key.name);
      text.append(text.empty() ? "[" : "\n[").append(table).append("]\n");
    }
    const std::string usual = value_text(key, defaults[n]);
    const std::string value = value_text(key, core::within_limits(key, values[n], defaults[n]));
    if (shown_keys == KeysShown::kChanged && value == usual) text += "# ";
    text.append(key_of(key.name)).append(" = ").append(value);
    text.append("  # ").append(key.meaning).append("; ").append(core::allowed_text(key, kTomlSwitch));
    text.append("; default ").append(usual).append("\n");
  }
  return text;
}

}  // namespace vpe::explore
