// A table of a TOML file whose keys and values are checked as they are read.
//
// Typical usage:
//   const TomlTable table(node, "[[object]]", "gale.scene.toml");
//   table.require_known({"lon", "lat"});
//   const double lat_deg = table.number("lat", kLatRange_deg);
//
// All members throw std::runtime_error "FILE:LINE: what".
#pragma once

#include <toml++/toml.h>

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "vpe/base/number_range.h"

namespace vpe::base {

// Parses a text of the user's. `file` is its name in messages. Throws std::runtime_error "FILE:LINE: what" for a text that
// is not TOML, or that hostile_toml() refuses.
toml::table parse_toml(std::string_view text, const std::string& file, bool has_long_texts = false);

class TomlTable {
 public:
  // All arguments must outlive it.
  TomlTable(const toml::table& table, std::string_view title, const std::string& file)
      : table_(table), title_(title), file_(file) {}

  // Fails if there is another key.
  void require_known(std::initializer_list<std::string_view> keys) const;
  bool has(std::string_view key) const { return table_.contains(key); }
  // Returns the node of a key; fails if there is none.
  const toml::node& at(std::string_view key) const;

  // Fail if the key is missing or has another value than is allowed.
  double number(std::string_view key, const NumberRange& range) const;
  std::int64_t integer(std::string_view key, std::int64_t least, std::int64_t most) const;
  std::string text(std::string_view key, std::string (*problem_of)(std::string_view)) const;
  std::size_t choice(std::string_view key, std::initializer_list<std::string_view> words) const;
  bool truth(std::string_view key) const;
  const toml::array& list(std::string_view key, std::string_view of) const;

  // Returns `usual` if the key is missing.
  double number(std::string_view key, const NumberRange& range, double usual) const {
    return has(key) ? number(key, range) : usual;
  }

  // Returns an entry of a list as a number.
  double number_of(const toml::node& node, std::string_view what, const NumberRange& range) const;

  // Returns the entries of a list of `least` to `most`, which messages call `form`, such as "[lon, lat]".
  const toml::array& list_of(const toml::node& node, std::string_view what, std::size_t least, std::size_t most,
                             std::string_view form) const;

  [[noreturn]] void fail(const toml::node& node, const std::string& what) const;
  [[noreturn]] void fail(const std::string& what) const { fail(table_, what); }
  [[noreturn]] void fail_expecting(const toml::node& node, std::string_view what,
                                   const std::string& expected) const;
  // Returns "FILE:LINE" of the table.
  std::string where() const;

 private:
  const toml::table& table_;
  std::string_view title_;
  const std::string& file_;
};

}  // namespace vpe::base
