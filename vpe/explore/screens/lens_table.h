// Finished images as a screen behind a lens must show them, and back.
#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "vpe/core/image/image.h"
#include "vpe/explore/screens/lens.h"

namespace vpe::explore {

// Holds for each pixel of a screen where its colour is in the undistorted image. May be used by any number of threads.
class LensTable {
 public:
  // The lens must be one that check() accepts.
  LensTable(const ScreenLens& lens, int width_px, int height_px, int side);

  int width_px() const { return width_px_; }
  int height_px() const { return height_px_; }
  // Returns the undistorted image that is needed.
  const LensImage& image() const { return image_; }
  // Returns the position in that image, pixels, within 2e-3: it is kept in single precision.
  glm::vec2 at(int x, int y) const;

 private:
  int width_px_ = 0;
  int height_px_ = 0;
  LensImage image_;
  std::vector<glm::vec2> positions_;
};

// Returns the screen's image of an undistorted one, bilinearly filtered. A coarser image of the same view may stand for
// the whole one: it is stretched. Throws std::invalid_argument for an image without pixels. Pure.
core::RgbImage through_lens(const core::RgbImage& undistorted_image, const LensTable& table);

// Returns the undistorted image of a screen's image, bilinearly filtered: the inverse of through_lens(). What the screen
// does not show is black. Throws std::invalid_argument for another size than the screen's. Pure.
core::RgbImage without_lens(const core::RgbImage& screen_image, const ScreenLens& lens, int side);

}  // namespace vpe::explore
