#include "vpe/report/plots/svg.h"

#include "vpe/base/number.h"

namespace vpe::report {

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

std::string svg_number(double value) { return base::format_fixed(value, 2); }

std::string svg_attribute(const char* name, double value) {
  return std::string(" ") + name + "=\"" + svg_number(value) + "\"";
}

std::string svg_text(double x, double y, const char* anchor, const std::string& text, const std::string& more) {
  return "<text" + svg_attribute("x", x) + svg_attribute("y", y) + " text-anchor=\"" + anchor + "\"" + more +
         ">" + escape_markup(text) + "</text>\n";
}

std::string svg_line(double x0, double y0, double x1, double y1, const std::string& style) {
  return "<line" + svg_attribute("x1", x0) + svg_attribute("y1", y0) + svg_attribute("x2", x1) +
         svg_attribute("y2", y1) + style + "/>\n";
}

std::string svg_begin(int width_px, int height_px, const std::string& title, const std::string& about) {
  const std::string width = std::to_string(width_px);
  const std::string height = std::to_string(height_px);
  std::string text =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + width + " " + height + "\" width=\"" +
      width + "\" height=\"" + height +
      "\" font-family=\"sans-serif\" font-size=\"12\" fill=\"currentColor\" role=\"img\">\n<title>" +
      escape_markup(title) + "</title>\n";
  if (!about.empty()) text += "<desc>" + escape_markup(about) + "</desc>\n";
  return text;
}

std::string svg_file(std::string svg) {
  const std::string title_end = "</title>\n";
  svg.insert(svg.find(title_end) + title_end.size(), "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n");
  svg.insert(4, " style=\"color:#000\"");
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" + svg;
}

}  // namespace vpe::report
