#include "relief/spec_line.h"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "vpe/base/quote.h"

namespace relief {

namespace {

// Returns the name of a key without its unit.
std::string_view short_name(std::string_view name) {
  for (const std::string_view unit : {"_m", "_deg"}) {
    if (name.ends_with(unit)) name.remove_suffix(unit.size());
  }
  return name;
}

std::vector<vpe::core::KeyInfo> line_keys() {
  std::vector<vpe::core::KeyInfo> keys(relief_keys().infos().begin(), relief_keys().infos().end());
  for (vpe::core::KeyInfo& key : keys) key.name = short_name(key.name);
  return keys;
}

// Sets the keys of a line and returns them.
std::vector<std::size_t> set_keys(ReliefSpec& spec, std::string_view line) {
  constexpr std::string_view kSpaces = " \t";
  std::vector<std::size_t> given;
  for (;;) {
    line.remove_prefix(std::min(line.find_first_not_of(kSpaces), line.size()));
    if (line.empty()) return given;
    const std::string_view word = line.substr(0, line.find_first_of(kSpaces));
    line.remove_prefix(word.size());
    const std::size_t equals = word.find('=');
    if (equals == word.npos)
      throw std::invalid_argument("expected KEY=VALUE, found " + vpe::base::quote_text(word));
    const std::string_view name = word.substr(0, equals);
    const auto key = find_line_key(name);
    if (!key) {
      const std::string hint = vpe::core::did_you_mean(name, line_keys());
      throw std::invalid_argument("unknown key " + vpe::base::quote_text(name) +
                                  (hint.empty() ? "" : "; " + hint));
    }
    if (std::ranges::find(given, *key) != given.end())
      throw std::invalid_argument(std::string(name) + " is there twice");
    const std::string problem = set_key(spec, *key, word.substr(equals + 1));
    if (!problem.empty()) throw std::invalid_argument(problem);
    given.push_back(*key);
  }
}

void require_sound(const ReliefSpec& spec) {
  const std::string problem = problem_of(spec);
  if (!problem.empty()) throw std::invalid_argument(problem);
}

}  // namespace

std::optional<std::size_t> find_line_key(std::string_view name) {
  const auto infos = relief_keys().infos();
  for (std::size_t key = 0; key < infos.size(); ++key) {
    if (infos[key].name == "name") continue;
    if (infos[key].name == name || short_name(infos[key].name) == name) return key;
  }
  return std::nullopt;
}

ReliefSpec parse_relief_line(std::string_view line) {
  ReliefSpec spec;
  const std::vector<std::size_t> given = set_keys(spec, line);
  for (std::size_t key = 0; key < relief_keys().infos().size(); ++key) {
    if (needs_key(spec.kind, key) && std::ranges::find(given, key) == given.end())
      throw std::invalid_argument(std::string(short_name(relief_keys().infos()[key].name)) + " is missing");
  }
  require_sound(spec);
  return spec;
}

ReliefSpec changed_by_line(ReliefSpec spec, std::string_view line) {
  set_keys(spec, line);
  require_sound(spec);
  return spec;
}

std::string to_line(const ReliefSpec& spec) {
  static const ReliefSpec kUsual;
  const auto& keys = relief_keys();
  std::string line;
  for (std::size_t key = 0; key < keys.infos().size(); ++key) {
    const vpe::core::KeyInfo& info = keys.infos()[key];
    const std::string text = vpe::core::print_value(info, keys.get(key, spec));
    const bool is_usual = text == vpe::core::print_value(info, keys.get(key, kUsual));
    if (info.name == "name" || (is_usual && !needs_key(spec.kind, key))) continue;
    line += (line.empty() ? "" : " ") + std::string(short_name(info.name)) + "=" + text;
  }
  return line;
}

}  // namespace relief
