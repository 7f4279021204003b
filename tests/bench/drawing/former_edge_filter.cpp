#include "tests/bench/drawing/former_edge_filter.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "vpe/core/image/edge_filter.h"

namespace bench {

namespace base = vpe::base;
using vpe::core::kEdgeBend;

namespace {

constexpr int kRows = 16;  // of an item of work

struct ColourPixels {
  std::span<const base::Rgb> pixels;
  int width;
  int height;

  glm::vec3 at(int x, int y) const {
    const auto row = static_cast<std::size_t>(std::clamp(y, 0, height - 1)) * static_cast<std::size_t>(width);
    const base::Rgb p = pixels[row + static_cast<std::size_t>(std::clamp(x, 0, width - 1))];
    return {p.r, p.g, p.b};
  }
  // Returns a bilinear mean; pixel centres are at whole numbers.
  glm::vec3 between(const glm::vec2& p) const {
    const glm::vec2 base = glm::floor(p);
    const glm::vec2 t = p - base;
    const int x = static_cast<int>(base.x);
    const int y = static_cast<int>(base.y);
    return (at(x, y) * (1 - t.x) + at(x + 1, y) * t.x) * (1 - t.y) +
           (at(x, y + 1) * (1 - t.x) + at(x + 1, y + 1) * t.x) * t.y;
  }
  // Returns the brightness of the four pixels about a corner.
  float luma(int x, int y) const {
    return 0.25F *
           glm::dot(at(x, y) + at(x + 1, y) + at(x, y + 1) + at(x + 1, y + 1), glm::vec3(0.30F, 0.59F, 0.11F));
  }
};

base::Rgb smoothed(const ColourPixels& image, int x, int y) {
  const float upper_left = image.luma(x - 1, y - 1);
  const float upper_right = image.luma(x, y - 1);
  const float lower_left = image.luma(x - 1, y);
  const float lower_right = image.luma(x, y);
  // At right angles to the gradient of brightness.
  glm::vec2 along(upper_left + upper_right - lower_left - lower_right,
                  -(upper_left + lower_left - upper_right - lower_right));
  const glm::vec3 own = image.at(x, y);
  glm::vec3 mixed = own;
  if (glm::dot(along, along) >= 0.06F) {
    along /= std::max(std::abs(along.x), std::abs(along.y));
    // The flatter the edge, the longer its steps.
    along /= std::max(std::min(std::abs(along.x), std::abs(along.y)), 0.2F);
    const glm::vec2 here(x, y);
    const glm::vec3 sum = image.between(here - 0.25F * along) + image.between(here + 0.25F * along) +
                          image.between(here - 0.75F * along) + image.between(here + 0.75F * along);
    mixed = own * 0.25F + sum * (0.75F / 4);
  }
  const auto byte = [](float v) { return static_cast<std::uint8_t>(std::lround(std::clamp(v, 0.0F, 255.0F))); };
  return {byte(mixed.x), byte(mixed.y), byte(mixed.z)};
}

// Sets `edge` to 1 where the surface bends between a pixel and its four neighbours. Has no branches, so that
// the compiler vectorizes it.
void find_edges(const float* above, const float* row, const float* below, int width, std::uint8_t* edge) {
  const auto bends = [&](int x, int west, int east) {
    const float c = row[x];
    const float bend = std::abs(row[west] + row[east] - 2 * c) + std::abs(above[x] + below[x] - 2 * c);
    const float largest = std::max(std::max(row[west], row[east]), std::max(above[x], below[x]));
    return static_cast<std::uint8_t>(bend > kEdgeBend * largest);
  };
  edge[0] = bends(0, 0, std::min(1, width - 1));
  for (int x = 1; x + 1 < width; ++x) edge[x] = bends(x, x - 1, x + 1);
  if (width > 1) edge[width - 1] = bends(width - 1, width - 2, width - 1);
}

}  // namespace

void smooth_edges_formerly(std::span<base::Rgb> colour, std::span<const float> inverse_depth, int width,
                           int height, base::ThreadPool& pool) {
  const auto columns = static_cast<std::size_t>(std::max(width, 0));
  const std::vector<base::Rgb> before(colour.begin(), colour.end());
  const ColourPixels image{before, width, height};
  pool.run(static_cast<std::size_t>((height + kRows - 1) / kRows), [&](std::size_t item) {
    std::vector<std::uint8_t> edge(columns);
    const int first = static_cast<int>(item) * kRows;
    const auto row = [&](int y) {
      return &inverse_depth[static_cast<std::size_t>(std::clamp(y, 0, height - 1)) * columns];
    };
    for (int y = first; y < std::min(height, first + kRows); ++y) {
      find_edges(row(y - 1), row(y), row(y + 1), width, edge.data());
      for (int x = 0; x < width; ++x) {
        const auto at = static_cast<std::size_t>(x);
        if (edge[at] != 0) colour[static_cast<std::size_t>(y) * columns + at] = smoothed(image, x, y);
      }
    }
  });
}

}  // namespace bench
