#include "vpe/report/page.h"

#include <algorithm>
#include <span>

#include "vpe/base/number.h"
#include "vpe/report/plots/svg.h"

namespace vpe::report {
namespace {

constexpr const char* kStyle = R"(
:root { color-scheme: light dark; --line: #c8c8c8; --quiet: #5f5f5f; }
@media (prefers-color-scheme: dark) { :root { --line: #484848; --quiet: #a8a8a8; } }
body { font: 15px/1.45 system-ui, sans-serif; max-width: 84rem; margin: 2rem auto; padding: 0 1rem; }
h1, h2 { font-weight: 600; line-height: 1.2; overflow-wrap: anywhere; }
h2 { border-top: 1px solid var(--line); padding-top: 1rem; margin-top: 2.5rem; }
p, dd { max-width: 46rem; overflow-wrap: anywhere; }
dt { font-weight: 600; margin-top: .6rem; }
dd { margin-left: 1.2rem; }
figure { display: inline-block; max-width: 100%; margin: .5rem 1rem .5rem 0; vertical-align: top; }
figure img { display: block; max-width: 100%; height: auto; }
figcaption { color: var(--quiet); font-size: 13px; max-width: 46rem; }
div.wide { overflow-x: auto; }
svg text { fill: currentColor; font: 12px system-ui, sans-serif; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; font-size: 13px; margin: .6rem 0; }
caption { text-align: left; color: var(--quiet); padding: .4rem 0; }
th, td { border-bottom: 1px solid var(--line); padding: .15rem .6rem; text-align: right; white-space: nowrap; }
th { vertical-align: bottom; }
tbody th, td { vertical-align: top; }
tbody th { font-weight: inherit; }
th.word, td.word { text-align: left; }
th.long, td.long { white-space: normal; min-width: 14rem; overflow-wrap: anywhere; }
@media (max-width: 40rem) { th, td { padding: .15rem .4rem; } th.long, td.long { min-width: 9rem; } }
@media print {
  body { max-width: none; margin: 0; }
  h2 { break-after: avoid; }
  figure, tr, dt { break-inside: avoid; }
  div.wide { overflow: visible; }
}
)";

// Nothing may be loaded: a page is read as it is.
constexpr const char* kPolicy =
    "default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'";

// Texts of more characters than this may be broken into lines.
constexpr std::size_t kLongText = 36;

// Returns four significant digits for people; the CSV file has all.
std::string to_short_text(const Cell& cell) {
  const auto* value = std::get_if<double>(&cell);
  if (value == nullptr) return to_text(cell);
  const std::string whole = to_text(cell);
  if (whole.size() <= 7) return whole;
  return base::format_general(*value, 4);
}

// Returns the classes of each column: what is in it decides how it is aligned.
std::vector<std::string> column_classes(const Table& table) {
  std::vector<std::string> classes(table.columns.size());
  for (std::size_t k = 0; k < table.columns.size(); ++k) {
    bool has_words = false;
    bool is_long = false;
    for (const std::vector<Cell>& row : table.rows) {
      const auto* text = std::get_if<std::string>(&row[k]);
      has_words = has_words || (text != nullptr && !table.columns[k].holds_figures);
      is_long = is_long || (text != nullptr && text->size() > kLongText);
    }
    if (has_words) classes[k] = is_long ? " class=\"word long\"" : " class=\"word\"";
  }
  return classes;
}

void add_table(std::string& html, const Table& table) {
  const std::string caption = escape_markup(table.caption);
  // A wide table is scrolled by keys where it has the focus.
  html += "<div class=\"wide\" role=\"region\" tabindex=\"0\" aria-label=\"" + caption + "\"><table><caption>" +
          caption + "</caption>\n<thead><tr>";
  const std::vector<std::string> classes = column_classes(table);
  for (std::size_t k = 0; k < table.columns.size(); ++k) {
    const Column& column = table.columns[k];
    html += "<th scope=\"col\"" + classes[k] + " title=\"" + escape_markup(column.meaning) + "\">" +
            escape_markup(column.name) + "</th>";
  }
  html += "</tr></thead>\n<tbody>";
  for (const std::vector<Cell>& row : table.rows) {
    html += "<tr>";
    for (std::size_t k = 0; k < row.size(); ++k) {
      const char* name = k == 0 ? "th" : "td";
      html += std::string("<") + name + (k == 0 ? " scope=\"row\"" : "") + classes[k] + ">" +
              escape_markup(to_short_text(row[k])) + "</" + name + ">";
    }
    html += "</tr>\n";
  }
  html += "</tbody></table></div>\n";
}

void add_paragraphs(std::string& html, const std::vector<std::string>& paragraphs) {
  for (const std::string& paragraph : paragraphs) html += "<p>" + escape_markup(paragraph) + "</p>\n";
}

// RFC 4648, section 4.
std::string to_base64(std::span<const std::uint8_t> bytes) {
  constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t n = 0; n < bytes.size(); n += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - n);
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) bits = bits << 8 | (k < count ? bytes[n + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k) text += k <= count ? kDigits[bits >> (18 - 6 * k) & 63U] : '=';
  }
  return text;
}

void add_image(std::string& html, const PageImage& image) {
  const std::string caption = escape_markup(image.caption);
  html += "<figure><img alt=\"" + caption + "\" src=\"" + data_uri(image.png) + "\"/><figcaption>" + caption +
          "</figcaption></figure>\n";
}

void add_figure(std::string& html, const Figure& figure) {
  html +=
      "<figure>" + figure.markup + "<figcaption>" + escape_markup(figure.caption) + "</figcaption></figure>\n";
}

void add_drawing(std::string& html, const std::string& svg) {
  html += "<figure><div class=\"wide\">" + svg + "</div></figure>\n";
}

void add_terms(std::string& html, const std::vector<Term>& terms) {
  if (terms.empty()) return;
  html += "<dl>\n";
  for (const Term& term : terms)
    html += "<dt>" + escape_markup(term.name) + "</dt><dd>" + escape_markup(term.meaning) + "</dd>\n";
  html += "</dl>\n";
}

void add_section(std::string& html, const Section& section) {
  html += "<section><h2>" + escape_markup(section.heading) + "</h2>\n";
  add_paragraphs(html, section.paragraphs);
  for (const Figure& figure : section.figures) add_figure(html, figure);
  for (const Plot& plot : section.plots) add_drawing(html, to_svg(plot));
  for (const Histogram& histogram : section.histograms) add_drawing(html, to_svg(histogram));
  for (const Table& table : section.tables) add_table(html, table);
  for (const PageImage& image : section.images) add_image(html, image);
  add_terms(html, section.terms);
  html += "</section>\n";
}

}  // namespace

std::string data_uri(std::span<const std::uint8_t> png) { return "data:image/png;base64," + to_base64(png); }

std::string to_html(const Page& page) {
  const std::string title = escape_markup(page.title);
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/>\n<meta name=\"viewport\" "
      "content=\"width=device-width\"/>\n<meta http-equiv=\"Content-Security-Policy\" content=\"" +
      std::string(kPolicy) + "\"/>\n";
  if (!page.generator.empty())
    html += "<meta name=\"generator\" content=\"" + escape_markup(page.generator) + "\"/>\n";
  html += "<title>" + title + "</title>\n<style>" + kStyle + page.style +
          "</style></head>\n<body>\n<main><h1>" + title + "</h1>\n";
  add_paragraphs(html, page.paragraphs);
  for (const Section& section : page.sections) add_section(html, section);
  html += "</main>\n";
  if (!page.script.empty()) html += "<script>" + page.script + "</script>\n";
  return html + "</body></html>\n";
}

}  // namespace vpe::report
