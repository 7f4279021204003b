// Legend of the colours of elevation, slope, aspect or difference.
#include <algorithm>
#include <array>
#include <cmath>

#include "vpe/base/nice_ticks.h"
#include "vpe/core/appearance/palette.h"
#include "vpe/overlay/layer_functions.h"
#include "vpe/overlay/number_format.h"

namespace vpe::overlay {

namespace {

using core::Colour;
using core::Mode;

bool shows_values(const Scene& scene) {
  const core::Appearance& a = scene.appearance;
  const bool coloured = a.mode == Mode::kUnlit || a.mode == Mode::kColoured || a.mode == Mode::kWireframe ||
                        a.mode == Mode::kMarkers ||
                        (a.mode == Mode::kTextured && (a.colourise || !scene.has_imagery));
  return coloured && (a.colour == Colour::kElevation || a.colour == Colour::kSlope ||
                      a.colour == Colour::kAspect || a.colour == Colour::kDifference);
}

// Returns what follows the numbers.
const char* unit_sign(Colour colour) {
  return colour == Colour::kElevation || colour == Colour::kDifference ? "" : "\u00b0";
}

constexpr const char* kElevationInKm = "Elevation, km";

struct Tick {
  double value;
  std::string text;
};

struct LegendScale {
  std::string title;
  std::vector<Tick> ticks;
};

LegendScale legend_scale(Colour colour, double low, double high) {
  constexpr int kTicks = 6;
  constexpr double kKilometresFrom_m = 5000;
  LegendScale legend;
  const double bottom = std::min(low, high);
  const double top = std::max(low, high);
  if (colour == Colour::kAspect && bottom <= 0 && top >= 360) {
    constexpr std::array<const char*, 5> kMainWinds{"N", "E", "S", "W", "N"};
    legend.title = "Aspect";
    for (std::size_t n = 0; n < kMainWinds.size(); ++n)
      legend.ticks.push_back({90.0 * static_cast<double>(n), kMainWinds[n]});
    return legend;
  }
  const bool in_km =
      colour == Colour::kElevation && std::max(std::abs(low), std::abs(high)) >= kKilometresFrom_m;
  const double unit = in_km ? 1000 : 1;
  legend.title = colour == Colour::kElevation    ? in_km ? kElevationInKm : "Elevation, m"
                 : colour == Colour::kDifference ? "Difference, m"
                 : colour == Colour::kSlope      ? "Slope"
                                                 : "Aspect";
  const std::vector<double> values = base::nice_ticks_two_or_more(bottom / unit, top / unit, kTicks);
  const int decimals = values.size() > 1 ? base::step_decimals(values[1] - values[0]) : 0;
  for (const double v : values) {
    legend.ticks.push_back({v * unit, number_text(v, decimals) + unit_sign(colour)});
  }
  return legend;
}

// Labels the ends of a range that was asked for, in place of ticks that are too near to them.
void label_ends(LegendScale& legend, Colour colour, double low, double high) {
  constexpr double kApart = 0.1;    // share of the bar that a label takes
  constexpr double kDigits = 20.0;  // ends are rounded as finely as this part of the range needs
  const double span = std::abs(high - low);
  const bool in_km = legend.title == kElevationInKm;
  const double unit = in_km ? 1000 : 1;
  const int decimals = base::step_decimals(base::nice_step_below(span / kDigits / unit));
  for (const double end : {low, high}) {
    std::erase_if(legend.ticks, [&](const Tick& tick) { return std::abs(tick.value - end) < kApart * span; });
    legend.ticks.push_back({end, number_text(end / unit, decimals) + unit_sign(colour)});
  }
}

}  // namespace

void draw_legend(LabelLayout& layout, const Scene& scene) {
  if (!shows_values(scene)) return;
  Canvas& canvas = layout.canvas();
  const core::ColourScale scale(scene.appearance);
  if (scale.low() == scale.high()) return;  // a palette of one colour
  LegendScale legend = legend_scale(scene.appearance.colour, scale.low(), scale.high());
  const bool is_whole_circle = !legend.ticks.empty() && legend.ticks.front().text == "N";
  if (scene.appearance.palette_low != scene.appearance.palette_high && !is_whole_circle)
    label_ends(legend, scene.appearance.colour, scale.low(), scale.high());
  const Font font = layout.font(14);
  const Font title_font = layout.font(14, true);
  const TextSize title = canvas.measure(legend.title, title_font);
  double ticks_px = 0;
  for (const Tick& tick : legend.ticks) ticks_px = std::max(ticks_px, canvas.measure(tick.text, font).width);

  const double pad = layout.px(8);
  const double bar_width = std::max(layout.px(16), 9.0);
  const double bar_height = std::max(layout.px(190), 95.0);
  const double tick_px = layout.px(4);
  const double width = 2 * pad + std::max(title.width, bar_width + 3 * tick_px + ticks_px);
  const double height = 2 * pad + 1.4 * title.height + bar_height + 0.5 * title.height;
  const double right = layout.area().right - layout.margin_px();
  const double bottom = layout.area().bottom - layout.margin_px();
  const Box box{right - width, bottom - height, right, bottom};
  if (!layout.is_free(box)) return;
  layout.take(box.grown(layout.px(4)));
  const auto rectangle = [&](const Box& b, const Ink& ink) {
    const std::vector<glm::dvec2> corners{
        {b.left, b.top}, {b.right, b.top}, {b.right, b.bottom}, {b.left, b.bottom}};
    canvas.polygon(corners, ink);
  };
  canvas.clear({0.5 * (box.left + box.right), 0.5 * (box.top + box.bottom)}, {width, height}, 0);
  rectangle(box, {0, 0, 0, 0.6});
  layout.label(legend.title, {0.5 * (box.left + box.right), box.top + pad + 0.5 * title.height}, title_font);

  // Rows of whole pixels, each with the colour of its centre.
  const double left = std::round(box.left + pad);
  const double top = std::round(box.top + pad + 1.4 * title.height);
  const int rows = static_cast<int>(std::lround(bar_height));
  rectangle({left - 1, top - 1, left + std::round(bar_width) + 1, top + rows + 1}, kWhite);
  for (int row = 0; row < rows; ++row) {
    const double at = (rows - row - 0.5) / rows;
    const glm::dvec3 rgb = scale(scale.low() + at * (scale.high() - scale.low())) / 255.0;
    rectangle({left, top + row, left + std::round(bar_width), top + row + 1}, {rgb.x, rgb.y, rgb.z, 1});
  }
  for (const Tick& tick : legend.ticks) {
    const double at = (tick.value - scale.low()) / (scale.high() - scale.low());
    const double y = top + rows * (1 - at);
    const double x = left + std::round(bar_width) + 1;
    const std::vector<glm::dvec2> mark{{x, y}, {x + tick_px, y}};
    canvas.line(mark, false, layout.line_px(1.3), kWhite);
    const TextSize size = canvas.measure(tick.text, font);
    layout.label(tick.text, {x + 2 * tick_px + ticks_px - 0.5 * size.width, y}, font);
  }
}

}  // namespace vpe::overlay
