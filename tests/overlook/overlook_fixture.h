// Panoramas by formula, in tiles, with a full pyramid of means.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "panorama/image/tiled_image.h"
#include "panorama/projection.h"

namespace overlook_test {

using Formula = std::function<vpe::base::Rgb(std::int64_t x, std::int64_t y)>;

// An image whose levels are means of 2 x 2 pixels, in square tiles.
class FormulaSource : public panorama::TileSource {
 public:
  FormulaSource(std::int64_t width_px, std::int64_t height_px, int tile_px, const Formula& formula);
  const std::vector<panorama::ImageLevel>& levels() const override { return levels_; }
  std::shared_ptr<const panorama::Tile> read(int level, std::int64_t column, std::int64_t row) const override;

 private:
  std::vector<panorama::ImageLevel> levels_;
  std::vector<std::vector<vpe::base::Rgb>> pixels_;
};

inline FormulaSource::FormulaSource(std::int64_t width_px, std::int64_t height_px, int tile_px,
                                    const Formula& formula) {
  levels_.push_back({width_px, height_px, tile_px, tile_px});
  pixels_.emplace_back();
  for (std::int64_t y = 0; y < height_px; ++y) {
    for (std::int64_t x = 0; x < width_px; ++x) pixels_.back().push_back(formula(x, y));
  }
  while (levels_.back().width_px > tile_px || levels_.back().height_px > tile_px) {
    const panorama::ImageLevel fine = levels_.back();
    const panorama::ImageLevel coarse{(fine.width_px + 1) / 2, (fine.height_px + 1) / 2, tile_px, tile_px};
    std::vector<vpe::base::Rgb> means;
    for (std::int64_t y = 0; y < coarse.height_px; ++y) {
      for (std::int64_t x = 0; x < coarse.width_px; ++x) {
        int sum[3] = {0, 0, 0};
        for (int n = 0; n < 4; ++n) {
          const std::int64_t fx = std::min(2 * x + n % 2, fine.width_px - 1);
          const std::int64_t fy = std::min(2 * y + n / 2, fine.height_px - 1);
          const vpe::base::Rgb& p = pixels_.back()[static_cast<std::size_t>(fy * fine.width_px + fx)];
          sum[0] += p.r;
          sum[1] += p.g;
          sum[2] += p.b;
        }
        const auto mean = [](int of_four) { return static_cast<std::uint8_t>((of_four + 2) / 4); };
        means.push_back({mean(sum[0]), mean(sum[1]), mean(sum[2])});
      }
    }
    levels_.push_back(coarse);
    pixels_.push_back(std::move(means));
  }
}

inline std::shared_ptr<const panorama::Tile> FormulaSource::read(int level, std::int64_t column,
                                                                 std::int64_t row) const {
  const panorama::ImageLevel& size = levels_[static_cast<std::size_t>(level)];
  auto tile = std::make_shared<panorama::Tile>();
  tile->width_px = size.tile_width_px;
  tile->height_px = size.tile_height_px;
  for (std::int64_t y = row * size.tile_height_px; y < (row + 1) * size.tile_height_px; ++y) {
    for (std::int64_t x = column * size.tile_width_px; x < (column + 1) * size.tile_width_px; ++x) {
      const bool is_inside = x < size.width_px && y < size.height_px;
      // Beyond the edge nothing may be looked at: bright red.
      tile->pixels.push_back(
          is_inside ? pixels_[static_cast<std::size_t>(level)][static_cast<std::size_t>(y * size.width_px + x)]
                    : vpe::base::Rgb{255, 0, 0});
    }
  }
  return tile;
}

inline panorama::TiledImage image_of(const panorama::PanoramaMap& map, const Formula& formula,
                                     int tile_px = 128) {
  return {std::make_unique<FormulaSource>(map.width_px, map.height_px, tile_px, formula),
          std::size_t{64} << 20};
}

// Ground with detail at many scales, as a photograph has, closed at 360 degrees.
inline Formula rough(std::int64_t turn_px) {
  return [turn_px](std::int64_t x, std::int64_t y) {
    const double a = 2 * 3.14159265358979323846 * static_cast<double>(x) / static_cast<double>(turn_px);
    const auto v = static_cast<double>(y);
    double sum = 0;
    for (int n = 1; n <= 6; ++n)
      sum += std::sin(n * n * 7 * a + 0.13 * n * v) * std::cos(0.021 * n * n * v + n) / n;
    const double value = 128 + 50 * sum;
    const auto byte = [](double b) { return static_cast<std::uint8_t>(std::clamp(b, 0.0, 255.0)); };
    return vpe::base::Rgb{byte(value), byte(0.8 * value + 20), byte(255 - value)};
  };
}

inline const std::vector<panorama::PanoramaMap>& maps() {
  static const std::vector<panorama::PanoramaMap> kMaps{
      panorama::cylinder_map(3000, 1100, 3000, 100.0, 500.0),
      panorama::equirectangular_map(2400, 1200, 2400, -30.0, 600.0),
      panorama::faceted_map(8, 375, 1000, 10.0, 480.0),
      panorama::faceted_map(3, 900, 1100, 10.0, 560.0),
      // A part of a circle.
      panorama::equirectangular_map(1500, 700, 4000, 20.0, 300.0),
      // Levels whose halves are not whole.
      panorama::cylinder_map(2777, 931, 2777, -71.0, 401.5),
  };
  return kMaps;
}

}  // namespace overlook_test
