#include "vpe/explore/measure/map_coverage.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace vpe::explore {
namespace {

// Returns the range of pixels of a row or column whose centres are within [low, high].
int first_pixel(double low) { return static_cast<int>(std::ceil(std::clamp(low - 0.5, -1e8, 1e8))); }
int last_pixel(double high) { return static_cast<int>(std::floor(std::clamp(high - 0.5, -1e8, 1e8))); }

}  // namespace

MapCoverage::MapCoverage(int width, int height)
    : width_(width),
      height_(height),
      share_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0.0F) {}

float& MapCoverage::pixel(int x, int y) {
  const std::size_t index =
      static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  if (share_[index] == 0) touched_.push_back(index);
  return share_[index];
}

double MapCoverage::at(int x, int y) const {
  const std::size_t index =
      static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  return std::min(1.0, static_cast<double>(share_[index]));
}

// Adds a part of one of the kRows lines of a row.
void MapCoverage::add_span(int y, double from, double to) {
  from = std::max(from, 0.0);
  to = std::min(to, static_cast<double>(width_));
  if (!(from < to)) return;
  const int last = std::min(width_ - 1, static_cast<int>(to));
  for (int x = static_cast<int>(from); x <= last; ++x) {
    const double share = std::min(to, x + 1.0) - std::max(from, static_cast<double>(x));
    if (share > 0) pixel(x, y) += static_cast<float>(share / kRows);
  }
}

void MapCoverage::add_area(std::span<const std::vector<glm::dvec2>> rings) {
  double low = height_;
  double high = 0;
  for (const auto& ring : rings) {
    for (const glm::dvec2& vertex : ring) {
      low = std::min(low, vertex.y);
      high = std::max(high, vertex.y);
    }
  }
  if (!(low < high)) return;
  const int first = std::max(0, static_cast<int>(std::floor(std::max(low, 0.0) * kRows)));
  const int last = static_cast<int>(std::ceil(std::min(high, static_cast<double>(height_)) * kRows));
  const auto count = static_cast<std::size_t>(std::max(0, last - first));
  if (count == 0) return;
  // The crossings of all lines, sorted by line and then by place.
  std::vector<std::vector<double>> lines(count);
  for (const auto& ring : rings) {
    for (std::size_t n = 1; n < ring.size(); ++n) {
      const glm::dvec2 a = ring[n - 1].y < ring[n].y ? ring[n - 1] : ring[n];
      const glm::dvec2 b = ring[n - 1].y < ring[n].y ? ring[n] : ring[n - 1];
      if (!(b.y > a.y) || b.y * kRows < first || a.y * kRows > last) continue;
      // A line at y crosses edges with a.y <= y < b.y.
      const double from = std::max(std::ceil(a.y * kRows - 0.5), static_cast<double>(first));
      for (double row = from; row < last && (row + 0.5) / kRows < b.y; ++row) {
        const double y = (row + 0.5) / kRows;
        lines[static_cast<std::size_t>(row) - static_cast<std::size_t>(first)].push_back(
            a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y));
      }
    }
  }
  for (std::size_t n = 0; n < count; ++n) {
    std::vector<double>& at = lines[n];
    std::sort(at.begin(), at.end());
    const int y = (first + static_cast<int>(n)) / kRows;
    if (y >= height_) break;
    for (std::size_t k = 1; k < at.size(); k += 2) add_span(y, at[k - 1], at[k]);
  }
}

void MapCoverage::add_line(glm::dvec2 from, glm::dvec2 to, double width_px) {
  const double reach = width_px / 2 + 0.5;
  const glm::dvec2 along = to - from;
  const double length2 = glm::dot(along, along);
  const int y0 = std::max(0, first_pixel(std::min(from.y, to.y) - reach));
  const int y1 = std::min(height_ - 1, last_pixel(std::max(from.y, to.y) + reach));
  for (int y = y0; y <= y1; ++y) {
    // The part of the line whose distance from this row is within reach.
    double begin = 0;
    double end = 1;
    const double cy = y + 0.5;
    if (along.y != 0) {
      const double a = (cy - reach - from.y) / along.y;
      const double b = (cy + reach - from.y) / along.y;
      begin = std::clamp(std::min(a, b), 0.0, 1.0);
      end = std::clamp(std::max(a, b), 0.0, 1.0);
    }
    const double xa = from.x + begin * along.x;
    const double xb = from.x + end * along.x;
    const int x0 = std::max(0, first_pixel(std::min(xa, xb) - reach));
    const int x1 = std::min(width_ - 1, last_pixel(std::max(xa, xb) + reach));
    for (int x = x0; x <= x1; ++x) {
      const glm::dvec2 centre{x + 0.5, cy};
      const double share = length2 > 0 ? std::clamp(glm::dot(centre - from, along) / length2, 0.0, 1.0) : 0.0;
      const double covered =
          std::min(reach - glm::length(centre - from - share * along), std::min(1.0, width_px));
      if (covered <= 0) continue;
      float& kept = pixel(x, y);
      kept = std::max(kept, static_cast<float>(covered));
    }
  }
}

void MapCoverage::paint(base::Rgb colour, double opacity, core::RgbImage& image) {
  for (const std::size_t index : touched_) {
    const double share = std::min(1.0, static_cast<double>(share_[index])) * opacity;
    share_[index] = 0;
    base::Rgb& pixel = image.pixels[index];
    const auto mix = [share](std::uint8_t below, std::uint8_t above) {
      return static_cast<std::uint8_t>(std::lround(below + (above - below) * share));
    };
    pixel = {mix(pixel.r, colour.r), mix(pixel.g, colour.g), mix(pixel.b, colour.b)};
  }
  touched_.clear();
}

}  // namespace vpe::explore
