// Reliefs as words of one line, as in flights: "kind=crater lon=137.4 lat=-4.6 radius=200 depth=60".
//
// Keys are those of relief_keys() without "name", with or without their unit: radius or radius_m.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "relief/spec.h"

namespace relief {

// Returns the key of a name with or without its unit, or nullopt.
std::optional<std::size_t> find_line_key(std::string_view name);

// Returns the relief of a line. Throws std::invalid_argument with what is wrong, without the place in a file.
ReliefSpec parse_relief_line(std::string_view line);

// Returns a relief with the keys of a line changed; it need not be complete. Throws as parse_relief_line() does.
ReliefSpec changed_by_line(ReliefSpec spec, std::string_view line);

// Returns the line from which parse_relief_line() reads the same relief to the bit, but for the name. Keys with their usual
// values are left out. The relief must have no problem_of().
std::string to_line(const ReliefSpec& spec);

}  // namespace relief
