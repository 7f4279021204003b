// Masks: which pixels of a photograph show an object.
//
// Typical usage:
//   const PhotoMask a = mask_by_background(photo, {208, 200, 192}, 24);
//   const PhotoMask b = mask_by_contour(read_contour_file("tank.txt"), photo.width, photo.height);
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/vec2.hpp>
#include <vector>

#include "vpe/core/image/image.h"

namespace objects {

struct PhotoMask {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> shows;  // width * height, row 0 at the top: 1 where the object is seen, else 0
};

struct ContourLimits {
  static constexpr std::size_t kMostPoints = 1'000'000;
  static constexpr std::uintmax_t kMostBytes = std::uintmax_t{64} << 20;
};

// Returns the mask of all that is not background: pixels that are within `tolerance` of a colour in each channel, and
// joined with the border of the image by sides of such pixels. Spots of that colour on the object stay. Pure.
PhotoMask mask_by_background(const vpe::core::RgbImage& image, const vpe::base::Rgb& colour, int tolerance);

// Returns the mask of the pixels whose centres lie inside a closed polygon (even-odd rule). Points count in pixels
// from the upper left corner of the image, so that the first pixel's centre is at (0.5, 0.5). Throws
// std::invalid_argument for sizes that are not positive or above vpe::core::kMaxImageSide_px. Pure.
PhotoMask mask_by_contour(const std::vector<glm::dvec2>& points, int width, int height);

// Returns the points of a text file: "x,y" in pixels on each line. Empty lines and those that begin with # are passed
// over. Throws vpe::base::FileError, which names the file and the line, also for fewer than three points.
std::vector<glm::dvec2> read_contour_file(const std::filesystem::path& path);

}  // namespace objects
