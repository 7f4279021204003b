// A lookup table from a distance to levels of detail, and its text: "X:LEVELS,X:LEVELS,...".
//
// Each row holds from its x up to the next row's x; the first row holds below its x too. x rises strictly from
// row to row and is finite and not negative; levels are within -kMaxLevels..kMaxLevels. "none" is the table
// without rows.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vpe::core {

struct LevelTableLimits {
  static constexpr std::size_t kMaxRows = 64;
  static constexpr double kMaxLevels = 30;
};

// One row of a table.
struct LevelStep {
  double from_x = 0;
  double levels = 0;

  bool operator==(const LevelStep&) const = default;
};
using LevelTable = std::vector<LevelStep>;

// Returns what is allowed, for messages.
std::string level_table_grammar();

// Returns the table of a text, or nullopt if the text is not one.
std::optional<LevelTable> parse_level_table(std::string_view text);

// Returns the text of a table: parse_level_table(format_level_table(table)) == table, to the bit.
std::string format_level_table(const LevelTable& table);

// Returns the levels at x >= 0. Expects a table with rows.
double levels_at(const LevelTable& table, double x);

}  // namespace vpe::core
