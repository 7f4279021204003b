#include "vpe/report/page.h"

#include <algorithm>
#include <span>

#include "vpe/base/number.h"

namespace vpe::report {
namespace {

constexpr const char* kStyle = R"(
:root { color-scheme: light dark; --line: #c8c8c8; --quiet: #666; }
@media (prefers-color-scheme: dark) { :root { --line: #484848; --quiet: #a0a0a0; } }
body { font: 15px/1.45 system-ui, sans-serif; max-width: 84rem; margin: 2rem auto; padding: 0 1rem; }
h1, h2 { font-weight: 600; line-height: 1.2; }
h2 { border-top: 1px solid var(--line); padding-top: 1rem; margin-top: 2.5rem; }
p { max-width: 46rem; }
figure { display: inline-block; margin: .5rem 1rem .5rem 0; }
figure img { display: block; max-width: 100%; height: auto; }
figcaption { color: var(--quiet); font-size: 13px; }
svg text { fill: currentColor; font: 12px system-ui, sans-serif; }
div.table { overflow-x: auto; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; font-size: 13px; }
caption { text-align: left; color: var(--quiet); padding: .4rem 0; }
th, td { border-bottom: 1px solid var(--line); padding: .15rem .6rem; text-align: right; white-space: nowrap; }
th.word, td.word { text-align: left; }
)";

// Returns four significant digits for people; the CSV file has all.
std::string to_short_text(const Cell& cell) {
  const auto* value = std::get_if<double>(&cell);
  if (value == nullptr) return to_text(cell);
  const std::string whole = to_text(cell);
  if (whole.size() <= 7) return whole;
  return base::format_general(*value, 4);
}

void add_table(std::string& html, const Table& table) {
  html += "<div class=\"table\"><table><caption>" + escape_markup(table.caption) + "</caption>\n<tr>";
  std::vector<bool> words(table.columns.size());
  for (std::size_t k = 0; k < table.columns.size(); ++k) {
    for (const std::vector<Cell>& row : table.rows) {
      words[k] = words[k] || std::holds_alternative<std::string>(row[k]);
    }
    const Column& column = table.columns[k];
    html += std::string("<th") + (words[k] ? " class=\"word\"" : "") + " title=\"" +
            escape_markup(column.meaning) + "\">" + escape_markup(column.name) + "</th>";
  }
  html += "</tr>\n";
  for (const std::vector<Cell>& row : table.rows) {
    html += "<tr>";
    for (std::size_t k = 0; k < row.size(); ++k) {
      html += std::string("<td") + (words[k] ? " class=\"word\"" : "") + ">" +
              escape_markup(to_short_text(row[k])) + "</td>";
    }
    html += "</tr>\n";
  }
  html += "</table></div>\n";
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
  html += "<figure><img alt=\"" + caption + "\" src=\"data:image/png;base64," + to_base64(image.png) +
          "\"><figcaption>" + caption + "</figcaption></figure>\n";
}

}  // namespace

std::string escape_markup(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&': escaped += "&amp;"; break;
      case '<': escaped += "&lt;"; break;
      case '>': escaped += "&gt;"; break;
      case '"': escaped += "&quot;"; break;
      case '\'': escaped += "&#39;"; break;
      default: escaped += c;
    }
  }
  return escaped;
}

std::string to_html(const Page& page) {
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width\">\n<title>" +
      escape_markup(page.title) + "</title>\n<style>" + kStyle + "</style></head>\n<body>\n<h1>" +
      escape_markup(page.title) + "</h1>\n";
  add_paragraphs(html, page.paragraphs);
  for (const Section& section : page.sections) {
    html += "<h2>" + escape_markup(section.heading) + "</h2>\n";
    add_paragraphs(html, section.paragraphs);
    for (const Plot& plot : section.plots) html += "<figure>" + to_svg(plot) + "</figure>\n";
    for (const Table& table : section.tables) add_table(html, table);
    for (const PageImage& image : section.images) add_image(html, image);
  }
  return html + "</body></html>\n";
}

}  // namespace vpe::report
