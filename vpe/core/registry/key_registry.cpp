#include "vpe/core/registry/key_registry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "vpe/base/number.h"

namespace vpe::core {

namespace {

template <class... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};
template <class... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

bool is_allowed_pose(const mars::Pose& p) {
  const std::array<double, 6> numbers{p.lon_deg, p.lat_deg, p.alt_m, p.yaw_deg, p.pitch_deg, p.roll_deg};
  constexpr std::array<double, 6> kLimits{360, 90, 1e15, 360, 90, 360};
  for (std::size_t n = 0; n < numbers.size(); ++n) {
    if (!(std::abs(numbers[n]) <= kLimits[n])) return false;
  }
  return true;
}

std::string pose_text(const std::optional<mars::Pose>& pose) {
  if (!pose) return "[]";
  std::string text;
  for (const double number :
       {pose->lon_deg, pose->lat_deg, pose->alt_m, pose->yaw_deg, pose->pitch_deg, pose->roll_deg}) {
    text += (text.empty() ? "[" : ", ") + base::format_number(number);
  }
  return text + "]";
}

std::vector<std::string_view> texts(const ChoiceKey& choice) {
  std::vector<std::string_view> all;
  for (const KeyWord& w : choice.words) all.push_back(w.text);
  return all;
}

bool has_control_characters(std::string_view text) {
  return std::any_of(text.begin(), text.end(),
                     [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == '\x7f'; });
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

// Returns nullopt also for what is_allowed() refuses.
std::optional<KeyValue> read_value(const KeyInfo& key, std::string_view text, const SwitchWords& words) {
  return std::visit(Overloaded{
                        [&](const NumberKey&) -> std::optional<KeyValue> { return base::parse_number(text); },
                        [&](const NumberOrWordKey& k) -> std::optional<KeyValue> {
                          if (text == k.word) return NumberOrWord();
                          const std::optional<double> number = base::parse_number(text);
                          if (!number) return std::nullopt;
                          return NumberOrWord(number);
                        },
                        [&](const IntegerKey& k) -> std::optional<KeyValue> {
                          const std::optional<std::int64_t> value = base::parse_integer(text);
                          if (!value || *value < k.min || *value > k.max) return std::nullopt;
                          return static_cast<int>(*value);
                        },
                        [&](const SwitchKey&) -> std::optional<KeyValue> {
                          if (text != words.off && text != words.on) return std::nullopt;
                          return text == words.on;
                        },
                        [&](const ChoiceKey& k) -> std::optional<KeyValue> { return word_value(k, text); },
                        [&](const TextKey&) -> std::optional<KeyValue> { return std::string(text); },
                        [&](const TableKey&) -> std::optional<KeyValue> { return parse_level_table(text); },
                        [&](const PoseKey&) -> std::optional<KeyValue> { return std::nullopt; },
                    },
                    key.type);
}

}  // namespace

bool is_allowed(const KeyInfo& key, const KeyValue& value) {
  return std::visit(Overloaded{
                        [&](const NumberKey& k) {
                          const auto number = std::get<double>(value);
                          return number >= k.min && number <= k.max;
                        },
                        [&](const NumberOrWordKey& k) {
                          const std::optional<double> number = std::get<NumberOrWord>(value).number;
                          return !number || (*number >= k.min && *number <= k.max);
                        },
                        [&](const IntegerKey& k) {
                          const int number = std::get<int>(value);
                          return number >= k.min && number <= k.max;
                        },
                        [](const SwitchKey&) { return true; },
                        [&](const ChoiceKey& k) {
                          return std::any_of(k.words.begin(), k.words.end(),
                                             [&](const KeyWord& w) { return w.value == std::get<int>(value); });
                        },
                        [&](const TextKey& k) { return k.problem(std::get<std::string>(value)).empty(); },
                        [](const TableKey&) { return true; },
                        [&](const PoseKey&) {
                          const auto& pose = std::get<std::optional<mars::Pose>>(value);
                          return !pose || is_allowed_pose(*pose);
                        },
                    },
                    key.type);
}

std::optional<KeyValue> parse_value(const KeyInfo& key, std::string_view text, std::string& problem,
                                    const SwitchWords& words) {
  problem.clear();
  if (const auto* plain = std::get_if<TextKey>(&key.type)) {
    std::string value(text);
    problem = has_control_characters(text) ? "it holds control characters" : plain->problem(value);
    if (!problem.empty()) return std::nullopt;
    return value;
  }
  std::optional<KeyValue> value = read_value(key, text, words);
  if (value && !is_allowed(key, *value)) value.reset();
  return value;
}

std::string print_value(const KeyInfo& key, const KeyValue& value, const SwitchWords& words) {
  return std::visit(
      Overloaded{
          [&](const NumberKey&) { return base::format_number(std::get<double>(value)); },
          [&](const NumberOrWordKey& k) {
            const std::optional<double> number = std::get<NumberOrWord>(value).number;
            return number ? base::format_number(*number) : std::string(k.word);
          },
          [&](const IntegerKey&) { return std::to_string(std::get<int>(value)); },
          [&](const SwitchKey&) { return std::string(std::get<bool>(value) ? words.on : words.off); },
          [&](const ChoiceKey& k) {
            const auto found = std::find_if(k.words.begin(), k.words.end(),
                                            [&](const KeyWord& w) { return w.value == std::get<int>(value); });
            return found == k.words.end() ? std::string() : std::string(found->text);
          },
          [&](const TextKey&) { return std::get<std::string>(value); },
          [&](const TableKey&) { return format_level_table(std::get<LevelTable>(value)); },
          [&](const PoseKey&) { return pose_text(std::get<std::optional<mars::Pose>>(value)); },
      },
      key.type);
}

std::optional<int> word_value(const ChoiceKey& choice, std::string_view word) {
  const auto found =
      std::find_if(choice.words.begin(), choice.words.end(), [&](const KeyWord& w) { return w.text == word; });
  if (found == choice.words.end()) return std::nullopt;
  return found->value;
}

std::string allowed_text(const KeyInfo& key, const SwitchWords& words) {
  const std::string unit = key.unit.empty() ? "" : " " + std::string(key.unit);
  return std::visit(
      Overloaded{
          [&](const NumberKey& k) {
            return "a number from " + base::format_number(k.min) + " to " + base::format_number(k.max) + unit;
          },
          [&](const NumberOrWordKey& k) {
            return "a number from " + base::format_number(k.min) + " to " + base::format_number(k.max) + unit +
                   ", or " + std::string(k.word);
          },
          [&](const IntegerKey& k) {
            return "a whole number from " + std::to_string(k.min) + " to " + std::to_string(k.max) + unit;
          },
          [&](const SwitchKey&) { return std::string(words.allowed); },
          [](const ChoiceKey& k) { return "one of " + join(texts(k)); },
          [](const TextKey& k) { return k.grammar; },
          [](const TableKey&) { return level_table_grammar(); },
          [](const PoseKey&) {
            return std::string(
                "[longitude, latitude, altitude, yaw, pitch, roll] in degrees and metres, or []");
          },
      },
      key.type);
}

KeyValue within_limits(const KeyInfo& key, const KeyValue& value, const KeyValue& fallback) {
  if (const auto* number = std::get_if<NumberKey>(&key.type)) {
    const auto x = std::get<double>(value);
    return std::clamp(std::isfinite(x) ? x : std::get<double>(fallback), number->min, number->max);
  }
  if (const auto* whole = std::get_if<IntegerKey>(&key.type)) {
    return std::clamp(std::get<int>(value), whole->min, whole->max);
  }
  if (is_allowed(key, value)) return value;
  if (std::holds_alternative<PoseKey>(key.type)) return std::optional<mars::Pose>();
  return fallback;
}

std::string did_you_mean(std::string_view name, std::span<const KeyInfo> keys) {
  std::vector<std::string_view> near;
  for (const KeyInfo& key : keys) {
    const bool is_part = name.size() >= 3 && key.name.find(name) != std::string_view::npos;
    const std::size_t typos = std::max<std::size_t>(1, key.name.size() / 4);
    if (is_part || edit_distance(name, key.name) <= typos) near.push_back(key.name);
  }
  return near.empty() ? "" : "did you mean " + join(near) + "?";
}

std::string join(std::span<const std::string_view> words) {
  std::string text;
  for (const std::string_view w : words) text.append(text.empty() ? "" : ", ").append(w);
  return text;
}

}  // namespace vpe::core
