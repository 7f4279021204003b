#include "vpe/core/registry/level_table.h"

#include <algorithm>
#include <cmath>

#include "vpe/base/number.h"

namespace vpe::core {

std::string level_table_grammar() {
  return "\"none\" or X:LEVELS,X:LEVELS,... with x >= 0 rising, levels from " +
         base::format_number(-LevelTableLimits::kMaxLevels) + " to " +
         base::format_number(LevelTableLimits::kMaxLevels) + ", at most " +
         std::to_string(LevelTableLimits::kMaxRows) + " rows";
}

std::optional<LevelTable> parse_level_table(std::string_view text) {
  LevelTable table;
  if (text == "none") return table;
  for (bool more = true; more;) {
    const std::size_t comma = text.find(',');
    const std::string_view row = text.substr(0, comma);
    const std::size_t colon = row.find(':');
    if (colon == std::string_view::npos) return std::nullopt;
    const std::optional<double> x = base::parse_number(row.substr(0, colon));
    const std::optional<double> levels = base::parse_number(row.substr(colon + 1));
    if (!x || !levels || *x < 0.0 || std::abs(*levels) > LevelTableLimits::kMaxLevels) return std::nullopt;
    if (!table.empty() && *x <= table.back().from_x) return std::nullopt;
    if (table.size() == LevelTableLimits::kMaxRows) return std::nullopt;
    table.push_back({*x, *levels});
    more = comma != std::string_view::npos;
    if (more) text.remove_prefix(comma + 1);
  }
  return table;
}

std::string format_level_table(const LevelTable& table) {
  if (table.empty()) return "none";
  std::string text;
  for (const LevelStep& row : table) {
    text.append(text.empty() ? "" : ",").append(base::format_number(row.from_x)).append(":");
    text.append(base::format_number(row.levels));
  }
  return text;
}

double levels_at(const LevelTable& table, double x) {
  const auto beyond = std::upper_bound(table.begin(), table.end(), x,
                                       [](double v, const LevelStep& row) { return v < row.from_x; });
  return beyond == table.begin() ? table.front().levels : std::prev(beyond)->levels;
}

}  // namespace vpe::core
