#include "vpe/overlay/filled_areas.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "vpe/overlay/features/area_colours.h"

namespace vpe::overlay {

ShownPlaces shown_places(const VisibleTerrain& terrain) {
  return {terrain.longitudes_deg(), terrain.latitudes_deg()};
}

Layer fill_areas(const GroundFeatures& features, const VisibleTerrain& terrain, const ShownPlaces& places,
                 double opacity, LayerUse* use) {
  const int width = terrain.width();
  const int height = terrain.height();
  const AreaColours areas(features, opacity,
                          {std::min(width, height) / 720.0, core::focal_px(terrain.scene().view)});
  std::vector<std::uint32_t> found;
  const auto colour_at = [&](glm::dvec2 place_deg, std::size_t i) {
    areas.find(place_deg, 0, found);
    return areas.at(found, place_deg, static_cast<double>(terrain.scene().range_m[i]), use);
  };
  const auto place = [&](std::size_t i) { return glm::dvec2(places.lon_deg[i], places.lat_deg[i]); };
  std::vector<FillColour> colours(places.lon_deg.size());
  bool is_any = false;
  for (std::size_t i = 0; i < colours.size(); ++i) {
    if (!std::isfinite(places.lon_deg[i])) continue;
    colours[i] = colour_at(place(i), i);
    is_any = is_any || colours[i].a > 0;
  }
  if (!is_any) return {};
  Layer out{width, height, std::vector<core::Rgba>(colours.size())};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::size_t i = terrain.index(x, y);
      const auto down = static_cast<std::size_t>(width);
      FillColour own = colours[i];
      const bool inner = x > 0 && y > 0 && x + 1 < width && y + 1 < height;
      if (inner && std::isfinite(places.lon_deg[i]) &&
          (own != colours[i - 1] || own != colours[i + 1] || own != colours[i - down] ||
           own != colours[i + down]) &&
          terrain.is_whole(x - 1, y - 1) && terrain.is_whole(x, y)) {
        glm::dvec2 across = place(i + 1) - place(i - 1);
        glm::dvec2 along = place(i + down) - place(i - down);
        across.x = std::remainder(across.x, 360.0);
        along.x = std::remainder(along.x, 360.0);
        own = {};
        // A quarter of a pixel from the middle; differences are over two pixels.
        for (const glm::dvec2& at :
             {glm::dvec2{-1, -1}, glm::dvec2{1, -1}, glm::dvec2{-1, 1}, glm::dvec2{1, 1}})
          own.add(colour_at(place(i) + across * (at.x / 8) + along * (at.y / 8), i), 0.25);
      }
      out.pixels[i] = own.straight();
    }
  }
  return out;
}

}  // namespace vpe::overlay
