#include "vpe/warp/fill_open.h"

#include <algorithm>
#include <cstddef>

namespace vpe::warp {

namespace {

// Fills the runs of one row. Returns false if all of it is open.
bool fill_row(CarriedImage& image, std::size_t row_begin) {
  const auto width = static_cast<std::size_t>(image.width);
  bool has_other = false;
  for (std::size_t x = 0; x < width;) {
    if (image.origin[row_begin + x] != Origin::kOpen) {
      has_other = true;
      ++x;
      continue;
    }
    std::size_t end = x;
    while (end < width && image.origin[row_begin + end] == Origin::kOpen) ++end;
    if (x == 0 && end == width) return false;
    const std::size_t left = row_begin + x - (x > 0 ? 1 : 0);
    const std::size_t right = row_begin + end;
    const bool takes_left = end == width || (x > 0 && image.range_m[left] >= image.range_m[right]);
    const std::size_t from = takes_left ? left : right;
    for (std::size_t n = row_begin + x; n < row_begin + end; ++n) {
      image.range_m[n] = image.range_m[from];
      if (!image.colour.empty()) image.colour[n] = image.colour[from];
    }
    x = end;
  }
  return has_other;
}

void copy_row(CarriedImage& image, std::size_t from, std::size_t to) {
  const auto width = static_cast<std::ptrdiff_t>(image.width);
  const auto copy = [&](auto& values) {
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(from) * width;
    std::copy(begin, begin + width, values.begin() + static_cast<std::ptrdiff_t>(to) * width);
  };
  copy(image.range_m);
  if (!image.colour.empty()) copy(image.colour);
}

}  // namespace

std::int64_t fill_open(CarriedImage& image) {
  if (image.width <= 0 || image.height <= 0) return 0;
  const auto rows = static_cast<std::size_t>(image.height);
  std::vector<bool> is_known(rows);
  for (std::size_t y = 0; y < rows; ++y)
    is_known[y] = fill_row(image, y * static_cast<std::size_t>(image.width));
  const auto first =
      static_cast<std::size_t>(std::find(is_known.begin(), is_known.end(), true) - is_known.begin());
  if (first < rows) {
    for (std::size_t y = 0; y < rows; ++y)
      if (!is_known[y]) copy_row(image, y < first ? first : y - 1, y);
  }
  return image.count(Origin::kOpen);
}

}  // namespace vpe::warp
