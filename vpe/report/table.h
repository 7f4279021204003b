// Measurements as tables: CSV and JSON for programs, a page for people (page.h).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <variant>
#include <vector>

namespace vpe::report {

struct Column {
  std::string name;  // in CSV and JSON: small letters, the unit at the end, such as "shift_p99_px"
  std::string meaning;
  bool holds_figures = false;  // texts of the column are figures: pages align them as numbers
};

// std::monostate: not measured, or does not apply. Numbers that are not finite are written the same way.
using Cell = std::variant<std::monostate, double, std::string>;

struct Table {
  std::string name;  // of its files: small letters and "-"
  std::string caption;
  std::vector<Column> columns;
  std::vector<std::vector<Cell>> rows;  // each as long as columns

  // Adds a row. Throws std::invalid_argument for a row of another length.
  void add(std::vector<Cell> row);
};

// Returns the shortest text that reads back to the same bits, in every locale; "" for numbers that are not
// finite.
std::string to_text(const Cell& cell);

// Returns CSV (RFC 4180) with a line of names first; lines end in "\n".
std::string to_csv(const Table& table);

// Returns {"name", "caption", "columns": [{"name", "meaning"}], "rows": [{name: value}]}, with null for cells
// without a value.
nlohmann::json to_json(const Table& table);

}  // namespace vpe::report
