#include "vpe/explore/files/key_file.h"

#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "vpe/base/number.h"

namespace vpe::explore {

namespace {

constexpr std::size_t kMaxShown = 60;

template <class... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};
template <class... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

std::string_view table_of(std::string_view name) { return name.substr(0, name.find('.')); }
std::string_view key_of(std::string_view name) { return name.substr(name.find('.') + 1); }

template <class Words>
std::string list(const Words& words) {
  std::string text;
  for (const std::string_view word : words) text.append(text.empty() ? "" : ", ").append(word);
  return text;
}

std::string quoted(const std::string& text) {
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

std::array<double*, 6> numbers_of(mars::Pose& pose) {
  return {&pose.lon_deg, &pose.lat_deg, &pose.alt_m, &pose.yaw_deg, &pose.pitch_deg, &pose.roll_deg};
}

// What may stand in a pose that somebody wrote.
constexpr std::array<double, 6> kPoseLimits{360, 90, 1e15, 360, 90, 360};

std::string pose_text(std::optional<mars::Pose> pose) {
  if (!pose) return "[]";
  std::string text;
  for (const double* number : numbers_of(*pose))
    text += (text.empty() ? "[" : ", ") + base::format_number(*number);
  return text + "]";
}

std::string value_text(const KeyEntry& key) {
  return std::visit(Overloaded{[](const NumberKey& k) { return base::format_number(*k.value); },
                               [](const IntegerKey& k) { return std::to_string(*k.value); },
                               [](const SwitchKey& k) { return std::string(*k.value ? "true" : "false"); },
                               [](const ChoiceKey& k) {
                                 return quoted(std::string(k.words[static_cast<std::size_t>(k.read())]));
                               },
                               [](const TextKey& k) { return quoted(*k.value); },
                               [](const PoseKey& k) { return pose_text(*k.value); }},
                    key.member);
}

std::string allowed_text(const KeyEntry& key) {
  return std::visit(
      Overloaded{[](const NumberKey& k) {
                   return "a number from " + base::format_number(k.min) + " to " + base::format_number(k.max);
                 },
                 [](const IntegerKey& k) {
                   return "a whole number from " + std::to_string(k.min) + " to " + std::to_string(k.max);
                 },
                 [](const SwitchKey&) { return std::string("true or false"); },
                 [](const ChoiceKey& k) { return "one of " + list(k.words); },
                 [](const TextKey& k) { return std::string(k.grammar); },
                 [](const PoseKey&) {
                   return std::string(
                       "[longitude, latitude, altitude, yaw, pitch, roll] in degrees and metres, or []");
                 }},
      key.member);
}

// The node as a number; NaN for anything else.
double number_of(const toml::node& node) {
  if (const auto* value = node.as_floating_point()) return value->get();
  if (const auto* value = node.as_integer()) return static_cast<double>(value->get());
  return std::nan("");
}

bool set_pose(const toml::node& node, std::optional<mars::Pose>& pose) {
  const toml::array* list = node.as_array();
  if (list == nullptr) return false;
  if (list->empty()) {
    pose.reset();
    return true;
  }
  mars::Pose read;
  const std::array<double*, 6> numbers = numbers_of(read);
  if (list->size() != numbers.size()) return false;
  for (std::size_t n = 0; n < numbers.size(); ++n) {
    *numbers[n] = number_of((*list)[n]);
  }
  if (!is_pose(read)) return false;
  pose = read;
  return true;
}

bool set_word(const toml::node& node, const ChoiceKey& key) {
  const auto* word = node.as_string();
  if (word == nullptr) return false;
  const auto found = std::find(key.words.begin(), key.words.end(), word->get());
  if (found == key.words.end()) return false;
  key.write(static_cast<int>(found - key.words.begin()));
  return true;
}

// False when the node is not what the key allows.
bool set(const toml::node& node, const KeyEntry& key) {
  return std::visit(Overloaded{[&node](const NumberKey& k) {
                                 const double value = number_of(node);
                                 if (!(value >= k.min && value <= k.max)) return false;
                                 *k.value = value;
                                 return true;
                               },
                               [&node](const IntegerKey& k) {
                                 const auto* value = node.as_integer();
                                 if (value == nullptr || value->get() < k.min || value->get() > k.max)
                                   return false;
                                 *k.value = static_cast<int>(value->get());
                                 return true;
                               },
                               [&node](const SwitchKey& k) {
                                 const auto* value = node.as_boolean();
                                 if (value != nullptr) *k.value = value->get();
                                 return value != nullptr;
                               },
                               [&node](const ChoiceKey& k) { return set_word(node, k); },
                               [&node](const TextKey& k) {
                                 const auto* value = node.as_string();
                                 if (value == nullptr || !k.problem(value->get()).empty()) return false;
                                 *k.value = value->get();
                                 return true;
                               },
                               [&node](const PoseKey& k) { return set_pose(node, *k.value); }},
                    key.member);
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
  Reader(const std::string& file, std::span<const KeyEntry> keys) : file_(file), keys_(keys) {}

  void read(std::string_view text) const {
    toml::table top;
    try {
      top = toml::parse(text, file_);
    } catch (const toml::parse_error& e) {
      throw KeyFileError(file_ + ":" + std::to_string(e.source().begin.line) +
                         ": not TOML: " + std::string(e.description()) + "; correct it, or remove the file");
    }
    for (const auto& [name, node] : top) {
      const std::vector<std::string_view> known = keys_in(name.str());
      if (known.empty())
        fail(node, "unknown table or key '" + std::string(name.str()) + "'; tables are " + tables());
      const toml::table* table = node.as_table();
      if (table == nullptr)
        fail(node, "'" + std::string(name.str()) + "' is a table; its keys are " + list(known));
      for (const auto& [key, value] : *table)
        read_key(std::string(name.str()) + "." + std::string(key.str()), value);
    }
  }

 private:
  [[noreturn]] void fail(const toml::node& node, const std::string& what) const {
    throw KeyFileError(file_ + ":" + std::to_string(node.source().begin.line) + ": " + what);
  }

  void read_key(const std::string& name, const toml::node& node) const {
    const auto found =
        std::find_if(keys_.begin(), keys_.end(), [&name](const KeyEntry& key) { return key.name == name; });
    if (found == keys_.end()) {
      fail(node, "unknown key '" + name + "'; keys of [" + std::string(table_of(name)) + "] are " +
                     list(keys_in(table_of(name))));
    }
    if (!set(node, *found)) fail(node, name + ": expected " + allowed_text(*found) + ", found " + shown(node));
  }

  std::vector<std::string_view> keys_in(std::string_view table) const {
    std::vector<std::string_view> all;
    for (const KeyEntry& key : keys_) {
      if (table_of(key.name) == table) all.push_back(key_of(key.name));
    }
    return all;
  }

  std::string tables() const {
    std::vector<std::string_view> all;
    for (const KeyEntry& key : keys_) {
      if (all.empty() || all.back() != table_of(key.name)) all.push_back(table_of(key.name));
    }
    return list(all);
  }

  const std::string& file_;
  std::span<const KeyEntry> keys_;
};

}  // namespace

bool is_pose(const mars::Pose& pose) {
  mars::Pose copy = pose;
  const std::array<double*, 6> numbers = numbers_of(copy);
  for (std::size_t n = 0; n < numbers.size(); ++n) {
    if (!(std::abs(*numbers[n]) <= kPoseLimits[n])) return false;
  }
  return true;
}

void read_keys(std::string_view toml, const std::string& file, std::span<const KeyEntry> keys) {
  Reader(file, keys).read(toml);
}

std::string write_keys(std::span<const KeyEntry> keys, std::span<const KeyEntry> defaults,
                       KeysShown shown_keys) {
  std::string text;
  std::string_view table;
  for (std::size_t n = 0; n < keys.size(); ++n) {
    const KeyEntry& key = keys[n];
    if (table_of(key.name) != table) {
      table = table_of(key.name);
      text.append(text.empty() ? "[" : "\n[").append(table).append("]\n");
    }
    const std::string value = value_text(key);
    const std::string usual = value_text(defaults[n]);
    if (shown_keys == KeysShown::kChanged && value == usual) text += "# ";
    text.append(key_of(key.name)).append(" = ").append(value);
    text.append("  # ").append(key.meaning).append("; ").append(allowed_text(key));
    text.append("; default ").append(usual).append("\n");
  }
  return text;
}

}  // namespace vpe::explore
