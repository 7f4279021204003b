#include "paging/build/build_grid.h"
#include "vpe/core/image/image.h"

namespace paging {

Bytes make_image_tile(const mars::ImageSource& image, const lod::TileKey& key, double radius_m, int quality) {
  const lod::GridLines lines = lod::grid_lines(key, kImageIntervals);
  const std::vector<glm::dvec3> directions = post_directions(key, lines);
  std::vector<vpe::base::Rgb> colours(directions.size());
  std::vector<std::uint8_t> alpha(directions.size());
  image.sample(directions, lod::post_spacing_m(key.level, kImageIntervals, radius_m), colours, alpha);
  for (std::size_t n = 0; n < colours.size(); ++n) {
    if (alpha[n] == 0) colours[n] = {128, 128, 128};
  }
  constexpr int kSide = kImageIntervals + 1;
  return vpe::core::encode_jpeg(colours, kSide, kSide, quality);
}

}  // namespace paging
