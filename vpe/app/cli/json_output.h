// Results on standard output: JSON, lines, fields of CSV.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace vpe::app {

// Prints a JSON value on stdout, indented by two. Bytes that are not UTF-8, as file names may hold, are written
// as replacement characters.
void print_json(const nlohmann::json& json);

// Returns the text without line breaks and other control characters, which names of files may hold: written as
// "\n" or "\x1b".
std::string on_one_line(const std::string& text);

// Returns the text as a field of CSV, quoted where it holds a comma, a quote or a line break.
std::string csv_field(const std::string& text);

}  // namespace vpe::app
