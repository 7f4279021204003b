#include "objects/sticks/sculpt_view.h"

#include <algorithm>
#include <cmath>

namespace objects {

SculptAxes axes_of(SculptSide side) {
  switch (side) {
    case SculptSide::kRight: return {1, 2, 0, false, 1};
    case SculptSide::kLeft: return {1, 2, 0, true, -1};
    case SculptSide::kFront: return {0, 2, 1, true, 1};
    case SculptSide::kBack: return {0, 2, 1, false, -1};
    case SculptSide::kTop: return {0, 1, 2, false, 1};
    case SculptSide::kBottom: break;
  }
  return {0, 1, 2, true, -1};
}

std::optional<PixelBox> silhouette_box(const PhotoMask& mask) {
  int left = mask.width;
  int right = -1;
  int top = mask.height;
  int bottom = -1;
  for (int y = 0; y < mask.height; ++y) {
    const auto begin = mask.shows.begin() + std::ptrdiff_t{y} * mask.width;
    const auto end = begin + mask.width;
    const auto is_shown = [](std::uint8_t m) { return m != 0; };
    const auto first = std::find_if(begin, end, is_shown);
    if (first == end) continue;
    left = std::min(left, static_cast<int>(first - begin));
    const auto last =
        std::find_if(std::make_reverse_iterator(end), std::make_reverse_iterator(begin), is_shown);
    right = std::max(right, static_cast<int>(last.base() - begin) - 1);
    top = std::min(top, y);
    bottom = y;
  }
  if (bottom < 0) return std::nullopt;
  return PixelBox{left, top, right - left + 1, bottom - top + 1};
}

namespace {

// Returns how much of pixel n lies in a range.
double pixel_share(int n, double begin, double end) {
  return std::max(0.0, std::min(end, n + 1.0) - std::max(begin, static_cast<double>(n)));
}

// Sums of a mask over all pixels above and to the left of a place, between pixels too.
class MaskSums {
 public:
  MaskSums(const PhotoMask& mask, const PixelBox& box)
      : box_(box),
        row_(static_cast<std::size_t>(box.width) + 1),
        sums_(row_ * (static_cast<std::size_t>(box.height) + 1)) {
    for (int y = 0; y < box.height; ++y) {
      std::uint32_t in_row = 0;
      const std::size_t from = static_cast<std::size_t>(box.y + y) * static_cast<std::size_t>(mask.width) +
                               static_cast<std::size_t>(box.x);
      const std::size_t to = (static_cast<std::size_t>(y) + 1) * row_;
      for (std::size_t x = 0; x < row_ - 1; ++x) {
        in_row += mask.shows[from + x] != 0 ? 1U : 0U;
        sums_[to + x + 1] = sums_[to + x + 1 - row_] + in_row;
      }
    }
  }

  // Places count from the corner of the box.
  double at(double x, double y) const {
    const auto column = static_cast<std::size_t>(std::clamp(std::floor(x), 0.0, box_.width - 1.0));
    const auto line = static_cast<std::size_t>(std::clamp(std::floor(y), 0.0, box_.height - 1.0));
    const double right = std::clamp(x - static_cast<double>(column), 0.0, 1.0);
    const double down = std::clamp(y - static_cast<double>(line), 0.0, 1.0);
    const std::uint32_t* s = sums_.data() + line * row_ + column;
    return (s[0] * (1 - right) + s[1] * right) * (1 - down) +
           (s[row_] * (1 - right) + s[row_ + 1] * right) * down;
  }

 private:
  PixelBox box_;
  std::size_t row_;
  std::vector<std::uint32_t> sums_;
};

}  // namespace

ProjectedView::ProjectedView(const SculptView& view, const glm::ivec3& voxels)
    : view_(view),
      axes_(axes_of(view.side)),
      box_(silhouette_box(view.mask).value_or(PixelBox{0, 0, 1, 1})),
      across_(voxels[axes_.across]),
      up_(voxels[axes_.up]),
      shows_(static_cast<std::size_t>(across_) * static_cast<std::size_t>(up_)) {
  const MaskSums sums(view.mask, box_);
  for (int v = 0; v < up_; ++v) {
    for (int u = 0; u < across_; ++u) {
      const PixelRange x = columns(u);
      const PixelRange y = rows(v);
      const double shown =
          sums.at(x.end, y.end) - sums.at(x.begin, y.end) - sums.at(x.end, y.begin) + sums.at(x.begin, y.begin);
      shows_[index(u, v)] = shown >= 0.5 * (x.end - x.begin) * (y.end - y.begin) ? 1 : 0;
    }
  }
}

ProjectedView::PixelRange ProjectedView::columns(int across) const {
  const int n = axes_.runs_back ? across_ - 1 - across : across;
  const double scale = static_cast<double>(box_.width) / across_;
  return {n * scale, (n + 1) * scale};
}

ProjectedView::PixelRange ProjectedView::rows(int up) const {
  const double scale = static_cast<double>(box_.height) / up_;
  return {(up_ - 1 - up) * scale, (up_ - up) * scale};
}

std::optional<glm::dvec3> ProjectedView::colour(int across, int up) const {
  const PixelRange x = columns(across);
  const PixelRange y = rows(up);
  glm::dvec3 sum(0);
  double weight = 0;
  for (int j = static_cast<int>(y.begin); j < box_.height && j < y.end; ++j) {
    for (int i = static_cast<int>(x.begin); i < box_.width && i < x.end; ++i) {
      const std::size_t at = static_cast<std::size_t>(box_.y + j) * static_cast<std::size_t>(view_.mask.width) +
                             static_cast<std::size_t>(box_.x + i);
      if (view_.mask.shows[at] == 0) continue;
      const double share = pixel_share(i, x.begin, x.end) * pixel_share(j, y.begin, y.end);
      const vpe::base::Rgb& p = view_.image.pixels[at];
      sum += share * glm::dvec3(p.r, p.g, p.b);
      weight += share;
    }
  }
  if (!(weight > 0)) return std::nullopt;
  return sum / weight;
}

}  // namespace objects
