#include "paging/build/build_grid.h"
#include "vpe/core/image/image.h"

namespace paging {

void build_image(const BuildContext& context, const mars::ImageSource& image, const lod::TileKey& key) {
  const lod::GridLines lines = lod::grid_lines(key, kImageIntervals);
  const std::vector<glm::dvec3> directions = post_directions(key, lines);
  std::vector<vpe::base::Rgb> colours(directions.size());
  std::vector<std::uint8_t> alpha(directions.size());
  image.sample(directions, lod::post_spacing_m(key.level, kImageIntervals, context.meta.radius_m), colours,
               alpha);
  for (std::size_t n = 0; n < colours.size(); ++n) {
    if (alpha[n] == 0) colours[n] = {128, 128, 128};
  }
  constexpr int kSide = kImageIntervals + 1;
  context.writer.put_image(key, vpe::core::encode_jpeg(colours, kSide, kSide, context.options.image_quality));
}

}  // namespace paging
