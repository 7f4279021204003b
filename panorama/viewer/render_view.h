// What somebody sees who looks into a panorama: a view of any projection drawn from its image.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>

#include "panorama/image/tiled_image.h"
#include "panorama/projection.h"
#include "vpe/core/image/image.h"
#include "vpe/core/view.h"

namespace panorama {

// Where the map's image begins in the file's: the right or lower camera of a stored pair does not begin at 0.
struct ImageOrigin {
  std::int64_t x_px = 0;
  std::int64_t y_px = 0;
};

struct RenderViewOptions {
  ImageOrigin origin;
  vpe::base::Rgb outside{38, 40, 46};  // where the image shows nothing
  int threads = 0;                     // 0 = all cores
};

// Draws a view whose axes are in the panorama's frame (viewer.h). Each pixel is a mean over about its own area:
// taken along the longer axis of its footprint at up to 16 places, each between four pixels and two levels.
// Across the seam of 360 degrees and of facets the neighbours are those of the directions; the image's upper
// and lower edge, and its sides when it is no full turn, are sharp. The same bytes for any number of threads.
// Throws std::invalid_argument for a view or map that check() refuses, and what reading tiles throws.
vpe::core::RgbImage look(const TiledImage& tiled_image, const PanoramaMap& map, const vpe::core::View& view,
                         const RenderViewOptions& options);

// Column of an image without gaps that shows what the map has at place(); nothing where the image shows
// nothing. Images of a full turn within a pixel have no gap.
std::optional<glm::dvec2> shown_place(const PanoramaMap& map, const Direction& direction);

}  // namespace panorama
