#include "vpe/overlay/features/feature_painter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "mars/geodesy/sphere.h"
#include "vpe/overlay/label_layout.h"
#include "vpe/overlay/polyline.h"

namespace vpe::overlay {
namespace {

constexpr double kThinnestLine_px = 0.3;
constexpr double kWidestLine_px = 200;
constexpr double kSmallestMarker_px = 1;
constexpr double kHiddenDash_px = 4;  // at 720 rows
constexpr double kHiddenOpacity = 0.6;
constexpr double kLargestLetters_px = 96;  // at 720 rows

}  // namespace

Ink ink_of(const mars::StyleColour& colour, double opacity) {
  return {colour.rgb.r / 255.0, colour.rgb.g / 255.0, colour.rgb.b / 255.0, colour.opacity * opacity};
}

double FeaturePainter::width_px(const mars::FeatureStyle& style, double distance_m) const {
  return std::clamp(scale.length_px(style.width, distance_m), kThinnestLine_px, kWidestLine_px);
}

double FeaturePainter::radius_px(const mars::FeatureStyle& style, double distance_m) const {
  return std::max(kSmallestMarker_px, 0.5 * scale.length_px(style.marker_size, distance_m));
}

double FeaturePainter::rim_px() const { return std::max(scale.unit, 0.75); }

Font FeaturePainter::font(const mars::FeatureStyle& style, double distance_m) const {
  // Smaller letters are not legible in images of any size.
  const double least_px = std::max(11 * scale.unit, 0.7 * 11);
  return {std::clamp(scale.length_px(style.label_size, distance_m), least_px,
                     std::max(least_px, kLargestLetters_px * scale.unit)),
          false};
}

void FeaturePainter::run(Canvas& canvas, const DrapedRun& run, const mars::FeatureStyle& style,
                         glm::dvec2 corner) const {
  if (run.is_hidden && hidden == core::HiddenLines::kLeftOut) return;
  std::vector<double> lengths;
  for (const mars::StyleLength& length : style.dash)
    lengths.push_back(std::max(0.5, scale.length_px(length, run.distance_m)));
  double shown = opacity;
  if (run.is_hidden) {
    lengths = {kHiddenDash_px * scale.unit, kHiddenDash_px * scale.unit};
    shown *= kHiddenOpacity;
  }
  const double width = width_px(style, run.distance_m);
  // Before they are moved, so that all parts of an image draw the same line.
  std::vector<glm::dvec2> points = simplified(run.points_px);
  for (glm::dvec2& p : points) p -= corner;
  canvas.dashed(points, width, ink_of(*style.stroke, shown), lengths);
}

void FeaturePainter::marker(Canvas& canvas, glm::dvec2 at_px, double distance_m,
                            const mars::FeatureStyle& style) const {
  if (!style.marker) return;
  const double radius = radius_px(style, distance_m);
  const auto disc = [&](double r, const Ink& ink) {
    std::array<glm::dvec2, 24> circle;
    for (std::size_t n = 0; n < circle.size(); ++n) {
      const double a = 2 * mars::kPi * static_cast<double>(n) / static_cast<double>(circle.size());
      circle[n] = at_px + r * glm::dvec2(std::cos(a), std::sin(a));
    }
    canvas.polygon(circle, ink);
  };
  disc(radius + rim_px(), {kShade.r, kShade.g, kShade.b, kShade.a * opacity});
  disc(radius, ink_of(*style.marker, opacity));
}

}  // namespace vpe::overlay
