#include "relief/spec.h"

#include <algorithm>
#include <array>

#include "vpe/base/quote.h"

namespace relief {

namespace {

constexpr std::array<std::string_view, 8> kKindWords{"crater", "ramp", "pad",   "trench",
                                                     "dune",   "dam",  "flood", "noise"};

std::string text_of(const ReliefSpec& spec, std::size_t key) {
  return vpe::core::print_value(relief_keys().infos()[key], relief_keys().get(key, spec));
}

// Returns what is wrong with how the area is given.
std::string problem_of_area(const ReliefSpec& spec) {
  const bool has_polygon = !spec.polygon.empty();
  switch (spec.kind) {
    case ReliefKind::kFlood:
      if (spec.radius_m.has_value() != has_polygon) return "";
      return "expected radius_m or polygon in a flood, one of both";
    case ReliefKind::kPad:
    case ReliefKind::kNoise:
      if (spec.radius_m.has_value() == spec.length_m.has_value())
        return "expected radius_m, or length_m and width_m, one of both";
      if (spec.width_m && !spec.length_m) return "width_m: expected length_m beside it";
      return "";
    default: return "";
  }
}

}  // namespace

bool operator==(const ReliefSpec& a, const ReliefSpec& b) {
  for (std::size_t key = 0; key < relief_keys().infos().size(); ++key) {
    if (text_of(a, key) != text_of(b, key)) return false;
  }
  return true;
}

std::string_view kind_word(ReliefKind kind) { return kKindWords[static_cast<std::size_t>(kind)]; }

std::string keys_of(ReliefKind kind) {
  std::vector<std::string_view> names;
  for (std::size_t key = 0; key < relief_keys().infos().size(); ++key) {
    if (has_key(kind, key)) names.push_back(relief_keys().infos()[key].name);
  }
  return vpe::core::join(names);
}

Mode usual_mode(ReliefKind kind) {
  switch (kind) {
    case ReliefKind::kRamp:
    case ReliefKind::kPad: return Mode::kReplace;
    case ReliefKind::kDam:
    case ReliefKind::kFlood: return Mode::kMax;
    default: return Mode::kAdd;
  }
}

std::string set_key(ReliefSpec& spec, std::size_t key, std::string_view text) {
  const vpe::core::KeyInfo& info = relief_keys().infos()[key];
  std::string problem;
  const auto value = vpe::core::parse_value(info, text, problem);
  if (value) {
    relief_keys().set(key, spec, *value);
    return "";
  }
  if (!problem.empty()) return std::string(info.name) + ": " + problem;
  return std::string(info.name) + ": expected " + vpe::core::allowed_text(info) + ", found " +
         vpe::base::quote_text(text);
}

std::string problem_of(const ReliefSpec& spec) {
  static const ReliefSpec kUsual;
  const auto& keys = relief_keys();
  for (std::size_t key = 0; key < keys.infos().size(); ++key) {
    const vpe::core::KeyInfo& info = keys.infos()[key];
    if (!vpe::core::is_allowed(info, keys.get(key, spec))) {
      return std::string(info.name) + ": expected " + vpe::core::allowed_text(info) + ", found " +
             vpe::base::quote_text(text_of(spec, key));
    }
  }
  for (std::size_t key = 0; key < keys.infos().size(); ++key) {
    const vpe::core::KeyInfo& info = keys.infos()[key];
    const bool is_word_or_number = std::holds_alternative<vpe::core::NumberOrWord>(keys.get(key, spec));
    const bool is_given = text_of(spec, key) != text_of(kUsual, key);
    if (is_given && !has_key(spec.kind, key)) {
      return std::string(info.name) + ": a " + std::string(kind_word(spec.kind)) +
             " has no such key; its keys are " + keys_of(spec.kind);
    }
    if (!is_given && is_word_or_number && needs_key(spec.kind, key))
      return std::string(info.name) + " is missing in a " + std::string(kind_word(spec.kind));
  }
  if (spec.mode.value_or(usual_mode(spec.kind)) == Mode::kAdd && (spec.level_m || spec.rise_m != 0))
    return "level_m and rise_m: expected none where the mode is add, which counts from the ground";
  return problem_of_area(spec);
}

}  // namespace relief
