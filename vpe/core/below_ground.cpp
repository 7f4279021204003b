#include "vpe/core/below_ground.h"

#include <limits>

namespace vpe::core {

namespace {

constexpr base::Rgb kColour{32, 28, 26};

}  // namespace

void draw_below_ground(const DrawRequest& request, DrawResult& result) {
  const glm::ivec2 size = drawn_size(request.view);
  const std::size_t pixels = static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
  result.frame.width = size.x;
  result.frame.height = size.y;
  result.frame.colour.assign(request.want_colour ? pixels : 0, kColour);
  result.frame.range_m.assign(request.want_range ? pixels : 0, 0.0F);
  result.certificate.is_below_ground = true;
  result.certificate.screen_space_error_px = std::numeric_limits<double>::infinity();
  result.certificate.shift_bound_px = std::numeric_limits<double>::infinity();
  result.certificate.image_bound_px = std::numeric_limits<double>::infinity();
}

}  // namespace vpe::core
