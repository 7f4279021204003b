#include "panorama/viewer/render_view.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "panorama/viewer/sampler.h"
#include "panorama/viewer/view_places.h"
#include "vpe/base/parallel.h"

namespace panorama {

namespace {

constexpr int kBand_px = 16;

// Returns the place in an image of the full circle that begins where the map's does.
glm::dvec2 place_of(const PanoramaMap& map, const Direction& direction) {
  glm::dvec2 place = map.place(direction);
  if (place.x < 0.0) place.x += map.turn_px;
  return place;
}

std::uint8_t to_byte(float value) { return static_cast<std::uint8_t>(std::clamp(value, 0.0F, 255.0F) + 0.5F); }

}  // namespace

bool is_shown(const PanoramaMap& map, const glm::dvec2& place) {
  const bool is_closed = static_cast<double>(map.width_px) > map.turn_px - 1.0;
  return (is_closed || place.x <= static_cast<double>(map.width_px)) && place.y >= 0.0 &&
         place.y <= static_cast<double>(map.height_px);
}

std::optional<glm::dvec2> shown_place(const PanoramaMap& map, const Direction& direction) {
  if (!std::isfinite(direction.azimuth_deg) || !(std::abs(direction.elevation_deg) <= 90.0))
    return std::nullopt;
  const glm::dvec2 place = place_of(map, direction);
  if (!is_shown(map, place)) return std::nullopt;
  return place;
}

vpe::core::RgbImage render_view(const TiledImage& tiled_image, const PanoramaMap& map,
                                const vpe::core::View& view, const RenderViewOptions& options) {
  for (const std::string& trouble : {check(map), vpe::core::check(view)}) {
    if (!trouble.empty()) throw std::invalid_argument(trouble);
  }
  const glm::ivec2 size = vpe::core::drawn_size(view);
  vpe::core::RgbImage image{size.x, size.y, {}};
  image.pixels.assign(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y), options.outside);
  const auto difference = [&map](const glm::dvec2& a, const glm::dvec2& b) {
    return glm::dvec2(std::remainder(b.x - a.x, map.turn_px), b.y - a.y);
  };
  const ViewPlaces places(map, view);
  const auto bands = static_cast<std::size_t>((size.y + kBand_px - 1) / kBand_px);
  vpe::base::parallel_for(bands, options.threads, [&](std::size_t band) {
    Sampler sampler(tiled_image, map, options.origin);
    const int begin = static_cast<int>(band) * kBand_px;
    const int end = std::min(size.y, begin + kBand_px);
    // One place more than there are pixels, and one row, for the footprints of the last ones.
    std::vector<glm::dvec2> row(static_cast<std::size_t>(size.x) + 1);
    std::vector<glm::dvec2> next(row.size());
    places.row(begin, next);
    for (int y = begin; y < end; ++y) {
      std::swap(row, next);
      places.row(y + 1, next);
      vpe::base::Rgb* out =
          image.pixels.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(size.x);
      for (std::size_t x = 0; x + 1 < row.size(); ++x) {
        if (!is_shown(map, row[x])) continue;
        const glm::vec3 c = sampler.mean(row[x], difference(row[x], row[x + 1]), difference(row[x], next[x]));
        out[x] = {to_byte(c.r), to_byte(c.g), to_byte(c.b)};
      }
    }
  });
  return image;
}

}  // namespace panorama
