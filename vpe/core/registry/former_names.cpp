#include "vpe/core/registry/former_names.h"

#include <algorithm>

namespace vpe::core {

std::span<const FormerName> former_names() {
  static constexpr FormerName kNames[] = {
      {NameKind::kBackend, "voxel", "ray"},
      {NameKind::kOption, "--convert", "--to-datum"},
      {NameKind::kOption, "--level", "--align"},
      {NameKind::kOption, "--mask-blunders", "--reject-outliers"},
      {NameKind::kOption, "--again", "--from-sidecar"},
      {NameKind::kOption, "--planes", "--aux-layers"},
      {NameKind::kOption, "--spots", "--hotspots"},
      {NameKind::kOptionValue, "--align=fit", "--align=plane"},
      {NameKind::kOptionValue, "--align=bend", "--align=edges"},
      {NameKind::kOptionValue, "--backend=voxel", "--backend=ray"},
      {NameKind::kSetting, "lod.rule", "lod.metric"},
      {NameKind::kSettingValue, "lod.metric=hitchner", "lod.metric=distance"},
      {NameKind::kSettingValue, "rays.mode=plain", "rays.mode=reference"},
      {NameKind::kPreferenceValue, "last.backend=voxel", "last.backend=ray"},
  };
  return kNames;
}

std::string_view current_name(NameKind kind, std::string_view name) {
  const auto names = former_names();
  const auto found = std::find_if(names.begin(), names.end(),
                                  [&](const FormerName& n) { return n.kind == kind && n.former == name; });
  return found == names.end() ? name : found->current;
}

std::string_view current_value(NameKind kind, std::string_view key, std::string_view value) {
  const auto is_of = [&](std::string_view assignment, std::string_view text) {
    return assignment.size() == key.size() + 1 + text.size() && assignment.starts_with(key) &&
           assignment[key.size()] == '=' && assignment.ends_with(text);
  };
  for (const FormerName& n : former_names()) {
    if (n.kind == kind && is_of(n.former, value)) return n.current.substr(n.current.find('=') + 1);
  }
  return value;
}

}  // namespace vpe::core
