// A renderer that can also draw single pixels of an image, for images most of which is known already.
//
// Typical usage:
//   Frame frame = known;                                       // of the view of the request, with ranges
//   const DrawResult drawn = renderer->draw_pixels(request, {wanted, clear_m}, frame);
#pragma once

#include <cstdint>
#include <span>

#include "vpe/core/frame.h"

namespace vpe::core {

// Names pixels of an image's drawn part; both members have an entry for each, row by row from the top.
struct WantedPixels {
  std::span<const std::uint8_t> is_wanted;  // not 0: yes
  // Range that is known to be clear: the pixel's ray meets nothing nearer, metres; 0 where nothing is known. Larger: fewer
  // steps along the ray. kSkyRange: the pixel shows sky, and is painted only.
  std::span<const float> clear_m;
};

class PixelRenderer : public Renderer {
 public:
  // Draws the wanted pixels of the image that draw() would draw with settings.smooth_edges = false and settings.gamma = 1,
  // and writes their ranges and, if the request wants them, colours into `frame`, which has the size of that image. Leaves
  // the others alone. The pixels are those of draw(), but for rays that meet something nearer than clear_m. The result has
  // no frame; its certificate is that of the wanted pixels.
  //
  // Throws std::invalid_argument if sizes do not fit and for several samples a pixel; else what draw() throws.
  virtual DrawResult draw_pixels(const DrawRequest& request, const WantedPixels& wanted, Frame& frame) = 0;
};

}  // namespace vpe::core
