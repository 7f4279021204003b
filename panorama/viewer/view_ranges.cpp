#include "panorama/viewer/view_ranges.h"

#include <algorithm>
#include <cmath>

#include "panorama/viewer/render_view.h"
#include "panorama/viewer/viewer.h"
#include "vpe/core/frame.h"

namespace panorama {

bool has_ranges(const PanoramaDescription& description) {
  return std::ranges::any_of(description.planes, [](const PlaneName& name) { return name.name == "range"; });
}

std::optional<PlaneReader> open_ranges(const PanoramaDescription& description, std::size_t budget_bytes) {
  for (const PlaneName& name : description.planes) {
    if (name.name == "range")
      return PlaneReader(description.image.parent_path() / name.file, description.map.width_px,
                         description.map.height_px, budget_bytes);
  }
  return std::nullopt;
}

std::vector<float> view_ranges(PlaneReader& ranges, const PanoramaMap& map, const vpe::core::View& view) {
  const vpe::core::SubRectangle part = vpe::core::drawn_part(view);
  std::vector<float> out;
  out.reserve(static_cast<std::size_t>(part.width) * static_cast<std::size_t>(part.height));
  for (int y = 0; y < part.height; ++y) {
    for (int x = 0; x < part.width; ++x) {
      const auto place =
          shown_place(map, to_direction(vpe::core::pixel_ray(view, part.x + x + 0.5, part.y + y + 0.5)));
      double range_m = 0;
      if (place) {
        const auto column = std::clamp<std::int64_t>(static_cast<std::int64_t>(place->x), 0, map.width_px - 1);
        const auto row = std::clamp<std::int64_t>(static_cast<std::int64_t>(place->y), 0, map.height_px - 1);
        range_m = ranges.at(column, row);
      }
      out.push_back(std::isfinite(range_m) && range_m > 0 ? static_cast<float>(range_m) : vpe::core::kSkyRange);
    }
  }
  return out;
}

}  // namespace panorama
