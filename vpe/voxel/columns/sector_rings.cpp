#include "vpe/voxel/columns/sector_rings.h"

#include <algorithm>
#include <array>
#include <limits>

namespace vpe::voxel {

namespace {

constexpr int kCells = 16;
// What a line costs beside its samples, in samples.
constexpr double kLineCost = 60;
// A ring more must leave this share of the cost at most.
constexpr double kWorthwhile = 0.95;

}  // namespace

std::vector<int> ring_ends(std::span<const RingRow> rows, int most_rings) {
  const int count = static_cast<int>(rows.size());
  const auto begin_of = [&](int cell) { return cell * count / kCells; };
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  // Holds neighbouring rows.
  struct Some {
    double farthest_px = 0;
    double low = kInfinity;
    double high = -kInfinity;
    double samples = 0;  // for each pixel that the first row of their ring is away from V
  };
  std::array<Some, kCells> cells;
  for (int cell = 0; cell < kCells; ++cell) {
    Some& some = cells[static_cast<std::size_t>(cell)];
    for (int k = begin_of(cell); k < begin_of(cell + 1); ++k) {
      const RingRow& row = rows[static_cast<std::size_t>(k)];
      if (row.low > row.high) continue;
      some.farthest_px = std::max(some.farthest_px, row.distance_px);
      some.low = std::min(some.low, row.low);
      some.high = std::max(some.high, row.high);
      some.samples += row.high - row.low;
    }
  }
  const auto cost_of = [&](int begin, int end) {
    Some ring;
    for (int cell = begin; cell < end; ++cell) {
      const Some& some = cells[static_cast<std::size_t>(cell)];
      ring.farthest_px = std::max(ring.farthest_px, some.farthest_px);
      ring.low = std::min(ring.low, some.low);
      ring.high = std::max(ring.high, some.high);
      ring.samples += some.samples;
    }
    if (ring.low > ring.high) return 0.0;
    return ring.farthest_px * (ring.samples + kLineCost * (ring.high - ring.low));
  };
  // best[cell]: the least cost of the cells before it, by rings used so far.
  struct Choice {
    double cost = kInfinity;
    int begin = 0;  // of the last ring
  };
  std::vector<std::array<Choice, kCells + 1>> best(static_cast<std::size_t>(most_rings) + 1);
  best[0][0].cost = 0;
  std::size_t chosen = 1;
  for (std::size_t rings = 1; rings < best.size(); ++rings) {
    for (int end = 1; end <= kCells; ++end) {
      Choice& choice = best[rings][static_cast<std::size_t>(end)];
      for (int begin = 0; begin < end; ++begin) {
        const double cost = best[rings - 1][static_cast<std::size_t>(begin)].cost + cost_of(begin, end);
        if (cost < choice.cost) choice = {cost, begin};
      }
    }
    if (best[rings][kCells].cost < kWorthwhile * best[chosen][kCells].cost) chosen = rings;
  }
  std::vector<int> ends;
  for (int end = kCells; chosen > 0; --chosen) {
    ends.push_back(begin_of(end));
    end = best[chosen][static_cast<std::size_t>(end)].begin;
  }
  std::ranges::reverse(ends);
  // With fewer rows than cells some rings have none.
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  if (ends.size() > 1 && ends.front() == 0) ends.erase(ends.begin());
  return ends;
}

}  // namespace vpe::voxel
