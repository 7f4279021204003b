// Takes OGR style strings apart.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace mars {

// Holds a tool of a style string, as PEN(c:#ff0000,w:2px).
struct StyleTool {
  std::string name;  // in capitals
  // Names in small letters with their values, without quotation marks.
  std::vector<std::pair<std::string, std::string>> parameters;
};

// Returns the tools of a style string, by the OGR Feature Style Specification; nullopt if it is not one. A reference to a
// table of styles, @NAME, has no tools. Pure.
std::optional<std::vector<StyleTool>> parse_ogr_style(const std::string& text);

}  // namespace mars
