#include "vpe/report/plots/ground_plot.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "vpe/report/plots/axis.h"
#include "vpe/report/plots/svg.h"

namespace vpe::report {
namespace {

constexpr double kGroundLeft = 74;
constexpr double kGroundRight = 20;
constexpr double kGroundTop = 50;
constexpr double kGroundBottom = 68;
// Ground below the limits, and above 1, 2 ... of them.
constexpr std::array<const char*, 4> kSteepness{"#5b6f3a", "#e69f00", "#d55e00", "#7b1fa2"};

bool is_shown(const GroundColumn& column) {
  return !column.nodata && std::isfinite(column.from) && std::isfinite(column.to) &&
         std::isfinite(column.begin) && std::isfinite(column.end) && std::isfinite(column.low) &&
         std::isfinite(column.high);
}

const char* colour_of(int steepness) {
  return kSteepness[static_cast<std::size_t>(
      std::clamp(steepness, 0, static_cast<int>(kSteepness.size()) - 1))];
}

Axis distances(const GroundPlot& plot) {
  std::vector<double> values;
  for (const GroundColumn& column : plot.columns) {
    values.push_back(column.from);
    values.push_back(column.to);
  }
  return {values, false};
}

Axis elevations(const GroundPlot& plot) {
  std::vector<double> values;
  for (const GroundColumn& column : plot.columns) {
    if (!is_shown(column)) continue;
    values.push_back(column.low);
    values.push_back(column.high);
  }
  return {values, false};
}

class GroundDrawing {
 public:
  explicit GroundDrawing(const GroundPlot& plot)
      : plot_(plot), x_(distances(plot)), y_(elevations(plot)), inside_(inside_of(plot)) {
    for (const GroundColumn& column : plot.columns) {
      first_ = std::min(first_, column.from);
      last_ = std::max(last_, column.to);
    }
    if (!(last_ > first_)) last_ = first_ + 1;
  }

  std::string svg() {
    text_ = svg_begin(plot_.width_px, plot_.height_px, plot_.title, plot_.about) +
            svg_text(kGroundLeft, 18, "start", plot_.title, " font-weight=\"600\"");
    draw_grid();
    for (std::size_t begin = 0; begin < plot_.columns.size();) {
      std::size_t end = begin;
      while (end < plot_.columns.size() && is_shown(plot_.columns[end])) ++end;
      if (end > begin) draw_ground(begin, end);
      begin = end + 1;
    }
    for (const double mark : plot_.marks)
      if (mark >= first_ && mark <= last_)
        text_ += svg_line(at_x(mark), kGroundTop, at_x(mark), bottom(),
                          " stroke=\"currentColor\" stroke-opacity=\"0.4\" stroke-dasharray=\"3 3\"");
    draw_legend();
    return text_ + "</svg>\n";
  }

 private:
  double bottom() const { return kGroundTop + inside_.height_px; }
  // The path fills the width: its axis ends where it ends, and not at a tick.
  double at_x(double value) const {
    return kGroundLeft + inside_.width_px * (value - first_) / (last_ - first_);
  }
  double at_y(double value) const { return kGroundTop + inside_.height_px * (1 - y_.place(value)); }

  void draw_grid() {
    const std::string style = " stroke=\"currentColor\" stroke-opacity=\"0.15\"";
    for (const Tick& tick : x_.ticks()) {
      if (tick.value < first_ || tick.value > last_) continue;
      const double x = at_x(tick.value);
      text_ += svg_line(x, kGroundTop, x, bottom(), style) + svg_text(x, bottom() + 16, "middle", tick.text);
    }
    for (const Tick& tick : y_.ticks()) {
      const double y = at_y(tick.value);
      text_ += svg_line(kGroundLeft, y, kGroundLeft + inside_.width_px, y, style) +
               svg_text(kGroundLeft - 6, y + 4, "end", tick.text);
    }
    const double middle = kGroundTop + inside_.height_px / 2;
    text_ += svg_text(kGroundLeft + inside_.width_px / 2, bottom() + 36, "middle", plot_.x_label) +
             svg_text(14, middle, "middle", plot_.y_label,
                      " transform=\"rotate(-90 14 " + svg_number(middle) + ")\"");
    if (!plot_.note.empty())
      text_ += svg_text(kGroundLeft, plot_.height_px - 10, "start", plot_.note, " fill-opacity=\"0.75\"");
  }

  std::string point(double x, double y) const { return svg_number(at_x(x)) + " " + svg_number(at_y(y)); }

  // Draws columns [begin, end), all with data: the filled ground, the band of its extremes, the line by its steepness.
  void draw_ground(std::size_t begin, std::size_t end) {
    const std::vector<GroundColumn>& all = plot_.columns;
    std::string line = "M" + point(all[begin].from, all[begin].begin);
    std::string band;
    std::string back;
    for (std::size_t n = begin; n < end; ++n) {
      line += "L" + point(all[n].to, all[n].end);
      band +=
          (band.empty() ? "M" : "L") + point(all[n].from, all[n].high) + "L" + point(all[n].to, all[n].high);
      back = "L" + point(all[n].to, all[n].low) + "L" + point(all[n].from, all[n].low) + back;
    }
    const std::string floor = "L" + svg_number(at_x(all[end - 1].to)) + " " + svg_number(bottom()) + "L" +
                              svg_number(at_x(all[begin].from)) + " " + svg_number(bottom()) + "Z";
    text_ += "<path d=\"" + line + floor + "\" fill=\"#b98e5d\" fill-opacity=\"0.35\"/>\n";
    text_ += "<path d=\"" + band + back + "Z\" fill=\"#b98e5d\" fill-opacity=\"0.6\"/>\n";
    for (std::size_t n = begin; n < end;) {
      const int steepness = all[n].steepness;
      std::string part = "M" + point(all[n].from, all[n].begin);
      for (; n < end && all[n].steepness == steepness; ++n) part += "L" + point(all[n].to, all[n].end);
      text_ += "<path d=\"" + part + "\" fill=\"none\" stroke-width=\"2\" stroke-linejoin=\"round\" stroke=\"" +
               colour_of(steepness) + "\"/>\n";
    }
  }

  void draw_legend() {
    constexpr double kLetter_px = 6.8;
    double right = kGroundLeft + inside_.width_px;
    for (std::size_t n = plot_.limits.size(); n > 0; --n) {
      const std::string& name = plot_.limits[n - 1];
      const double begin = right - kLetter_px * static_cast<double>(name.size()) - 26;
      text_ += svg_line(begin, 38, begin + 20, 38,
                        std::string(" stroke-width=\"3\" stroke=\"") + colour_of(static_cast<int>(n)) + "\"") +
               svg_text(begin + 26, 42, "start", name);
      right = begin - 14;
    }
  }

  const GroundPlot& plot_;
  Axis x_;
  Axis y_;
  PlotInside inside_;
  double first_ = HUGE_VAL;
  double last_ = -HUGE_VAL;
  std::string text_;
};

}  // namespace

PlotInside inside_of(const GroundPlot& plot) {
  return {plot.width_px - kGroundLeft - kGroundRight, plot.height_px - kGroundTop - kGroundBottom};
}

PlotRange range_of(const GroundPlot& plot) {
  const Axis axis = elevations(plot);
  // Positions are linear: two of them tell both ends.
  const double span = 1 / (axis.place(1) - axis.place(0));
  const double low = -axis.place(0) * span;
  return {low, low + span};
}

std::string to_svg(const GroundPlot& plot) { return GroundDrawing(plot).svg(); }

}  // namespace vpe::report
