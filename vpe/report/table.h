// What was measured, a row a measurement: for programs as CSV and JSON, for people in a page (page.h).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <variant>
#include <vector>

namespace vpe::report {

struct Column {
  std::string name;  // as in CSV: small letters, the unit at the end, as in "shift_p99_px"
  std::string meaning;
};

// Nothing: not measured here, or does not apply. Numbers that are not finite are written as that too.
using Cell = std::variant<std::monostate, double, std::string>;

struct Table {
  std::string name;  // of its files: small letters and "-"
  std::string caption;
  std::vector<Column> columns;
  std::vector<std::vector<Cell>> rows;  // each as long as columns

  // Throws std::invalid_argument for a row of another length.
  void add(std::vector<Cell> row);
};

// The shortest text that reads back to the same bits, in every locale; what is not finite is "".
std::string to_text(const Cell& cell);

// RFC 4180, names first, lines ending in "\n".
std::string to_csv(const Table& table);

// {"name", "caption", "columns": [{"name", "meaning"}], "rows": [{name: value}]}; null for nothing.
nlohmann::json to_json(const Table& table);

}  // namespace vpe::report
