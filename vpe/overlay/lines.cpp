// Graticule and contours.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <set>

#include "vpe/base/nice_ticks.h"
#include "vpe/base/quantile.h"
#include "vpe/overlay/isolines.h"
#include "vpe/overlay/layer_functions.h"
#include "vpe/overlay/number_format.h"
#include "vpe/overlay/polyline.h"

namespace vpe::overlay {

namespace {

struct LineStyle {
  double width_px;
  Ink ink;
  Ink halo;
};

constexpr Ink kGraticule{1, 1, 1, 0.85};
constexpr Ink kGraticuleHalo{0, 0, 0, 0.42};
constexpr Ink kContour{0.22, 0.10, 0.03, 0.85};
constexpr Ink kContourHalo{1, 0.93, 0.80, 0.30};

constexpr double kInside_px = 1e-6;  // keeps labels off the border in spite of rounding

// Returns the width of the gap in a line, in excess of the text.
double label_room_px(const LabelLayout& layout) { return layout.px(6); }

// Computes the opacity from the distance to the next line.
double opacity(double spacing_px, const LabelLayout& layout) {
  return std::clamp((spacing_px - layout.line_px(2)) / (layout.line_px(5) - layout.line_px(2)), 0.0, 1.0);
}

// Calls draw(points, closed, opacity) for each section of a line with equal opacity, in eight steps.
template <class Draw>
void for_sections(const Isoline& line, const LabelLayout& layout, const Draw& draw) {
  constexpr int kShades = 8;
  const auto shade = [&](std::size_t n) {
    const double trust = line.trust.empty() ? 1.0 : line.trust[n];
    return static_cast<int>(std::lround(kShades * trust * opacity(line.spacing_px[n], layout)));
  };
  std::size_t begin = 0;
  for (std::size_t n = 1; n <= line.points.size(); ++n) {
    if (n < line.points.size() && shade(n) == shade(begin)) continue;
    const bool whole = begin == 0 && n == line.points.size();
    // Includes the first point of the next section, so that there is no gap.
    const std::size_t end = std::min(n + 1, line.points.size());
    if (shade(begin) > 0 && end > begin + 1) {
      draw(std::span(line.points).subspan(begin, end - begin), whole && line.closed,
           static_cast<double>(shade(begin)) / kShades);
    }
    begin = n;
  }
}

// Removes short lines: they are noise of the terrain.
void drop_short_lines(std::vector<Isoline>& lines, const LabelLayout& layout) {
  std::erase_if(lines, [&](const Isoline& line) { return line.length_px() < layout.line_px(10); });
}

void draw_lines(LabelLayout& layout, const std::vector<Isoline>& lines, const LineStyle& style) {
  const auto pass = [&](double width_px, const Ink& ink) {
    for (const Isoline& line : lines) {
      for_sections(line, layout, [&](std::span<const glm::dvec2> points, bool closed, double share) {
        layout.canvas().line(simplified(points), closed, width_px, {ink.r, ink.g, ink.b, ink.a * share});
      });
    }
  };
  // Halos of all lines come before all lines, so that none covers a line.
  pass(style.width_px + 2 * layout.line_px(1), style.halo);
  pass(style.width_px, style.ink);
}

double graticule_step(const std::optional<CentralRange>& range) {
  constexpr std::array<double, 19> kGraticuleSteps_deg{
      45, 30, 15, 10, 5, 2, 1, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 1e-3, 5e-4, 2e-4, 1e-4};
  constexpr double kFewest = 4;
  if (!range) return kGraticuleSteps_deg.front();
  const double width = range->high - range->low;
  const auto fits = std::find_if(kGraticuleSteps_deg.begin(), kGraticuleSteps_deg.end(),
                                 [&](double s) { return width / s >= kFewest; });
  return fits == kGraticuleSteps_deg.end() ? kGraticuleSteps_deg.back() : *fits;
}

// Returns the index of the point halfway along a line, by length.
std::size_t halfway(const Isoline& line) {
  const double half = 0.5 * line.length_px();
  double sum = 0;
  for (std::size_t n = 1; n < line.points.size(); ++n) {
    sum += glm::length(line.points[n] - line.points[n - 1]);
    if (sum >= half) return n;
  }
  return 0;
}

// Labels lines where they leave the image, and those that do not halfway.
template <class TextOf>
void label_graticule(std::vector<LineLabel>& labels, LabelLayout& layout, const std::vector<Isoline>& lines,
                     const TextOf& text_of) {
  const Lettering style{layout.font(14), {1, 1, 1, 1}, kShade};
  const glm::dvec2 size(layout.canvas().width(), layout.canvas().height());
  std::set<std::int64_t> labelled;
  const auto add = [&](const Isoline& line, glm::dvec2 at) {
    const std::string text = text_of(line.multiple);
    const TextSize box = layout.canvas().measure(text, style.font);
    // Moves the label inwards so far that no piece of the line remains between it and the border.
    const glm::dvec2 room(0.5 * (box.width + label_room_px(layout)) + kInside_px,
                          0.5 * box.height + kInside_px);
    if (2 * room.x > size.x || 2 * room.y > size.y) return;
    labels.push_back({text, glm::clamp(at, room, size - room), 0, style});
    labelled.insert(line.multiple);
  };
  for (const Isoline& line : lines) {
    if (line.closed || line.length_px() < layout.px(40)) continue;
    for (const std::size_t n : {std::size_t{0}, line.points.size() - 1}) {
      const glm::dvec2 p = line.points[n];
      const bool leaves = p.x < 1 || p.y < 1 || p.x > size.x - 1 || p.y > size.y - 1;
      if (leaves && opacity(line.spacing_px[n], layout) > 0.5) add(line, p);
    }
  }
  for (const Isoline& line : lines) {
    if (labelled.contains(line.multiple) || line.length_px() < layout.px(80)) continue;
    const std::size_t n = halfway(line);
    if (opacity(line.spacing_px[n], layout) > 0.5) add(line, line.points[n]);
  }
}

struct LabelSite {
  glm::dvec2 at;
  double angle_rad;
};

// Finds sections of a line about `length_px` long that are straight enough for a label.
std::vector<LabelSite> label_sites(const Isoline& line, double length_px, double apart_px,
                                   const LabelLayout& layout) {
  constexpr double kStraight = 0.93;  // straight distance over length along the line
  std::vector<double> along(line.points.size(), 0.0);
  for (std::size_t n = 1; n < along.size(); ++n) {
    along[n] = along[n - 1] + glm::length(line.points[n] - line.points[n - 1]);
  }
  std::vector<LabelSite> sites;
  double next_along = 0.25 * apart_px;
  std::size_t end = 0;
  for (std::size_t n = 0; n < along.size(); ++n) {
    while (end < along.size() && along[end] < along[n] + length_px) ++end;
    if (end == along.size()) break;
    if (along[n] < next_along) continue;
    const glm::dvec2 chord = line.points[end] - line.points[n];
    const std::size_t middle = (n + end) / 2;
    if (glm::length(chord) < kStraight * (along[end] - along[n])) continue;
    if (opacity(line.spacing_px[middle], layout) < 1 || (!line.trust.empty() && line.trust[middle] < 1))
      continue;
    double angle = std::atan2(chord.y, chord.x);
    if (std::abs(angle) > 0.5 * mars::kPi) angle -= std::copysign(mars::kPi, angle);
    sites.push_back({line.points[middle], angle});
    next_along = along[n] + apart_px;
  }
  return sites;
}

}  // namespace

std::vector<LineLabel> draw_graticule(LabelLayout& layout, const VisibleTerrain& terrain, double step_deg) {
  std::vector<LineLabel> labels;
  const LineStyle style{layout.line_px(1.3), kGraticule, kGraticuleHalo};
  const auto family = [&](const std::vector<double>& values, double period, const auto& text) {
    IsolineOptions options;
    options.step = step_deg > 0 ? step_deg : graticule_step(central_range(values, period));
    options.period = period;
    std::vector<Isoline> lines = isolines(terrain, values, options);
    drop_short_lines(lines, layout);
    draw_lines(layout, lines, style);
    label_graticule(labels, layout, lines, [&](std::int64_t multiple) {
      return text(static_cast<double>(multiple) * options.step, options.step);
    });
  };
  family(terrain.latitudes_deg(), 0, latitude_text);
  family(terrain.longitudes_deg(), 360, longitude_text);
  return labels;
}

namespace {

// Lines are drawn in full where the step is at least this many times the possible error of the elevation.
constexpr double kTrusted = 2;

void set_trust(std::vector<Isoline>& lines, const VisibleTerrain& terrain, double step_m) {
  if (terrain.scene().shift_px <= 0) return;
  for (Isoline& line : lines) {
    line.trust.reserve(line.points.size());
    for (const glm::dvec2& p : line.points) {
      const double deviation_m =
          terrain.deviation_m(terrain.index(static_cast<int>(p.x), static_cast<int>(p.y)));
      line.trust.push_back(std::clamp((step_m / deviation_m - 1) / (kTrusted - 1), 0.0, 1.0));
    }
  }
}

// Returns the median error of the elevation over a sample of the pixels with terrain, or 0 if there are none.
double median_error_m(const VisibleTerrain& terrain) {
  std::vector<double> errors_m;
  for (std::size_t p = 0; p < terrain.scene().range_m.size(); p += 97) {
    if (terrain.is_ground(p)) errors_m.push_back(terrain.deviation_m(p));
  }
  if (errors_m.empty()) return 0;
  return base::median_upper(errors_m);
}

}  // namespace

std::vector<LineLabel> draw_contours(LabelLayout& layout, const VisibleTerrain& terrain, double step_m) {
  constexpr int kHeavy = 5;
  constexpr double kMostLines = 20;
  constexpr double kSmallestStep_m = 0.1;
  constexpr double kNoise = 2;  // errors of two neighbouring pixels may have opposite signs
  const std::vector<double> elevations_m = terrain.elevations_m();
  IsolineOptions options;
  options.step = step_m;
  if (step_m <= 0) {
    const std::optional<CentralRange> range = central_range(elevations_m);
    if (!range) return {};
    const double by_range_m = (range->high - range->low) / kMostLines;
    options.step =
        base::nice_step_above(std::max({by_range_m, kTrusted * median_error_m(terrain), kSmallestStep_m}));
  }
  options.noise = kNoise / terrain.scene().appearance.exaggeration;
  options.leave_out = kHeavy;
  std::vector<Isoline> light = isolines(terrain, elevations_m, options);
  const double step = options.step;
  options.step *= kHeavy;
  options.leave_out = 0;
  std::vector<Isoline> heavy = isolines(terrain, elevations_m, options);
  set_trust(light, terrain, step);
  set_trust(heavy, terrain, options.step);
  drop_short_lines(light, layout);
  drop_short_lines(heavy, layout);
  draw_lines(layout, light, {layout.line_px(1.0), kContour, kContourHalo});
  draw_lines(layout, heavy, {layout.line_px(2.0), kContour, kContourHalo});

  std::vector<LineLabel> labels;
  const Lettering style{layout.font(13), {0.18, 0.08, 0.02, 1}, {1, 0.95, 0.86, 0.85}};
  // Labels of long lines have priority.
  std::stable_sort(heavy.begin(), heavy.end(),
                   [](const Isoline& a, const Isoline& b) { return a.points.size() > b.points.size(); });
  for (const Isoline& line : heavy) {
    const double value_m = static_cast<double>(line.multiple) * options.step;
    const std::string text = number_text(value_m, base::step_decimals(step)) + " m";
    const double length_px = 1.15 * layout.canvas().measure(text, style.font).width;
    for (const LabelSite& site : label_sites(line, length_px, layout.px(450), layout)) {
      labels.push_back({text, site.at, site.angle_rad, style});
    }
  }
  return labels;
}

void draw_labels(LabelLayout& layout, const std::vector<LineLabel>& labels) {
  const double apart_px = layout.px(220);
  std::vector<const LineLabel*> drawn;
  for (const LineLabel& label : labels) {
    TextSize size = layout.canvas().measure(label.text, label.style.font);
    size.width += label_room_px(layout);
    const Box box = Box::about(label.at, size, label.angle_rad);
    const bool again = std::any_of(drawn.begin(), drawn.end(), [&](const LineLabel* other) {
      return other->text == label.text && glm::length(other->at - label.at) < apart_px;
    });
    if (again || !layout.is_free(box)) continue;
    layout.take(box);
    drawn.push_back(&label);
    layout.canvas().clear(label.at, size, label.angle_rad);
    layout.canvas().text(label.text, label.at, label.angle_rad, label.style);
  }
}

}  // namespace vpe::overlay
