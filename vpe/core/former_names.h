// The one table of former names that files and scripts of earlier versions may contain.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace vpe::core {

enum class NameKind : std::uint8_t {
  kBackend,       // --backend, sidecars, logs, preferences
  kOption,        // of the command line and of --config files, with the dashes
  kOptionValue,   // "--OPTION=VALUE"
  kSetting,       // keys of --set and of `set` in flights
  kSettingValue,  // "KEY=VALUE", with the current key
  kPreference,    // keys of the preferences file
};

struct FormerName {
  NameKind kind;
  std::string_view former;
  std::string_view current;
};

// Returns every former name that is still accepted.
std::span<const FormerName> former_names();

// Returns the current name of a former one, and any other name unchanged.
std::string_view current_name(NameKind kind, std::string_view name);

}  // namespace vpe::core
