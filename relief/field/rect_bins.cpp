#include "relief/field/rect_bins.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace relief {

namespace {

constexpr int kMostSide = 128;
constexpr int kMostBins = 64;  // of a rectangle, before it counts as a wide one

bool is_bounded(const Rect& rect) {
  return std::isfinite(rect.x0_m) && std::isfinite(rect.y0_m) && std::isfinite(rect.x1_m) &&
         std::isfinite(rect.y1_m);
}

// The bin of a place; beyond the bins the nearest one.
int bin_of(double place, double low, double high, int side) {
  const double at = (place - low) / (high - low) * side;
  return at > 0 ? static_cast<int>(std::min(at, side - 0.5)) : 0;
}

}  // namespace

RectBins::RectBins(std::vector<Rect> rects) : rects_(std::move(rects)) {
  bool is_first = true;
  for (std::size_t n = 0; n < rects_.size(); ++n) {
    all_.push_back(static_cast<std::uint32_t>(n));
    const Rect& r = rects_[n];
    if (!is_bounded(r)) continue;
    area_ = is_first ? r
                     : Rect{std::min(area_.x0_m, r.x0_m), std::min(area_.y0_m, r.y0_m),
                            std::max(area_.x1_m, r.x1_m), std::max(area_.y1_m, r.y1_m)};
    is_first = false;
  }
  side_ = std::clamp(static_cast<int>(std::sqrt(static_cast<double>(rects_.size()))), 1, kMostSide);
  bins_.resize(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_));
  for (const std::uint32_t n : all_) {
    const Span across = columns(rects_[n]);
    const Span down = rows(rects_[n]);
    if (!is_bounded(rects_[n]) || (across.last - across.first + 1) * (down.last - down.first + 1) > kMostBins) {
      wide_.push_back(n);
      continue;
    }
    for (int j = down.first; j <= down.last; ++j)
      for (int i = across.first; i <= across.last; ++i)
        bins_[static_cast<std::size_t>(j * side_ + i)].push_back(n);
  }
  // Wide ones belong to every bin, in order.
  for (std::vector<std::uint32_t>& bin : bins_) {
    if (wide_.size() > kMostBins) break;  // they would take too much room: gathered at each call
    const std::size_t count = bin.size();
    bin.insert(bin.end(), wide_.begin(), wide_.end());
    std::inplace_merge(bin.begin(), bin.begin() + static_cast<std::ptrdiff_t>(count), bin.end());
  }
}

RectBins::Span RectBins::columns(const Rect& rect) const {
  return {bin_of(rect.x0_m, area_.x0_m, area_.x1_m, side_), bin_of(rect.x1_m, area_.x0_m, area_.x1_m, side_)};
}

RectBins::Span RectBins::rows(const Rect& rect) const {
  return {bin_of(rect.y0_m, area_.y0_m, area_.y1_m, side_), bin_of(rect.y1_m, area_.y0_m, area_.y1_m, side_)};
}

const std::vector<std::uint32_t>& RectBins::candidates(const Rect& rect,
                                                       std::vector<std::uint32_t>& gathered) const {
  if (side_ <= 1) return all_;
  const Span across = columns(rect);
  const Span down = rows(rect);
  const int count = (across.last - across.first + 1) * (down.last - down.first + 1);
  if (count > kMostBins) return all_;
  const bool has_wide = wide_.size() <= kMostBins;
  if (count == 1 && has_wide) return bins_[static_cast<std::size_t>(down.first * side_ + across.first)];
  if (!has_wide) gathered = wide_;
  for (int j = down.first; j <= down.last; ++j) {
    for (int i = across.first; i <= across.last; ++i) {
      const std::vector<std::uint32_t>& bin = bins_[static_cast<std::size_t>(j * side_ + i)];
      gathered.insert(gathered.end(), bin.begin(), bin.end());
    }
  }
  std::sort(gathered.begin(), gathered.end());
  gathered.erase(std::unique(gathered.begin(), gathered.end()), gathered.end());
  return gathered;
}

}  // namespace relief
