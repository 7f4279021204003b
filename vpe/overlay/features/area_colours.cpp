#include "vpe/overlay/features/area_colours.h"

#include <algorithm>
#include <cmath>

namespace vpe::overlay {
namespace {

std::uint8_t to_byte(double x) { return static_cast<std::uint8_t>(std::clamp(std::round(x), 0.0, 255.0)); }

}  // namespace

void FillColour::add(const FillColour& other, double share) {
  r += share * other.r;
  g += share * other.g;
  b += share * other.b;
  a += share * other.a;
}

FillColour FillColour::over(const FillColour& below) const {
  FillColour sum = *this;
  sum.add(below, 1 - a);
  return sum;
}

base::Rgb FillColour::over(base::Rgb below) const {
  return {to_byte(r + (1 - a) * below.r), to_byte(g + (1 - a) * below.g), to_byte(b + (1 - a) * below.b)};
}

core::Rgba FillColour::straight() const {
  if (!(a > 0)) return {0, 0, 0, 0};
  return {to_byte(r / a), to_byte(g / a), to_byte(b / a), to_byte(255 * a)};
}

FillColour AreaColours::at(std::span<const std::uint32_t> found, glm::dvec2 place_deg, double distance_m,
                           LayerUse* use) const {
  FillColour sum;
  for (const std::uint32_t n : found) {
    const GroundFeatures::Area& area = features_.areas()[n];
    const mars::FeatureStyle& style = features_.style(area.feature);
    if (!scale_.shows(style, distance_m) || !area.index.contains(place_deg)) continue;
    const double alpha = style.fill->opacity * opacity_;
    const base::Rgb& rgb = style.fill->rgb;
    sum = FillColour{rgb.r * alpha, rgb.g * alpha, rgb.b * alpha, alpha}.over(sum);
    if (use != nullptr) use->areas[features_.style_number(area.feature)] = 1;
  }
  return sum;
}

}  // namespace vpe::overlay
