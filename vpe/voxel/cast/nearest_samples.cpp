#include "vpe/voxel/cast/nearest_samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "vpe/voxel/columns/refine.h"

namespace vpe::voxel {

namespace {

// Handles pixels without any sample near them.
void miss(int begin, int end, float* out, std::vector<int>* missed) {
  if (missed == nullptr) std::fill(out + begin, out + end, std::numeric_limits<float>::infinity());
  for (int x = begin; missed != nullptr && x < end; ++x) missed->push_back(x);
}

}  // namespace

NearestSamples::NearestSamples(const SectorPlan& plan, const SectorSamples& samples,
                               const core::SubRectangle& part, int rays)
    : plan_(plan), samples_(samples), part_(part), rays_(rays) {}

SectorPlan::Side NearestSamples::side(int x, int pixel_row) const {
  return plan_.side_of(x_of(x), rays_ * (part_.y + pixel_row + 0.5));
}

const float* NearestSamples::samples_of(const ViewSector& sector) const {
  return samples_[static_cast<std::size_t>(&sector - plan_.sectors().data())].data();
}

void NearestSamples::get(int pixel_row, int begin, int end, float* out, std::vector<int>* missed) const {
  SectorPlan::Span span = upright_pixels(pixel_row);
  span.begin = std::clamp(span.begin, begin, end);
  span.end = std::clamp(span.end, span.begin, end);
  for (int ray = 0; ray < rays_; ++ray, out += part_.width) {
    const int row = rays_ * pixel_row + ray;
    beside(row, begin, span.begin, out, missed);
    upright(row, span.begin, span.end, out, missed);
    beside(row, span.end, end, out, missed);
  }
}

SectorPlan::Span NearestSamples::upright_pixels(int pixel_row) const {
  // Those of the ray at or below the centre are at most a pixel off.
  const SectorPlan::Span near =
      plan_.upright_span(std::min(rays_ * pixel_row + rays_ / 2, rays_ * part_.height - 1));
  if (rays_ == 1) return near;
  const auto is_before = [&](int x) {
    const SectorPlan::Side at = side(x, pixel_row);
    return !at.upright && !at.forward;
  };
  SectorPlan::Span span{std::clamp(near.begin / rays_, 0, part_.width), 0};
  while (span.begin > 0 && !is_before(span.begin - 1)) --span.begin;
  while (span.begin < part_.width && is_before(span.begin)) ++span.begin;
  span.end = std::clamp(near.end / rays_, span.begin, part_.width);
  while (span.end > span.begin && !side(span.end - 1, pixel_row).upright) --span.end;
  while (span.end < part_.width && side(span.end, pixel_row).upright) ++span.end;
  return span;
}

void NearestSamples::upright(int row, int begin, int end, float* out, std::vector<int>* missed) const {
  if (begin >= end) return;
  const ViewSector* sector = plan_.sector_of(side(begin, row / rays_));
  if (sector == nullptr) return miss(begin, end, out, missed);
  const int wanted = rays_ * part_.y + row - sector->first_step;
  const int step = std::clamp(wanted, 0, sector->steps - 1);
  if (step != wanted && missed != nullptr) return miss(begin, end, out, missed);
  const ViewSector::Map& map = sector->maps[static_cast<std::size_t>(step)];
  const double first = (map.scale * x_of(0) + map.shift - sector->first_line) / sector->spacing + 0.5;
  const double rate = map.scale * rays_ / sector->spacing;
  const float* const from = samples_of(*sector) + std::ptrdiff_t{step} * sector->lines;
  const double last = sector->lines - 1;
  const double left = first + rate * begin;
  const double right = first + rate * (end - 1);
  if (std::min(left, right) >= 0 && std::max(left, right) < last + 1) {
    for (int x = begin; x < end; ++x) out[x] = from[static_cast<int>(first + rate * x)];
  } else {
    for (int x = begin; x < end; ++x) out[x] = from[static_cast<int>(std::clamp(first + rate * x, 0.0, last))];
  }
}

void NearestSamples::beside(int row, int begin, int end, float* out, std::vector<int>* missed) const {
  while (begin < end) {
    const SectorPlan::Side at = side(begin, row / rays_);
    const int count = plan_.steps_alike(at, rays_ * (part_.x + begin), end - begin);
    beside(plan_.sector_of(at), row, begin, begin + count, out, missed);
    begin += count;
  }
}

void NearestSamples::beside(const ViewSector* sector, int row, int begin, int end, float* out,
                            std::vector<int>* missed) const {
  if (sector == nullptr) return miss(begin, end, out, missed);
  const float* const from = samples_of(*sector);
  const double y = rays_ * part_.y + row + 0.5;
  const double per_spacing = 1.0 / sector->spacing;
  const int first = rays_ * part_.x + rays_ / 2 - sector->first_step;
  if (rays_ == 1 && missed != nullptr) {
    const int inner = std::clamp(-first, begin, end);
    const int inner_end = std::clamp(sector->steps - first, inner, end);
    miss(begin, inner, out, missed);
    miss(inner_end, end, out, missed);
    if (inner == inner_end) return;
    static_assert(sizeof(ViewSector::Map) == 2 * sizeof(double));
    constexpr int kMost = 128;
    std::array<std::int32_t, kMost> index;
    for (int x = inner; x < inner_end; x += kMost) {
      const int count = std::min(kMost, inner_end - x);
      nearest_in_columns(sector->lines, &sector->maps[static_cast<std::size_t>(first + x)].scale, y,
                         sector->first_line, per_spacing, count, index.data());
      const float* const some = from + std::ptrdiff_t{first + x} * sector->lines;
      for (int k = 0; k < count; ++k) out[x + k] = some[index[static_cast<std::size_t>(k)]];
    }
    return;
  }
  const double last = sector->lines - 1;
  for (int x = begin; x < end; ++x) {
    const int wanted = first + rays_ * x;
    const int step = std::clamp(wanted, 0, sector->steps - 1);
    if (step != wanted && missed != nullptr) {
      missed->push_back(x);
      continue;
    }
    const ViewSector::Map& map = sector->maps[static_cast<std::size_t>(step)];
    const double line = (map.scale * y + map.shift - sector->first_line) * per_spacing + 0.5;
    out[x] = from[std::ptrdiff_t{step} * sector->lines + static_cast<int>(std::clamp(line, 0.0, last))];
  }
}

}  // namespace vpe::voxel
