#include "panorama/viewer/view_ranges.h"

#include <algorithm>
#include <cmath>

#include "panorama/viewer/render_view.h"
#include "panorama/viewer/view_places.h"
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
  const ViewPlaces places(map, view);
  std::vector<glm::dvec2> row(static_cast<std::size_t>(part.width));
  for (int y = 0; y < part.height; ++y) {
    places.row(y, row);
    for (const glm::dvec2& place : row) {
      double range_m = 0;
      if (is_shown(map, place)) {
        const auto column = std::clamp<std::int64_t>(static_cast<std::int64_t>(place.x), 0, map.width_px - 1);
        const auto line = std::clamp<std::int64_t>(static_cast<std::int64_t>(place.y), 0, map.height_px - 1);
        range_m = ranges.at(column, line);
      }
      out.push_back(std::isfinite(range_m) && range_m > 0 ? static_cast<float>(range_m) : vpe::core::kSkyRange);
    }
  }
  return out;
}

}  // namespace panorama
