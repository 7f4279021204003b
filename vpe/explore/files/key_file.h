// TOML files of keys that a registry declares (vpe/core/registry/key_registry.h): tables, keys and comments.
//
// A key "table.key" of the registry is the key `key` in [table]. The files are written by the program and
// edited by people, so each line carries its meaning, what is allowed, and the default.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "vpe/core/registry/key_registry.h"

namespace vpe::explore {

// Reports a file that is not TOML, or has an unknown key or a value that is not allowed. what() is
// "FILE:LINE: what is wrong, and what is allowed".
class KeyFileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The functions below handle keys of every registry; use the templates after them.

// Calls `set` with the index in `keys` and the value of each key that the text names. Accepts former names
// (vpe/core/registry/former_names.h). Throws KeyFileError; `set` may have been called for some keys then.
void read_keys(std::string_view toml, const std::string& file, std::span<const core::KeyInfo> keys,
               const std::function<void(std::size_t key, const core::KeyValue& value)>& set);

enum class KeysShown {
  kAll,
  kChanged,  // keys with default values become comments, so that they follow the defaults of later versions
};

// Returns the file of the given values, in the order of `keys`.
std::string write_keys(std::span<const core::KeyInfo> keys, std::span<const core::KeyValue> values,
                       std::span<const core::KeyValue> defaults, KeysShown shown);

// Sets the members of `owner` that the text names; the others stay. `file` is the name in messages. Throws
// KeyFileError; some members may have been set then.
template <class Owner>
void read_keys(std::string_view toml, const std::string& file, const core::KeyRegistry<Owner>& registry,
               Owner& owner) {
  read_keys(toml, file, registry.infos(),
            [&](std::size_t key, const core::KeyValue& value) { registry.set(key, owner, value); });
}

// Returns TOML that read_keys() reads back to the same values to the bit. Values that are not allowed are
// brought within the limits. A text that TOML cannot hold (not UTF-8) becomes empty.
template <class Owner>
std::string write_keys(const core::KeyRegistry<Owner>& registry, const Owner& owner, KeysShown shown) {
  return write_keys(registry.infos(), registry.values(owner), registry.values(Owner()), shown);
}

}  // namespace vpe::explore
