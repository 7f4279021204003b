#include "lod/mesh/greedy_lines.h"

#include <bit>
#include <cmath>
#include <numeric>

namespace lod {

namespace {

constexpr int kKnotLevel = std::countr_zero(static_cast<unsigned>(mars::kWarpKnots));
constexpr int kKnotBits = 20;  // knots are multiples of 2^-20

std::vector<std::int64_t> scaled_lines(std::int64_t first, int intervals, int grid_level) {
  const int bits = kKnotBits + std::max(0, grid_level - kKnotLevel);
  const auto line = [&](std::int64_t k) {
    return static_cast<std::int64_t>(std::ldexp(mars::face_line(first + k, grid_level), bits));
  };
  std::vector<std::int64_t> lines(static_cast<std::size_t>(intervals) + 1);
  for (std::size_t k = 0; k < lines.size(); ++k) lines[k] = line(static_cast<std::int64_t>(k)) - line(0);
  return lines;
}

}  // namespace

EvenLines::EvenLines(int intervals) : index_(static_cast<std::size_t>(intervals) + 1) {
  std::iota(index_.begin(), index_.end(), 0);
}

WarpedLines::WarpedLines(const TileKey& key, int intervals) {
  const int grid_level = key.level + std::countr_zero(static_cast<unsigned>(intervals));
  x_ = scaled_lines(static_cast<std::int64_t>(key.i) * intervals, intervals, grid_level);
  y_ = scaled_lines(static_cast<std::int64_t>(key.j) * intervals, intervals, grid_level);

  std::int64_t narrowest = x_.back();
  for (std::size_t k = 1; k < x_.size(); ++k) narrowest = std::min(narrowest, x_[k] - x_[k - 1]);
  buckets_per_unit_ = 1.0 / static_cast<double>(narrowest);
  first_in_bucket_.resize(static_cast<std::size_t>(x_.back() / narrowest) + 1);
  std::size_t k = 0;
  for (std::size_t b = 0; b < first_in_bucket_.size(); ++b) {
    while (x_[k] < static_cast<std::int64_t>(b) * narrowest) ++k;
    first_in_bucket_[b] = static_cast<int>(k);
  }
}

}  // namespace lod
