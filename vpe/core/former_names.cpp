#include "vpe/core/former_names.h"

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
      {NameKind::kOptionValue, "--align=fit", "--align=plane"},
      {NameKind::kOptionValue, "--align=bend", "--align=edges"},
      {NameKind::kOptionValue, "--backend=voxel", "--backend=ray"},
      {NameKind::kSetting, "lod.rule", "lod.metric"},
      {NameKind::kSettingValue, "lod.metric=hitchner", "lod.metric=distance"},
      {NameKind::kSettingValue, "rays.mode=plain", "rays.mode=reference"},
  };
  return kNames;
}

std::string_view current_name(NameKind kind, std::string_view name) {
  const auto names = former_names();
  const auto found = std::find_if(names.begin(), names.end(),
                                  [&](const FormerName& n) { return n.kind == kind && n.former == name; });
  return found == names.end() ? name : found->current;
}

}  // namespace vpe::core
