// Reduction of images to half their size, row by row.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "vpe/base/rgb.h"

namespace panorama {

// Returns the side of the next smaller level: half, rounded up.
inline std::int64_t half_px(std::int64_t side_px) { return (side_px + 1) / 2; }

// Takes the rows of an image from the top, and gives those of an image whose sides are half_px() of its own.
// Each pixel is the mean over its area, so odd sizes shift nothing: places keep to the ratio of the sizes.
// Means are of the stored values, rounded to the nearest. The same bytes on every machine. For one thread.
class BoxDownsampler {
 public:
  using Row = std::span<const vpe::base::Rgb>;
  // `give` receives each finished row.
  BoxDownsampler(std::int64_t width_px, std::int64_t height_px, std::function<void(Row)> give);

  // Returns the width of the rows given.
  std::int64_t width_px() const { return static_cast<std::int64_t>(out_.size()); }
  // Takes the next row.
  void take(Row row);

 private:
  void give_row();

  std::int64_t width_px_;
  std::int64_t height_px_;
  std::int64_t out_height_px_;
  std::int64_t row_ = 0;      // next to be taken
  std::int64_t out_row_ = 0;  // next to be given
  std::function<void(Row)> give_;
  std::vector<std::uint64_t> sums_;  // of the row to be given so far, three a pixel
  std::vector<std::uint64_t> across_;
  std::vector<vpe::base::Rgb> out_;
};

}  // namespace panorama
