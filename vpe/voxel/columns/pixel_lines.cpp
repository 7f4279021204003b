#include "vpe/voxel/columns/pixel_lines.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace vpe::voxel {

PixelLines::PixelLines(int width, int height, const glm::dvec2& along) {
  if (width < 1 || height < 1) throw std::invalid_argument("lines of pixels: the image has no pixels");
  is_upright_ = !(std::abs(along.x) > std::abs(along.y));
  steps_ = is_upright_ ? height : width;
  across_ = is_upright_ ? width : height;
  const double forward = is_upright_ ? along.y : along.x;
  const double aside = is_upright_ ? along.x : along.y;
  is_forward_ = forward > 0;
  turns_up_ = aside >= 0;
  const double slope = forward == 0 ? 0 : std::abs(aside / forward);
  for (int n = 0; n < steps_; ++n) {
    const int offset = static_cast<int>(std::floor(n * slope + 0.5));
    shifts_.push_back(!offsets_.empty() && offset > offsets_.back() ? 1 : 0);
    offsets_.push_back(offset);
  }
  count_ = across_ + offsets_.back();
  // Lines that move aside enter over the border, too.
  first_start_ = turns_up_ ? -offsets_.back() : 0;
}

void PixelLines::get(int n, std::vector<Pixel>& pixels) const {
  pixels.clear();
  const int start = first_start_ + n;
  for (int step = 0; step < steps_; ++step) {
    const int offset = offsets_[static_cast<std::size_t>(step)];
    const int at = turns_up_ ? start + offset : start - offset;
    if (at < 0 || at >= across_) continue;
    const int along = is_forward_ ? step : steps_ - 1 - step;
    pixels.push_back(is_upright_ ? Pixel{at, along} : Pixel{along, at});
  }
}

}  // namespace vpe::voxel
