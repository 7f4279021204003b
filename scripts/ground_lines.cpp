#include "scripts/ground_lines.h"

#include <stdexcept>
#include <variant>

#include "relief/spec_line.h"
#include "vpe/base/number.h"

namespace scripts {

using relief::ReliefSpec;
using vpe::base::format_number;
using vpe::base::parse_number;

namespace {

// Returns "NAME is there a second time" for a time that a name has already, else "".
std::string second_line(const std::map<std::string, double>& times_s, const std::string& name, double time_s) {
  const auto last = times_s.find(name);
  if (last == times_s.end() || last->second != time_s) return "";
  return "one line of " + quote(name) + " at " + format_number(time_s) + " s, found a second one";
}

const vpe::core::NumberOrWord* number_or_word(const vpe::core::KeyValue& value) {
  return std::get_if<vpe::core::NumberOrWord>(&value);
}

// Returns what keeps a relief from changing smoothly, or "".
std::string problem_of_change(const ReliefSpec& before, const ReliefSpec& after) {
  const auto& keys = relief::relief_keys();
  for (std::size_t key = 0; key < keys.infos().size(); ++key) {
    const vpe::core::KeyInfo& info = keys.infos()[key];
    const vpe::core::KeyValue was = keys.get(key, before);
    const vpe::core::KeyValue is = keys.get(key, after);
    const std::string was_text = vpe::core::print_value(info, was);
    const std::string is_text = vpe::core::print_value(info, is);
    if (is_text == was_text) continue;
    if (info.name == "spacing_m")
      return "spacing in the line with kind alone, since the distance of posts does not change";
    const vpe::core::NumberOrWord* const number = number_or_word(was);
    if (number != nullptr && number->number.has_value() != number_or_word(is)->number.has_value()) {
      return std::string(info.name) + " as a number, or as auto, in both lines of a change: it was " +
             was_text + " before, found " + is_text;
    }
  }
  return "";
}

}  // namespace

std::string GroundLines::add_relief(double time_s, const Words& words, std::vector<ReliefCommand>& lines) {
  if (words.empty() || words[0].empty() || words[0].size() > relief::kMostNameBytes) {
    return "the name of a relief, 1 to " + std::to_string(relief::kMostNameBytes) + " bytes, after \"relief\"";
  }
  const std::string& name = words[0];
  ReliefCommand command{time_s, name, "", std::nullopt};
  bool is_new = false;
  for (const std::string& word : std::span(words).subspan(1)) {
    const std::optional<KeyValue> pair = split_key_value(word);
    if (pair && pair->key == "show") {
      if (command.is_shown) return "show once, found it again";
      if (pair->value != "on" && pair->value != "off")
        return "show=on or show=off, found " + quote(pair->value);
      command.is_shown = pair->value == "on";
      continue;
    }
    is_new = is_new || (pair && pair->key == "kind");
    command.keys.append(command.keys.empty() ? "" : " ").append(word);
  }
  const auto known = reliefs_.find(name);
  if (known == reliefs_.end() && !is_new)
    return "kind=.. with all keys that it needs in the first line of the relief " + quote(name);
  if (command.keys.empty() && !command.is_shown)
    return "keys of a relief, or show=on or show=off, after " + quote(name);
  if (const std::string problem = second_line(relief_times_s_, name, time_s); !problem.empty()) return problem;
  ReliefSpec spec;
  try {
    spec = is_new ? relief::parse_relief_line(command.keys) : changed_by_line(known->second, command.keys);
  } catch (const std::invalid_argument& e) {
    return "a relief of this program: " + std::string(e.what());
  }
  if (!is_new) {
    if (const std::string problem = problem_of_change(known->second, spec); !problem.empty()) return problem;
  }
  reliefs_[name] = std::move(spec);
  relief_times_s_[name] = time_s;
  lines.push_back(std::move(command));
  return "";
}

std::string GroundLines::add_patch(double time_s, const Words& words, std::vector<PatchCommand>& lines) {
  if (words.empty() || words[0].empty()) return "a planet, a raster or a file *.relief.toml after \"patch\"";
  Field mix{"mix", 0, 1};
  for (const std::string& word : std::span(words).subspan(1)) {
    const std::optional<KeyValue> pair = split_key_value(word);
    if (!pair || pair->key != mix.key) return "mix=NUMBER, found " + quote(word);
    if (mix.given) return "mix once, found it again";
    if (!read(mix, pair->value)) return what_is_allowed(mix) + ", found " + quote(pair->value);
    mix.given = true;
  }
  if (!mix.given) return what_is_allowed(mix) + " after " + quote(words[0]);
  if (const std::string problem = second_line(patch_times_s_, words[0], time_s); !problem.empty())
    return problem;
  patch_times_s_[words[0]] = time_s;
  lines.push_back({time_s, words[0], mix.value});
  return "";
}

}  // namespace scripts
