#include "vpe/report/table.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "vpe/base/number.h"

namespace vpe::report {
namespace {

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    quoted += c;
    if (c == '"') quoted += c;
  }
  return quoted + '"';
}

}  // namespace

void Table::add(std::vector<Cell> row) {
  if (row.size() != columns.size()) {
    throw std::invalid_argument("table " + name + ": a row of " + std::to_string(row.size()) + " cells for " +
                                std::to_string(columns.size()) + " columns");
  }
  rows.push_back(std::move(row));
}

std::string to_text(const Cell& cell) {
  if (const auto* text = std::get_if<std::string>(&cell)) return *text;
  const auto* value = std::get_if<double>(&cell);
  return value != nullptr && std::isfinite(*value) ? base::format_number(*value) : std::string();
}

std::string to_csv(const Table& table) {
  std::string csv;
  for (std::size_t k = 0; k < table.columns.size(); ++k) {
    csv += (k == 0 ? "" : ",") + csv_field(table.columns[k].name);
  }
  csv += '\n';
  for (const std::vector<Cell>& row : table.rows) {
    for (std::size_t k = 0; k < row.size(); ++k) csv += (k == 0 ? "" : ",") + csv_field(to_text(row[k]));
    csv += '\n';
  }
  return csv;
}

nlohmann::json to_json(const Table& table) {
  nlohmann::json columns = nlohmann::json::array();
  for (const Column& column : table.columns)
    columns.push_back({{"name", column.name}, {"meaning", column.meaning}});
  nlohmann::json rows = nlohmann::json::array();
  for (const std::vector<Cell>& row : table.rows) {
    nlohmann::json one = nlohmann::json::object();
    for (std::size_t k = 0; k < row.size(); ++k) {
      nlohmann::json& cell = one[table.columns[k].name];
      if (const auto* text = std::get_if<std::string>(&row[k])) cell = *text;
      const auto* value = std::get_if<double>(&row[k]);
      if (value != nullptr && std::isfinite(*value)) cell = *value;
    }
    rows.push_back(std::move(one));
  }
  return {{"name", table.name}, {"caption", table.caption}, {"columns", columns}, {"rows", rows}};
}

}  // namespace vpe::report
