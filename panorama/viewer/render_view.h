// Views of any projection, resampled from the image of a panorama.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>

#include "panorama/image/tiled_image.h"
#include "panorama/projection.h"
#include "vpe/core/image/image.h"
#include "vpe/core/view.h"

namespace panorama {

// Describes where the map's image begins in the file's. The right or lower image of a stored stereo pair does
// not begin at 0.
struct ImageOrigin {
  std::int64_t x_px = 0;
  std::int64_t y_px = 0;
};

struct RenderViewOptions {
  ImageOrigin origin;
  vpe::base::Rgb outside{38, 40, 46};  // colour of directions that the image does not show
  int threads = 0;                     // 0 = all cores
};

// Draws a view whose axes are in the panorama's frame (viewer.h). Each pixel is a mean over about its own area:
// of up to 16 samples along the longer axis of its footprint, each interpolated between four pixels and two
// levels. Across the seam of 360 degrees and between facets the neighbours are those of the directions; the
// image's upper and lower edge, and its sides when it is no full circle, are sharp. The same bytes for any
// number of threads. Throws std::invalid_argument for a view or map that check() refuses, and what reading
// tiles throws.
vpe::core::RgbImage render_view(const TiledImage& tiled_image, const PanoramaMap& map,
                                const vpe::core::View& view, const RenderViewOptions& options);

// Returns whether the map's image has a place, x in [0, turn_px).
bool is_shown(const PanoramaMap& map, const glm::dvec2& place);

// Returns the place where the image shows a direction, x in [0, turn_px); nullopt where it shows none. Images
// of a full circle within a pixel have no gap.
std::optional<glm::dvec2> shown_place(const PanoramaMap& map, const Direction& direction);

}  // namespace panorama
