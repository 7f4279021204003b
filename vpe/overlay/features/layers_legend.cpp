#include "vpe/overlay/features/layers_legend.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "vpe/overlay/features/feature_painter.h"

namespace vpe::overlay {
namespace {

// Sizes at 720 rows.
constexpr double kLegendLetters_px = 13;
constexpr double kLegendPad_px = 8;
constexpr double kSwatchWidth_px = 26;
constexpr double kSwatchHeight_px = 12;
constexpr double kWidestText_px = 260;
constexpr double kColumnGap_px = 14;
constexpr Ink kSwatchGround{0.6, 0.6, 0.6, 1};

std::string cut_text(const Canvas& ruler, const Font& font, const std::string& text, double most_px) {
  std::string shown = printable_utf8(text);
  if (ruler.measure(shown, font).width <= most_px) return shown;
  const std::string whole = shown;
  std::size_t kept = whole.size();
  while (kept > 0 && ruler.measure(shown, font).width > most_px) {
    // A large step by proportion first: measuring is slow.
    const double share = most_px / ruler.measure(shown, font).width;
    kept = std::min(kept - 1, static_cast<std::size_t>(1.2 * share * static_cast<double>(kept)));
    while (kept > 0 && (static_cast<unsigned char>(whole[kept]) & 0xc0U) == 0x80U) --kept;
    shown = whole.substr(0, kept) + "\u2026";
  }
  return shown;
}

void rectangle(Canvas& canvas, const Box& box, const Ink& ink) {
  const std::array<glm::dvec2, 4> corners{glm::dvec2{box.left, box.top}, glm::dvec2{box.right, box.top},
                                          glm::dvec2{box.right, box.bottom}, glm::dvec2{box.left, box.bottom}};
  canvas.polygon(corners, ink);
}

std::string more_text(std::size_t left_out) { return "and " + std::to_string(left_out) + " more"; }

}  // namespace

std::vector<LegendRow> legend_rows(std::span<const SceneLayer> layers, std::span<const LayerUse> uses) {
  // Files of many features with styles of their own: later entries are compared with so many before them.
  constexpr std::size_t kCompared = 256;
  std::vector<LegendRow> rows;
  for (std::size_t k = layers.size(); k-- > 0;) {
    const GroundFeatures& features = *layers[k].features;
    const LayerUse& use = uses[k];
    const auto add = [&](std::uint32_t number, LegendRow::Kind kind) {
      LegendRow row{features.style_of_number(number), kind, layers[k].opacity, ""};
      row.text = std::exchange(row.style.legend, "");
      if (row.text.empty()) row.text = features.layer().name;
      const auto first =
          rows.begin() + static_cast<std::ptrdiff_t>(rows.size() - std::min(rows.size(), kCompared));
      if (std::find(first, rows.end(), row) == rows.end()) rows.push_back(std::move(row));
    };
    for (std::uint32_t n = 0; n < features.styles(); ++n) {
      if (use.areas[n] != 0) add(n, LegendRow::Kind::kArea);
      if (use.lines[n] != 0 && use.areas[n] == 0) add(n, LegendRow::Kind::kLine);
      if (use.points[n] != 0) add(n, LegendRow::Kind::kPoint);
    }
  }
  return rows;
}

LayersLegend::LayersLegend(std::vector<LegendRow> rows, const Canvas& ruler, double unit)
    : rows_(std::move(rows)),
      unit_(unit),
      font_{std::max(px(kLegendLetters_px), 0.7 * kLegendLetters_px), false} {
  const double letters = font_.size_px / kLegendLetters_px;
  for (LegendRow& row : rows_) {
    row.text = cut_text(ruler, font_, row.text, kWidestText_px * letters);
    text_px_ = std::max(text_px_, ruler.measure(row.text, font_).width);
  }
  const TextSize more = ruler.measure(more_text(rows_.size()), font_);
  text_px_ = std::max(text_px_, more.width);
  line_px_ = 1.15 * more.height;
}

std::optional<LayersLegend::Plan> LayersLegend::plan(double width_px, double height_px) const {
  if (rows_.empty()) return std::nullopt;
  const double letters = font_.size_px / kLegendLetters_px;
  const double column_px = (kSwatchWidth_px + kLegendPad_px + kColumnGap_px) * letters + text_px_;
  const double around_px = 2 * kLegendPad_px * letters;
  const double columns = std::floor((width_px - around_px + kColumnGap_px * letters) / column_px);
  const double lines = std::floor((height_px - around_px) / line_px_);
  if (columns < 1 || lines < 1) return std::nullopt;
  const auto most_lines = static_cast<std::size_t>(lines);
  const std::size_t room = most_lines * static_cast<std::size_t>(columns);
  Plan plan;
  plan.shown = rows_.size() <= room ? rows_.size() : room - 1;
  if (plan.shown == 0) return std::nullopt;
  const std::size_t entries = plan.shown + (plan.shown < rows_.size() ? 1 : 0);
  const std::size_t used = (entries + most_lines - 1) / most_lines;
  plan.lines = (entries + used - 1) / used;
  plan.size = {std::ceil(static_cast<double>(used) * column_px - kColumnGap_px * letters + around_px),
               std::ceil(static_cast<double>(plan.lines) * line_px_ + around_px)};
  return plan;
}

void LayersLegend::draw_swatch(Canvas& canvas, const LegendRow& row, glm::dvec2 centre) const {
  const double letters = font_.size_px / kLegendLetters_px;
  const glm::dvec2 half(0.5 * kSwatchWidth_px * letters, 0.5 * kSwatchHeight_px * letters);
  mars::FeatureStyle style = row.style;
  // Lengths on the ground have no size here.
  const auto settle = [](mars::StyleLength& length, double unsaid, double most) {
    length = {length.on_ground ? unsaid : std::clamp(length.value, 0.5, most), false};
  };
  settle(style.width, 3, kSwatchHeight_px);
  settle(style.marker_size, kSwatchHeight_px, kSwatchHeight_px);
  for (mars::StyleLength& length : style.dash) settle(length, 5, kSwatchWidth_px);
  const FeaturePainter painter{{letters, 1}, row.opacity, core::HiddenLines::kLeftOut};
  const Box box{centre.x - half.x, centre.y - half.y, centre.x + half.x, centre.y + half.y};
  rectangle(canvas, box, kSwatchGround);
  DrapedRun run;
  if (row.kind == LegendRow::Kind::kPoint) {
    painter.marker(canvas, centre, 1, style);
    return;
  }
  if (row.kind == LegendRow::Kind::kArea) {
    if (style.fill) rectangle(canvas, box, ink_of(*style.fill, row.opacity));
    settle(style.width, 2, 3);
    const double in_px = 0.5 * painter.width_px(style, 1);
    const Box rim = box.grown(-in_px);
    run.points_px = {{rim.left, rim.top},
                     {rim.right, rim.top},
                     {rim.right, rim.bottom},
                     {rim.left, rim.bottom},
                     {rim.left, rim.top}};
  } else {
    run.points_px = {{box.left, centre.y}, {box.right, centre.y}};
  }
  if (style.stroke) painter.run(canvas, run, style, {0, 0});
}

void LayersLegend::draw(Canvas& canvas, const Plan& plan, glm::dvec2 corner) const {
  const double letters = font_.size_px / kLegendLetters_px;
  const double pad = kLegendPad_px * letters;
  const double swatch = kSwatchWidth_px * letters;
  const glm::dvec2 size(plan.size.width, plan.size.height);
  canvas.clear(corner + 0.5 * size, plan.size, 0);
  rectangle(canvas, {corner.x, corner.y, corner.x + size.x, corner.y + size.y}, {0, 0, 0, 0.6});
  const std::size_t entries = plan.shown + (plan.shown < rows_.size() ? 1 : 0);
  for (std::size_t n = 0; n < entries; ++n) {
    const double left =
        corner.x + pad +
        static_cast<double>(n / plan.lines) * (swatch + pad + text_px_ + kColumnGap_px * letters);
    const double y = corner.y + pad + (static_cast<double>(n % plan.lines) + 0.5) * line_px_;
    const std::string text = n < plan.shown ? rows_[n].text : more_text(rows_.size() - plan.shown);
    if (n < plan.shown) draw_swatch(canvas, rows_[n], {left + 0.5 * swatch, y});
    const double width = canvas.measure(text, font_).width;
    canvas.text(text, {left + swatch + pad + 0.5 * width, y}, 0, {font_, kWhite, kShade});
  }
}

std::optional<LayersLegend::Site> LayersLegend::find_site(
    const Box& area, const std::function<bool(const Box&)>& is_free) const {
  constexpr double kMostOfWidth = 0.6;
  constexpr double kMostOfHeight = 0.7;
  const double margin = px(16);
  const double step = std::max(1.0, px(4));
  for (double share = kMostOfHeight; share > 0.05; share *= 0.75) {
    const auto fitting = plan(kMostOfWidth * (area.right - area.left), share * (area.bottom - area.top));
    if (!fitting) return std::nullopt;
    for (const double left : {area.left + margin, area.right - margin - fitting->size.width}) {
      for (double top = area.top + margin; top + fitting->size.height + margin <= area.bottom; top += step) {
        const glm::dvec2 corner(std::floor(left), std::floor(top));
        if (is_free({corner.x, corner.y, corner.x + fitting->size.width, corner.y + fitting->size.height}))
          return Site{*fitting, corner};
      }
    }
  }
  return std::nullopt;
}

}  // namespace vpe::overlay
