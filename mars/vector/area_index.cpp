#include "mars/vector/area_index.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "mars/vector/ring_longitudes.h"

namespace mars {
namespace {

constexpr std::size_t kMostBins = 4096;
constexpr std::size_t kEdgesOfBin = 8;

}  // namespace

AreaIndex::AreaIndex(const Shape& shape) {
  low_ = high_ = shape.rings.at(0).at(0);
  std::size_t count = 0;
  for (const auto& ring : shape.rings) {
    for (const glm::dvec2& p : ring) {
      low_ = glm::min(low_, p);
      high_ = glm::max(high_, p);
    }
    count += ring.size();
    holds_north_ = holds_north_ != (pole_of(ring) == RingPole::north);
    if (pole_of(ring) == RingPole::north) high_.y = 90;
    if (pole_of(ring) == RingPole::south) low_.y = -90;
  }
  const std::size_t bins = std::clamp<std::size_t>(count / kEdgesOfBin, 1, kMostBins);
  first_.assign(bins + 1, 0);
  const auto each_edge = [&](const auto& visit) {
    for (const auto& ring : shape.rings) {
      for (std::size_t i = 1; i < ring.size(); ++i) {
        const std::size_t begin = bin_of(std::min(ring[i - 1].x, ring[i].x));
        const std::size_t end = bin_of(std::max(ring[i - 1].x, ring[i].x));
        for (std::size_t bin = begin; bin <= end; ++bin) visit(bin, Edge{ring[i - 1], ring[i]});
      }
    }
  };
  each_edge([&](std::size_t bin, const Edge&) { ++first_[bin + 1]; });
  for (std::size_t bin = 0; bin < bins; ++bin) first_[bin + 1] += first_[bin];
  edges_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  each_edge([&](std::size_t bin, const Edge& edge) { edges_[next[bin]++] = edge; });
}

std::size_t AreaIndex::bin_of(double lon_deg) const {
  const std::size_t bins = first_.size() - 1;
  const double share = high_.x > low_.x ? (lon_deg - low_.x) / (high_.x - low_.x) : 0.0;
  return std::min(bins - 1, static_cast<std::size_t>(std::max(0.0, share * static_cast<double>(bins))));
}

bool AreaIndex::contains(glm::dvec2 place_deg) const {
  if (place_deg.y < low_.y || place_deg.y > high_.y) return false;
  bool inside = holds_north_;
  // Rings that go around the planet several times are counted in each turn.
  const double lon = low_.x + (place_deg.x - low_.x) - 360 * std::floor((place_deg.x - low_.x) / 360);
  for (double x = lon; x <= high_.x; x += 360) {
    const std::size_t bin = bin_of(x);
    for (std::uint32_t k = first_[bin]; k < first_[bin + 1]; ++k) {
      const Edge& e = edges_[k];
      if ((e.from.x <= x) == (e.to.x <= x)) continue;
      const double lat = e.from.y + (e.to.y - e.from.y) * (x - e.from.x) / (e.to.x - e.from.x);
      if (lat > place_deg.y) inside = !inside;
    }
  }
  return inside;
}

}  // namespace mars
