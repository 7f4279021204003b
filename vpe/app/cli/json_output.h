// Results on standard output: JSON and fields of CSV.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace vpe::app {

// Prints a JSON value on stdout, indented by two. Bytes that are not UTF-8, as file names may hold, are written
// as replacement characters.
void print_json(const nlohmann::json& json);

// Returns the text as a field of CSV, quoted where it holds a comma, a quote or a line break.
std::string csv_field(const std::string& text);

}  // namespace vpe::app
