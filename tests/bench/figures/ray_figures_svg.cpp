#include <cmath>
#include <cstdio>
#include <fstream>
#include <glm/geometric.hpp>
#include <stdexcept>

#include "tests/bench/figures/ray_figures.h"
#include "vpe/base/nice_ticks.h"
#include "vpe/report/plots/svg.h"

namespace bench {

namespace {

std::string attribute(const char* name, const std::string& value) {
  return std::string(" ") + name + "=\"" + value + "\"";
}
// Returns a coordinate in tenths of a pixel, as short as possible.
std::string coordinate(double value) {
  std::string text = fixed(value, 1);
  if (text.ends_with(".0")) text.resize(text.size() - 2);
  return text;
}
std::string attribute(const char* name, double value) { return attribute(name, coordinate(value)); }

std::string attributes(const Style& style) {
  std::string out = attribute("fill", style.fill != nullptr ? style.fill : "none");
  if (style.stroke != nullptr) {
    out += attribute("stroke", style.stroke);
    if (style.width_px != 1) out += attribute("stroke-width", style.width_px);
  }
  if (style.dashes != nullptr) out += attribute("stroke-dasharray", style.dashes);
  return out;
}

}  // namespace

std::string fixed(double value, int decimals) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  if (text[0] == '-' && std::string(text).find_first_not_of("-0.") == std::string::npos) return text + 1;
  return text;
}

glm::dvec2 Panel::scale() const { return glm::dvec2(width_px, height_px) / (high - low); }

glm::dvec2 Panel::at(const glm::dvec2& value) const {
  const glm::dvec2 moved = (value - low) * scale();
  return {x_px + moved.x, y_px + height_px - moved.y};
}

Panel square_panel(double x_px, double y_px, double width_px, double height_px, const glm::dvec2& middle,
                   double width) {
  const glm::dvec2 half{0.5 * width, 0.5 * width * height_px / width_px};
  return {x_px, y_px, width_px, height_px, middle - half, middle + half};
}

Drawing::Drawing(double width_px, double height_px, const std::string& title) {
  const std::string size = coordinate(width_px) + " " + coordinate(height_px);
  text_ =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + size + "\"" + attribute("width", width_px) +
      attribute("height", height_px) + " font-family=\"sans-serif\" font-size=\"13\" role=\"img\">\n<title>" +
      vpe::report::escape_markup(title) +
      "</title>\n<style>.h{paint-order:stroke;stroke:#fff;stroke-width:4px;stroke-linejoin:round}</style>\n";
  rectangle({0, 0}, {width_px, height_px}, {.fill = "#fff"});
  text({14, 22}, title, {.size_px = 15, .bold = true});
}

void Drawing::line(const glm::dvec2& a, const glm::dvec2& b, const Style& style) {
  text_ += "<path d=\"M" + coordinate(a.x) + " " + coordinate(a.y) + "L" + coordinate(b.x) + " " +
           coordinate(b.y) + "\"" + attributes(style) + "/>\n";
}

void Drawing::path(const std::vector<glm::dvec2>& points, const Style& style, bool closed) {
  text_ += "<path d=\"";
  for (std::size_t k = 0; k < points.size(); ++k)
    text_ += (k == 0 ? "M" : "L") + coordinate(points[k].x) + " " + coordinate(points[k].y);
  text_ += (closed ? "Z\"" : "\"") + attributes(style) + "/>\n";
}

void Drawing::circle(const glm::dvec2& centre, double radius_px, const Style& style) {
  text_ += "<circle" + attribute("cx", centre.x) + attribute("cy", centre.y) + attribute("r", radius_px) +
           attributes(style) + "/>\n";
}

void Drawing::rectangle(const glm::dvec2& corner, const glm::dvec2& size, const Style& style) {
  text_ += "<rect" + attribute("x", corner.x) + attribute("y", corner.y) + attribute("width", size.x) +
           attribute("height", size.y) + attributes(style) + "/>\n";
}

void Drawing::text(const glm::dvec2& at, const std::string& text, const TextStyle& style) {
  text_ += "<text" + attribute("x", at.x) + attribute("y", at.y) + attribute("fill", style.colour);
  if (std::string(style.anchor) != "start") text_ += attribute("text-anchor", style.anchor);
  if (style.size_px != 13) text_ += attribute("font-size", style.size_px);
  if (style.bold) text_ += " font-weight=\"600\"";
  if (style.halo) text_ += " class=\"h\"";
  text_ += ">" + vpe::report::escape_markup(text) + "</text>\n";
}

void Drawing::bracket(const glm::dvec2& a, const glm::dvec2& b, const Style& style) {
  constexpr double kBar_px = 4;
  const glm::dvec2 along = glm::normalize(b - a);
  const glm::dvec2 across = kBar_px * glm::dvec2(-along.y, along.x);
  line(a, b, style);
  line(a - across, a + across, style);
  line(b - across, b + across, style);
}

void Drawing::scale_bar(const Panel& panel, const glm::dvec2& at) {
  const double length_m = vpe::base::nice_step_below(0.2 * (panel.high.x - panel.low.x));
  const glm::dvec2 end = at + glm::dvec2(length_m * panel.scale().x, 0);
  bracket(at, end, {.stroke = kInk});
  text(end + glm::dvec2(8, 4.5), fixed(length_m) + " m", {.halo = false});
}

void Drawing::begin_clip(const Panel& panel) {
  const std::string box = attribute("x", panel.x_px) + attribute("y", panel.y_px) +
                          attribute("width", panel.width_px) + attribute("height", panel.height_px);
  text_ += "<svg" + box + " viewBox=\"" + coordinate(panel.x_px) + " " + coordinate(panel.y_px) + " " +
           coordinate(panel.width_px) + " " + coordinate(panel.height_px) + "\">\n";
}

void Drawing::end_clip() { text_ += "</svg>\n"; }

void Drawing::axes(const Panel& panel, const std::string& x_label, const std::string& y_label, int x_ticks,
                   int y_ticks) {
  rectangle({panel.x_px, panel.y_px}, {panel.width_px, panel.height_px}, {.stroke = "#777"});
  const double bottom = panel.y_px + panel.height_px;
  const auto ticks_x = vpe::base::nice_ticks(panel.low.x, panel.high.x, x_ticks);
  for (const double value : ticks_x.values) {
    const double x = panel.at({value, panel.low.y}).x;
    line({x, bottom}, {x, bottom + 4}, {.stroke = "#777"});
    text({x, bottom + 18}, fixed(value, ticks_x.decimals), {.anchor = "middle"});
  }
  const auto ticks_y = vpe::base::nice_ticks(panel.low.y, panel.high.y, y_ticks);
  for (const double value : ticks_y.values) {
    const double y = panel.at({panel.low.x, value}).y;
    line({panel.x_px - 4, y}, {panel.x_px, y}, {.stroke = "#777"});
    text({panel.x_px - 7, y + 4.5}, fixed(value, ticks_y.decimals), {.anchor = "end"});
  }
  if (!x_label.empty()) text({panel.x_px + panel.width_px, bottom + 35}, x_label, {.anchor = "end"});
  if (!y_label.empty()) text({14, panel.y_px - 8}, y_label);
}

void Drawing::write(const std::string& file) const {
  std::ofstream out(file, std::ios::binary);
  out << text_ << "</svg>\n";
  out.close();
  if (!out) throw std::runtime_error("cannot write " + file + ": check that its folder exists");
}

}  // namespace bench
