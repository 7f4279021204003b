// A report as one HTML file that needs no other file.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "vpe/report/plot.h"
#include "vpe/report/table.h"

namespace vpe::report {

// Holds an image that a page shows in itself.
struct PageImage {
  std::string caption;
  std::vector<std::uint8_t> png;  // the bytes of a PNG file
};

struct Section {
  std::string heading;
  std::vector<std::string> paragraphs;  // plain text
  std::vector<Plot> plots;
  std::vector<Table> tables;
  std::vector<PageImage> images = {};
};

struct Page {
  std::string title;
  std::vector<std::string> paragraphs;  // what was run, on which machine, when
  std::vector<Section> sections;
};

// Returns HTML 5 in light and dark colours, without scripts and without external resources: images are in it as base64. Escapes all text.
std::string to_html(const Page& page);

// Escapes "&", "<", ">" and quotes for HTML and XML.
std::string escape_markup(const std::string& text);

}  // namespace vpe::report
