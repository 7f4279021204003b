// A report as one HTML file that needs no other file.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "vpe/report/plots/histogram.h"
#include "vpe/report/plots/plot.h"
#include "vpe/report/table.h"

namespace vpe::report {

// Holds an image that a page shows in itself.
struct PageImage {
  std::string caption;
  std::vector<std::uint8_t> png;  // the bytes of a PNG file
};

// Holds a figure of any content.
struct Figure {
  std::string markup;   // well-formed HTML whose texts are escaped, with its text for those who cannot see it
  std::string caption;  // plain text
};

// Holds a word and its meaning, as plain text.
struct Term {
  std::string name;
  std::string meaning;
};

// Holds a part of a page. Its content follows in the order of the members.
struct Section {
  std::string heading;
  std::vector<std::string> paragraphs;  // plain text
  std::vector<Plot> plots;
  std::vector<Table> tables;
  std::vector<PageImage> images = {};
  std::vector<Figure> figures = {};        // before plots
  std::vector<Histogram> histograms = {};  // after plots
  std::vector<Term> terms = {};
};

struct Page {
  std::string title;
  std::vector<std::string> paragraphs;  // what was run, on which machine, when
  std::vector<Section> sections;
  std::string generator = {};  // program that made the page, for programs that read it; empty: not stated
  std::string style = {};      // CSS beside that of all pages, without '<' and '&'
  // JavaScript that runs when the page is read, without '<' and '&'. The page must be complete without it.
  std::string script = {};
};

// Returns HTML 5 that is well-formed XML too, in light and dark colours, without external resources: images are in it as
// base64, and its policy forbids browsers to load anything. There is no script but Page::script. Escapes all text.
std::string to_html(const Page& page);

// Returns the bytes of a PNG file as a URI, for the attribute src of an image.
std::string data_uri(std::span<const std::uint8_t> png);

}  // namespace vpe::report
