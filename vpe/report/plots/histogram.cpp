#include "vpe/report/plots/histogram.h"

#include <algorithm>
#include <cmath>

#include "vpe/base/number.h"
#include "vpe/report/plots/axis.h"
#include "vpe/report/plots/svg.h"

namespace vpe::report {
namespace {

constexpr double kHistogramLeft = 58;
constexpr double kHistogramRight = 18;
constexpr double kHistogramTop = 60;
constexpr double kHistogramBottom = 48;
constexpr double kLetter = 6.6;  // width of a letter, px
constexpr int kLabelRows = 2;

bool is_finite(const Bar& bar) {
  return std::isfinite(bar.low) && std::isfinite(bar.high) && std::isfinite(bar.share);
}

// Of the bars and marks, with the origin of the shares.
Axis axis_of(const Histogram& histogram, bool of_x) {
  std::vector<double> values;
  for (const Bar& bar : histogram.bars) {
    if (!is_finite(bar)) continue;
    values.push_back(of_x ? bar.low : 0);
    values.push_back(of_x ? bar.high : bar.share);
  }
  if (of_x)
    for (const HistogramMark& mark : histogram.marks) values.push_back(mark.at);
  return {values, false};
}

class HistogramDrawing {
 public:
  explicit HistogramDrawing(const Histogram& histogram)
      : histogram_(histogram),
        x_(axis_of(histogram, true)),
        y_(axis_of(histogram, false)),
        width_(histogram.width_px - kHistogramLeft - kHistogramRight),
        height_(histogram.height_px - kHistogramTop - kHistogramBottom) {}

  std::string svg() {
    text_ = svg_begin(histogram_.width_px, histogram_.height_px, histogram_.title, histogram_.about);
    text_ += svg_text(kHistogramLeft, 16, "start", histogram_.title, " font-weight=\"600\"");
    draw_grid();
    for (const Bar& bar : histogram_.bars)
      if (is_finite(bar)) draw(bar);
    text_ += svg_line(kHistogramLeft, bottom(), kHistogramLeft + width_, bottom(),
                      " stroke=\"currentColor\" stroke-opacity=\"0.6\"");
    draw_marks();
    return text_ + "</svg>\n";
  }

 private:
  double bottom() const { return kHistogramTop + height_; }
  double at_x(double value) const { return kHistogramLeft + width_ * x_.place(value); }
  double at_y(double value) const { return kHistogramTop + height_ * (1 - y_.place(value)); }

  void draw_grid() {
    const std::string style = " stroke=\"currentColor\" stroke-opacity=\"0.15\"";
    for (const Tick& tick : x_.ticks()) text_ += svg_text(at_x(tick.value), bottom() + 17, "middle", tick.text);
    for (const Tick& tick : y_.ticks()) {
      const double y = at_y(tick.value);
      text_ += svg_line(kHistogramLeft, y, kHistogramLeft + width_, y, style) +
               svg_text(kHistogramLeft - 6, y + 4, "end", tick.text);
    }
    const double middle = kHistogramTop + height_ / 2;
    text_ += svg_text(kHistogramLeft + width_ / 2, bottom() + 38, "middle", histogram_.x_label) +
             svg_text(14, middle, "middle", histogram_.y_label,
                      " transform=\"rotate(-90 14 " + svg_number(middle) + ")\"");
  }

  void draw(const Bar& bar) {
    const double left = at_x(bar.low);
    const double right = at_x(bar.high);
    const double gap = right - left > 4 ? 0.5 : 0;
    const std::string label = !bar.label.empty() ? bar.label
                                                 : base::format_significant(bar.low, 6) + " to " +
                                                       base::format_significant(bar.high, 6) + ": " +
                                                       base::format_significant(bar.share, 3);
    text_ += "<rect" + svg_attribute("x", left + gap) + svg_attribute("y", at_y(bar.share)) +
             svg_attribute("width", std::max(0.1, right - left - 2 * gap)) +
             svg_attribute("height", std::max(0.0, bottom() - at_y(bar.share))) + " fill=\"#4a90c4\"><title>" +
             escape_markup(label) + "</title></rect>\n";
  }

  // Labels stand in the first row where the one before leaves room.
  void draw_marks() {
    double ends[kLabelRows] = {};
    for (const HistogramMark& mark : histogram_.marks) {
      if (!std::isfinite(mark.at)) continue;
      const double x = at_x(mark.at);
      const double half = kLetter * static_cast<double>(mark.label.size()) / 2;
      const double left = std::clamp(x - half, 0.0, histogram_.width_px - 2 * half);
      int row = 0;
      while (row < kLabelRows && ends[row] > left) ++row;
      const double y = kHistogramTop - 10 - 13 * std::min(row, kLabelRows - 1);
      text_ += svg_line(x, y + 3, x, bottom(),
                        " stroke=\"currentColor\" stroke-opacity=\"0.7\" stroke-dasharray=\"3 2\"");
      if (row == kLabelRows) continue;
      ends[row] = left + 2 * half + 4;
      text_ += svg_text(left + half, y, "middle", mark.label);
    }
  }

  const Histogram& histogram_;
  Axis x_;
  Axis y_;
  double width_;
  double height_;
  std::string text_;
};

}  // namespace

std::string to_svg(const Histogram& histogram) { return HistogramDrawing(histogram).svg(); }

}  // namespace vpe::report
