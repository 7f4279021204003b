#include "vpe/report/plots/plot.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "vpe/base/number.h"
#include "vpe/report/plots/axis.h"
#include "vpe/report/plots/svg.h"

namespace vpe::report {
namespace {

constexpr double kLeft = 70;
constexpr double kTop = 36;
constexpr double kBottom = 52;
constexpr double kLegend = 190;

// The colours of Okabe and Ito, which most people can distinguish, on white and on black.
constexpr std::array<const char*, 7> kColours{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                              "#e69f00", "#56b4e9", "#8c8c8c"};
constexpr int kShapes = 5;

std::string polygon(double x, double y, double size, const std::vector<std::array<double, 2>>& corners) {
  std::string points;
  for (const auto& corner : corners)
    points += svg_number(x + size * corner[0]) + "," + svg_number(y + size * corner[1]) + " ";
  return "<polygon points=\"" + points + "\"";
}

// Returns an element without its end, for more attributes.
std::string shape(int which, double x, double y, double size) {
  switch (which % kShapes) {
    case 0: return "<circle" + svg_attribute("cx", x) + svg_attribute("cy", y) + svg_attribute("r", size);
    case 1: return polygon(x, y, size, {{-.9, -.9}, {.9, -.9}, {.9, .9}, {-.9, .9}});
    case 2: return polygon(x, y, size, {{0, -1.1}, {1.1, .8}, {-1.1, .8}});
    case 3: return polygon(x, y, size, {{0, -1.3}, {1.3, 0}, {0, 1.3}, {-1.3, 0}});
    default: return polygon(x, y, size, {{0, 1.1}, {1.1, -.8}, {-1.1, -.8}});
  }
}

class Drawing {
 public:
  explicit Drawing(const Plot& plot)
      : plot_(plot),
        x_(collect(plot, true), plot.log_x),
        y_(collect(plot, false), plot.log_y),
        width_(plot.width_px - kLeft - kLegend),
        height_(plot.height_px - kTop - kBottom) {}

  std::string svg() {
    text_ = svg_begin(plot_.width_px, plot_.height_px, plot_.title);
    text_ += svg_text(kLeft, kTop - 14, "start", plot_.title, " font-weight=\"600\"");
    draw_axes();
    for (std::size_t k = 0; k < plot_.series.size(); ++k) draw(plot_.series[k], static_cast<int>(k));
    return text_ + "</svg>\n";
  }

 private:
  static std::vector<double> collect(const Plot& plot, bool of_x) {
    std::vector<double> values;
    for (const Series& series : plot.series) {
      for (const Point& point : series.points) {
        if (!std::isfinite(point.x) || !std::isfinite(point.y)) continue;
        values.push_back(of_x ? point.x : point.y);
        if (!of_x && point.bound) values.push_back(*point.bound);
      }
    }
    return values;
  }

  double at_x(double value) const { return kLeft + width_ * x_.place(value); }
  double at_y(double value) const { return kTop + height_ * (1 - y_.place(value)); }

  void draw_axes() {
    const std::string grid = " stroke=\"currentColor\" stroke-opacity=\"0.15\"";
    for (const Tick& tick : x_.ticks()) {
      const double x = at_x(tick.value);
      text_ +=
          svg_line(x, kTop, x, kTop + height_, grid) + svg_text(x, kTop + height_ + 18, "middle", tick.text);
    }
    for (const Tick& tick : y_.ticks()) {
      const double y = at_y(tick.value);
      text_ += svg_line(kLeft, y, kLeft + width_, y, grid) + svg_text(kLeft - 8, y + 4, "end", tick.text);
    }
    text_ += "<rect" + svg_attribute("x", kLeft) + svg_attribute("y", kTop) + svg_attribute("width", width_) +
             svg_attribute("height", height_) +
             " fill=\"none\" stroke=\"currentColor\" stroke-opacity=\"0.6\"/>\n";
    text_ += svg_text(kLeft + width_ / 2, kTop + height_ + 40, "middle", plot_.x_label);
    const std::string rotated = " transform=\"rotate(-90 16 " + svg_number(kTop + height_ / 2) + ")\"";
    text_ += svg_text(16, kTop + height_ / 2, "middle", plot_.y_label, rotated);
  }

  void draw(const Series& series, int number_of_series) {
    const std::string colour = kColours[static_cast<std::size_t>(number_of_series) % kColours.size()];
    const std::string stroke = " stroke=\"" + colour + "\"";
    std::string path;
    std::string marks;
    for (const Point& point : series.points) {
      if (!std::isfinite(point.x) || !std::isfinite(point.y)) continue;
      const double x = at_x(point.x);
      const double y = at_y(point.y);
      path += (path.empty() ? "M" : "L") + svg_number(x) + " " + svg_number(y);
      if (point.bound && std::isfinite(*point.bound)) {
        const double top = at_y(*point.bound);
        marks += svg_line(x, y, x, top, stroke + " stroke-opacity=\"0.45\" stroke-dasharray=\"2 2\"") +
                 svg_line(x - 4, top, x + 4, top, stroke + " stroke-opacity=\"0.8\"");
      }
      marks += shape(number_of_series, x, y, point.marked ? 5.5 : 3.5) + stroke + " fill=\"" +
               (point.marked ? colour : std::string("none")) + "\"><title>" +
               escape_markup(tooltip(series, point)) + "</title>" + closing(number_of_series) + "\n";
    }
    if (series.joined && !path.empty()) {
      text_ += "<path d=\"" + path + "\" fill=\"none\" stroke-opacity=\"0.6\"" + stroke + "/>\n";
    }
    text_ += marks;
    const double x = kLeft + width_ + 18;
    const double y = kTop + 10 + 20 * number_of_series;
    text_ += shape(number_of_series, x, y, 4) + stroke + " fill=\"" + colour + "\"/>\n" +
             svg_text(x + 12, y + 4, "start", series.name);
  }

  static std::string closing(int number_of_series) {
    return number_of_series % kShapes == 0 ? "</circle>" : "</polygon>";
  }

  std::string tooltip(const Series& series, const Point& point) const {
    std::string text = series.name + (point.label.empty() ? "" : ", " + point.label) + ": " +
                       base::format_number(point.x) + ", " + base::format_number(point.y);
    if (point.bound) text += "; at most " + base::format_number(*point.bound) + " stated";
    if (y_.below(point.y) || x_.below(point.x)) text += " (on the border: no logarithm)";
    return text;
  }

  const Plot& plot_;
  Axis x_;
  Axis y_;
  double width_;
  double height_;
  std::string text_;
};

}  // namespace

std::string to_svg(const Plot& plot) { return Drawing(plot).svg(); }

std::string to_svg_file(const Plot& plot) { return svg_file(to_svg(plot)); }

}  // namespace vpe::report
