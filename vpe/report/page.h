// A report as one HTML file that needs nothing beside it.
#pragma once

#include <string>
#include <vector>

#include "vpe/report/plot.h"
#include "vpe/report/table.h"

namespace vpe::report {

struct Section {
  std::string heading;
  std::vector<std::string> paragraphs;  // plain text
  std::vector<Plot> plots;
  std::vector<Table> tables;
};

struct Page {
  std::string title;
  std::vector<std::string> paragraphs;  // what was run, on what, when
  std::vector<Section> sections;
};

// HTML 5, light and dark, without scripts and without anything fetched. All text is escaped.
std::string to_html(const Page& page);

// "&", "<", ">" and quotes as in HTML and XML.
std::string escape_markup(const std::string& text);

}  // namespace vpe::report
