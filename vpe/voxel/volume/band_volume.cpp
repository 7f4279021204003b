#include "vpe/voxel/volume/band_volume.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace vpe::voxel {

void BandColumns::add(int first, const std::vector<std::uint8_t>& densities) {
  const auto begin = std::find_if(densities.begin(), densities.end(), [](std::uint8_t d) { return d != 255; });
  const auto end = std::find_if(densities.rbegin(), std::make_reverse_iterator(begin), [](std::uint8_t d) {
                     return d != 0;
                   }).base();
  first_.push_back(static_cast<std::int16_t>(first + (begin - densities.begin())));
  densities_.insert(densities_.end(), begin, end);
  begin_.push_back(static_cast<std::uint32_t>(densities_.size()));
}

BandVolume::BandVolume(int columns, int rows, std::uint8_t threshold, BandColumns voxels)
    : columns_(columns), rows_(rows), threshold_(threshold), voxels_(std::move(voxels)) {
  const auto is_side = [](int n) { return n >= 2 && n <= kMostVolumeSide; };
  if (!is_side(columns) || !is_side(rows))
    throw std::invalid_argument("a band of voxels: expected 2 to " + std::to_string(kMostVolumeSide) +
                                " columns and rows");
  if (voxels_.size() != static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows))
    throw std::invalid_argument("a band of voxels: the columns must fill the grid");
  std::vector<std::int16_t> high;
  spans_.reserve(static_cast<std::size_t>(columns - 1) * static_cast<std::size_t>(rows - 1));
  high.reserve(spans_.capacity());
  for (int j = 0; j + 1 < rows; ++j) {
    for (int i = 0; i + 1 < columns; ++i) {
      spans_.push_back(make_span(i, j));
      high.push_back(spans_.back().high);
    }
  }
  maxima_.emplace(columns - 1, rows - 1, high);
}

BandVolume::Span BandVolume::make_span(int i, int j) const {
  const std::size_t corner[4] = {place(i, j), place(i + 1, j), place(i, j + 1), place(i + 1, j + 1)};
  int from = voxels_.first_[corner[0]];
  int to = end(corner[0]);
  for (const std::size_t column : corner) {
    from = std::min(from, static_cast<int>(voxels_.first_[column]));
    to = std::max(to, end(column));
  }
  // All four columns are ground at level from - 1, and air at level `to`.
  int low = to;
  int high = from - 1;
  int below = 4;
  for (int k = from; k <= to; ++k) {
    int here = 0;
    for (const std::size_t column : corner) here += at(column, k) > threshold_ ? 1 : 0;
    if (below + here != 0 && below + here != 8) {
      low = std::min(low, k - 1);
      high = std::max(high, k - 1);
    }
    below = here;
  }
  return {static_cast<std::int16_t>(low), static_cast<std::int16_t>(high)};
}

double BandVolume::density(const glm::dvec3& p) const {
  const int i = std::clamp(static_cast<int>(p.x), 0, columns_ - 2);
  const int j = std::clamp(static_cast<int>(p.y), 0, rows_ - 2);
  const int k = static_cast<int>(std::floor(p.z));
  const double x = std::clamp(p.x - i, 0.0, 1.0);
  const double y = std::clamp(p.y - j, 0.0, 1.0);
  const double z = p.z - k;
  const auto along_z = [&](std::size_t column) {
    const double low = at(column, k);
    return low + z * (at(column, k + 1) - low);
  };
  const std::size_t first = place(i, j);
  const std::size_t above = first + static_cast<std::size_t>(columns_);
  const double south = along_z(first) * (1 - x) + along_z(first + 1) * x;
  const double north = along_z(above) * (1 - x) + along_z(above + 1) * x;
  return south * (1 - y) + north * y;
}

BandVolume::Crossings BandVolume::crossings(int i, int j) const {
  const std::size_t column = place(i, j);
  const int from = voxels_.first_[column];
  const int to = end(column);
  Crossings found;
  bool is_first = true;
  for (int k = from - 1; k < to; ++k) {
    const double below = at(column, k);
    const double above = at(column, k + 1);
    if ((below > threshold_) == (above > threshold_)) continue;
    found.high = k + (below - surface()) / (below - above);
    if (is_first) found.low = found.high;
    is_first = false;
  }
  return found;
}

std::size_t BandVolume::band_bytes() const {
  return voxels_.first_.capacity() * sizeof(std::int16_t) + voxels_.begin_.capacity() * sizeof(std::uint32_t) +
         voxels_.densities_.capacity();
}

std::size_t BandVolume::bytes() const {
  return sizeof(BandVolume) + band_bytes() + spans_.capacity() * sizeof(Span) + maxima_->bytes();
}

}  // namespace vpe::voxel
