// Size checks that every reader and writer of images makes before it allocates. Private to vpe/core.
#pragma once

#include <cstddef>
#include <cstdint>

namespace vpe::core {

// Throws ImageError unless width * height == pixels and both sides are 1 to kMaxImageSide_px.
void check_image_size(std::size_t pixels, int width, int height);

// Throws ImageError for a side of 0, a side over kMaxImageSide_px, or more than max_pixels.
void check_read_size(std::uint32_t width, std::uint32_t height, std::int64_t max_pixels);

}  // namespace vpe::core
