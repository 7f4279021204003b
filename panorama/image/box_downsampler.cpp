#include "panorama/image/box_downsampler.h"

#include <algorithm>
#include <utility>

namespace panorama {

namespace {

// Counts lengths in parts: a pixel taken has `taken` parts, a pixel given has `given` of them, so that both
// rows have the same number of parts.
struct Parts {
  std::int64_t taken;
  std::int64_t given;
};
Parts parts_of(std::int64_t side_px) {
  if (side_px % 2 == 0) return {1, 2};
  return {half_px(side_px), side_px};
}

}  // namespace

BoxDownsampler::BoxDownsampler(std::int64_t width_px, std::int64_t height_px, std::function<void(Row)> give)
    : width_px_(width_px),
      height_px_(height_px),
      out_height_px_(half_px(height_px)),
      give_(std::move(give)),
      sums_(static_cast<std::size_t>(half_px(width_px)) * 3),
      across_(sums_.size()),
      out_(static_cast<std::size_t>(half_px(width_px))) {}

void BoxDownsampler::take(Row row) {
  const Parts parts = parts_of(width_px_);
  for (std::int64_t out = 0; out < width_px(); ++out) {
    const std::int64_t begin = out * parts.given;
    const std::int64_t end = begin + parts.given;
    std::uint64_t r = 0;
    std::uint64_t g = 0;
    std::uint64_t b = 0;
    for (std::int64_t in = begin / parts.taken; in * parts.taken < end; ++in) {
      const auto weight =
          static_cast<std::uint64_t>(std::min(end, (in + 1) * parts.taken) - std::max(begin, in * parts.taken));
      const vpe::base::Rgb& pixel = row[static_cast<std::size_t>(in)];
      r += weight * pixel.r;
      g += weight * pixel.g;
      b += weight * pixel.b;
    }
    std::uint64_t* sum = across_.data() + 3 * out;
    sum[0] = r;
    sum[1] = g;
    sum[2] = b;
  }
  const Parts down = parts_of(height_px_);
  std::int64_t at = row_ * down.taken;
  const std::int64_t end = at + down.taken;
  // A row may contribute to two rows of the output.
  while (at < end) {
    const std::int64_t until = std::min(end, (out_row_ + 1) * down.given);
    const auto weight = static_cast<std::uint64_t>(until - at);
    for (std::size_t n = 0; n < sums_.size(); ++n) sums_[n] += weight * across_[n];
    at = until;
    if (at == (out_row_ + 1) * down.given) give_row();
  }
  ++row_;
}

void BoxDownsampler::give_row() {
  const auto total = static_cast<std::uint64_t>(parts_of(width_px_).given) *
                     static_cast<std::uint64_t>(parts_of(height_px_).given);
  const auto mean = [total](std::uint64_t sum) { return static_cast<std::uint8_t>((sum + total / 2) / total); };
  for (std::size_t n = 0; n < out_.size(); ++n) {
    out_[n] = {mean(sums_[3 * n]), mean(sums_[3 * n + 1]), mean(sums_[3 * n + 2])};
  }
  std::fill(sums_.begin(), sums_.end(), 0);
  ++out_row_;
  give_(out_);
}

}  // namespace panorama
