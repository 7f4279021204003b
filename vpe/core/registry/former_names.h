// The table of all names of earlier versions that are still accepted in files, scripts and on the command line.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace vpe::core {

enum class NameKind : std::uint8_t {
  kBackend,          // --backend, sidecars, logs
  kOption,           // of the command line and of --config files, with the dashes
  kOptionValue,      // "--OPTION=VALUE", with the current option
  kSetting,          // keys of --set and of `set` in flights
  kSettingValue,     // "KEY=VALUE", with the current key
  kPreference,       // "TABLE.KEY" of the files of `vpe explore`
  kPreferenceValue,  // "TABLE.KEY=VALUE", with the current key
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

// Returns the current value of a key or option, and any other value unchanged. `kind` is one of the kinds of
// values, `key` a current name.
std::string_view current_value(NameKind kind, std::string_view key, std::string_view value);

}  // namespace vpe::core
