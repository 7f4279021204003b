#include "vpe/voxel/paint/scale_table.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

namespace vpe::voxel {

namespace {

ScaleTable::Bucket bucket(const glm::dvec3& base, const glm::dvec3& rise, bool straight) {
  ScaleTable::Bucket out{};
  for (int c = 0; c < 3; ++c) {
    out.base[static_cast<std::size_t>(c)] = static_cast<float>(base[c]);
    out.rise[static_cast<std::size_t>(c)] = static_cast<float>(rise[c]);
  }
  out.base[3] = straight ? 0.0F : 1.0F;
  return out;
}

}  // namespace

ScaleTable scale_table(const core::ColourScale& scale) {
  const auto stops = scale.stops();
  const double first = stops.front().at;
  const double last = stops.back().at;
  ScaleTable out;
  out.first = static_cast<float>(first);
  out.undefined_value = static_cast<float>(scale.low());
  const double per_unit = ScaleTable::kInner / (last - first);
  const bool usable = last > first && per_unit < 1e30;
  out.per_unit = usable ? static_cast<float>(per_unit) : 0.0F;

  out.buckets.push_back(bucket(stops.front().rgb, glm::dvec3(0), usable));
  for (int n = 0; n < ScaleTable::kInner; ++n) {
    // Rounding of values to float can move a stop this far into the next bucket.
    constexpr double kSlack = 1e-3;
    const double from = first + (last - first) * n / ScaleTable::kInner;
    const double width = (last - first) / ScaleTable::kInner;
    const glm::dvec3 base = scale(from);
    // Measured at the middle, as a step may lie right at the end.
    const glm::dvec3 middle = scale(from + 0.5 * width);
    glm::dvec3 rise = 2.0 * (middle - base);
    bool step = false;
    bool bends = false;
    for (std::size_t s = 0; s < stops.size(); ++s) {
      const double at = (stops[s].at - from) / width;
      if (at < -kSlack || at > 1 + kSlack) continue;
      step = step || (s > 0 && stops[s].at == stops[s - 1].at);
      bends = bends || (at > kSlack && at < 1 - kSlack);
    }
    double worst = 0;
    if (bends) {
      rise = scale(from + width) - base;
      for (const core::PaletteStop& stop : stops) {
        const double at = (stop.at - from) / width;
        if (at < 0 || at > 1) continue;
        const glm::dvec3 off = glm::abs(base + rise * at - stop.rgb);
        worst = std::max({worst, off.x, off.y, off.z});
      }
    }
    out.buckets.push_back(bucket(base, rise, usable && !step && worst <= kScaleTableError));
  }
  out.buckets.push_back(bucket(stops.back().rgb, glm::dvec3(0), usable));
  return out;
}

}  // namespace vpe::voxel
