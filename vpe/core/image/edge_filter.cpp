#include "vpe/core/image/edge_filter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <vector>

namespace vpe::core {

namespace {

constexpr int kRows = 16;  // of an item of work
// Between an image's border and pixels whose filter reads nothing beyond it.
constexpr int kReach = 6;

// Four numbers that the compiler keeps in a register: red, green, blue and one without meaning.
using Four = float __attribute__((vector_size(16)));
using FourInts = std::int32_t __attribute__((vector_size(16)));

// Reads pixels. Unless kInside, places beyond the border have the colours there.
template <bool kInside>
struct ColourPixels {
  const base::Rgb* pixels;
  int width;
  int height;

  const base::Rgb& pixel(int x, int y) const {
    if constexpr (!kInside) {
      x = std::clamp(x, 0, width - 1);
      y = std::clamp(y, 0, height - 1);
    }
    return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  }
  Four at(int x, int y) const {
    const base::Rgb& p = pixel(x, y);
    return __builtin_convertvector((FourInts{p.r, p.g, p.b, 0}), Four);
  }
  // Returns a bilinear mean; pixel centres are at whole numbers.
  Four between(float px, float py) const {
    const int x = floor(px);
    const int y = floor(py);
    const float tx = px - static_cast<float>(x);
    const float ty = py - static_cast<float>(y);
    return (at(x, y) * (1 - tx) + at(x + 1, y) * tx) * (1 - ty) +
           (at(x, y + 1) * (1 - tx) + at(x + 1, y + 1) * tx) * ty;
  }

 private:
  static int floor(float value) {
    const int whole = static_cast<int>(value);
    return static_cast<float>(whole) > value ? whole - 1 : whole;
  }
};

// Returns the brightness of four pixels with this sum.
float luma(const Four& sum) {
  const Four parts = sum * Four{0.30F, 0.59F, 0.11F, 0};
  return 0.25F * (parts[0] + parts[1] + parts[2]);
}

std::uint8_t byte(float value) {
  const float inside = std::clamp(value, 0.0F, 255.0F);
  const int whole = static_cast<int>(inside);
  return static_cast<std::uint8_t>(inside - static_cast<float>(whole) >= 0.5F ? whole + 1 : whole);
}

template <bool kInside>
base::Rgb smoothed(const ColourPixels<kInside>& image, int x, int y) {
  const Four own = image.at(x, y);
  // Sums of whole numbers are exact in any order.
  std::array<Four, 3> upper, lower;
  for (int n = 0; n < 3; ++n) {
    const Four middle = n == 1 ? own : image.at(x - 1 + n, y);
    upper[static_cast<std::size_t>(n)] = image.at(x - 1 + n, y - 1) + middle;
    lower[static_cast<std::size_t>(n)] = image.at(x - 1 + n, y + 1) + middle;
  }
  const float upper_left = luma(upper[0] + upper[1]);
  const float upper_right = luma(upper[1] + upper[2]);
  const float lower_left = luma(lower[0] + lower[1]);
  const float lower_right = luma(lower[1] + lower[2]);
  // At right angles to the gradient of brightness.
  float along_x = upper_left + upper_right - lower_left - lower_right;
  float along_y = -(upper_left + lower_left - upper_right - lower_right);
  if (!(along_x * along_x + along_y * along_y >= 0.06F)) return image.pixel(x, y);
  const float larger = std::max(std::abs(along_x), std::abs(along_y));
  along_x /= larger;
  along_y /= larger;
  // The flatter the edge, the longer its steps.
  const float longer = std::max(std::min(std::abs(along_x), std::abs(along_y)), 0.2F);
  along_x /= longer;
  along_y /= longer;
  const auto here_x = static_cast<float>(x);
  const auto here_y = static_cast<float>(y);
  const auto beside = [&](float share) {
    return image.between(here_x + share * along_x, here_y + share * along_y);
  };
  const Four sum = beside(-0.25F) + beside(0.25F) + beside(-0.75F) + beside(0.75F);
  const Four mixed = own * 0.25F + sum * (0.75F / 4);
  return {byte(mixed[0]), byte(mixed[1]), byte(mixed[2])};
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

void smooth_edges(std::span<base::Rgb> colour, std::span<const float> inverse_depth, int width, int height,
                  base::ThreadPool& pool) {
  const auto columns = static_cast<std::size_t>(std::max(width, 0));
  const std::size_t pixels = columns * static_cast<std::size_t>(std::max(height, 0));
  if (colour.size() != pixels || inverse_depth.size() != pixels) {
    throw std::invalid_argument("smooth_edges: the image and its depth are not of the stated size");
  }
  const std::vector<base::Rgb> before(colour.begin(), colour.end());
  const ColourPixels<true> inside{before.data(), width, height};
  const ColourPixels<false> border{before.data(), width, height};
  pool.run(static_cast<std::size_t>((height + kRows - 1) / kRows), [&](std::size_t item) {
    constexpr std::size_t kWord = sizeof(std::uint64_t);
    // Padded, so that whole words of it can be looked through.
    std::vector<std::uint8_t> edge(columns + kWord);
    const int first = static_cast<int>(item) * kRows;
    const auto row = [&](int y) {
      return &inverse_depth[static_cast<std::size_t>(std::clamp(y, 0, height - 1)) * columns];
    };
    for (int y = first; y < std::min(height, first + kRows); ++y) {
      find_edges(row(y - 1), row(y), row(y + 1), width, edge.data());
      base::Rgb* const out = &colour[static_cast<std::size_t>(y) * columns];
      const bool is_inside = y >= kReach && y < height - kReach;
      for (int begin = 0; begin < width; begin += static_cast<int>(kWord)) {
        std::uint64_t word = 0;
        std::memcpy(&word, &edge[static_cast<std::size_t>(begin)], kWord);
        if (word == 0) continue;
        for (int x = begin; x < std::min(begin + static_cast<int>(kWord), width); ++x) {
          if (edge[static_cast<std::size_t>(x)] == 0) continue;
          out[x] =
              is_inside && x >= kReach && x < width - kReach ? smoothed(inside, x, y) : smoothed(border, x, y);
        }
      }
    }
  });
}

}  // namespace vpe::core
