#include "vpe/window/explore_layout.h"

#include <algorithm>
#include <cmath>

namespace vpe::window {

double largest_scale(int width, int height) {
  using L = LayoutLimits;
  constexpr double kStep = 0.05;
  const double scale = std::min(width * L::kSideShare / L::kSide_px, height / L::kLeastHeight_px);
  return kStep * std::floor(scale / kStep + 1e-9);
}

ExploreLayout layout_of(const LayoutInput& input) {
  using L = LayoutLimits;
  constexpr double kLeast_px = 16;  // of the view, so that there is always an image
  const double width = std::max(1, input.width);
  const double height = std::max(1, input.height);
  ExploreLayout layout;
  layout.is_narrow = width < L::kNarrowWindow_px * input.scale;
  const double wanted =
      std::clamp(input.side_px > 0 ? input.side_px : L::kSide_px, L::kNarrowest_px, L::kWidest_px) *
      input.scale;
  const double status = input.panels ? std::round(L::kStatus_px * input.scale) : 0.0;
  layout.view.height = std::max(kLeast_px, height - status);
  layout.status = {0, layout.view.height, input.panels ? width : 0, height - layout.view.height};
  if (layout.is_narrow) {
    layout.view.width = std::max(kLeast_px, width);
    if (input.panels && input.side_is_open)
      layout.side = {0, 0, std::round(std::min(wanted, width * L::kSideShare)), layout.view.height};
    return layout;
  }
  const double side = input.panels ? std::round(std::min(wanted, width - L::kLeastView_px * input.scale)) : 0.0;
  layout.side = {0, 0, side, layout.view.height};
  layout.view.x = side;
  layout.view.width = width - side;
  return layout;
}

}  // namespace vpe::window
