// Faults of TOML texts that the library toml++ does not survive.
#pragma once

#include <cstddef>
#include <string_view>

namespace vpe::base {

struct TomlFault {
  std::size_t line = 0;  // 0: there is none
  std::string_view what;
  bool is_toml = false;  // the language allows it, but no file of the program needs it
};

// Returns the first fault in a text that toml++ 3.3 does not survive: a key of many parts, for which it makes
// tables in tables until their destructors exhaust the stack; characters beyond ASCII outside of texts, which
// reach an unreachable point; and a table whose name begins with another character than names do, a date before
// another value, and brackets that are no pairs, which fail assertions. Dates, times and texts of several lines
// are faults too: no key of the program's files has such a value.
//
// With `has_long_texts` texts of several lines are allowed: projects hold flights.
TomlFault hostile_toml(std::string_view text, bool has_long_texts = false);

}  // namespace vpe::base
