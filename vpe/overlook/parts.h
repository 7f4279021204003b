// The parts of a panorama's image that a view shows, and the tiles of its levels that each is drawn from: a virtual
// texture. Pure: no OpenGL, no images.
#pragma once

#include <compare>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "panorama/viewer/level_grid.h"
#include "vpe/core/view.h"
#include "vpe/overlook/direction_patch.h"

namespace vpe::overlook {

// Names a square of a level: its pixels from LevelGrid::left + kTextureSide_px * column, likewise rows. The last one of a
// row or column has the rest.
struct TextureKey {
  int level = 0;
  std::int64_t column = 0;
  std::int64_t row = 0;
  auto operator<=>(const TextureKey&) const = default;
};
inline constexpr int kTextureSide_px = 256;

struct Part {
  // The most levels that a part is drawn from; a part that needs more is divided.
  static constexpr std::size_t kMostLevels = 4;

  Rectangle rectangle;  // of the map's image; on one facet
  int facet = 0;
  std::vector<TextureKey>
      textures;  // of successive levels, the finest first; the rectangle lies on one of each
  Cuts cuts;
  // No pixel of the view takes more samples of the image: 1, 2, or 16 for any number.
  int most_samples = 16;
  bool is_enlarged =
      false;  // each pixel of the view is at most one of the image wide: one level and one sample
};

struct PartOptions {
  // Largest distance, in pixels of the view, between a pixel and where the place that it shows should be drawn. Smaller:
  // more triangles; larger: pixels differ more from render_view()'s.
  double shift_px = 0.02;
};

// Returns the parts that cover all of the image in a perspective view whose axes are in the panorama's frame. Levels are
// those that panorama::render_view() filters with; where a texture is not ready, coarser ones whose textures are. The
// coarsest level counts as ready. The view must pass core::check(), the map panorama::check().
std::vector<Part> choose_parts(const panorama::PanoramaMap& map, std::span<const panorama::LevelGrid> grids,
                               const core::View& view, const PartOptions& options,
                               const std::function<bool(const TextureKey&)>& is_ready);

}  // namespace vpe::overlook
