#include "panorama/page/page_pyramid.h"

#include <cmath>

#include "panorama/image/tile_source.h"
#include "tests/panorama/page/page_fixture.h"

namespace {

using panorama::PageImage;
using panorama::PagePyramid;
using panorama::PanoramaMap;

// An image in memory, with levels that are halved as often as wanted, in tiles of a size of their own.
class ImageTiles : public panorama::TileSource {
 public:
  ImageTiles(vpe::core::RgbImage image, int levels) {
    images_.push_back(std::move(image));
    for (int n = 1; n < levels; ++n) images_.push_back(half(images_.back()));
    for (const auto& level : images_) levels_.push_back({level.width, level.height, 64, 48});
  }
  const std::vector<panorama::ImageLevel>& levels() const override { return levels_; }
  std::shared_ptr<const panorama::Tile> read(int level, std::int64_t column, std::int64_t row) const override {
    const vpe::core::RgbImage& image = images_[static_cast<std::size_t>(level)];
    auto tile = std::make_shared<panorama::Tile>(panorama::Tile{64, 48, {}});
    for (std::int64_t y = row * 48; y < row * 48 + 48; ++y) {
      for (std::int64_t x = column * 64; x < column * 64 + 64; ++x) {
        const bool is_inside = x < image.width && y < image.height;
        tile->pixels.push_back(is_inside ? image.pixels[static_cast<std::size_t>(y * image.width + x)]
                                         : vpe::base::Rgb{255, 0, 255});
      }
    }
    return tile;
  }

 private:
  static vpe::core::RgbImage half(const vpe::core::RgbImage& image) {
    vpe::core::RgbImage out{image.width / 2, image.height / 2, {}};
    for (int y = 0; y < out.height; ++y) {
      for (int x = 0; x < out.width; ++x) {
        const auto at = [&](int i, int j) {
          return int{image.pixels[static_cast<std::size_t>((2 * y + j) * image.width + 2 * x + i)].r};
        };
        const int mean = (at(0, 0) + at(1, 0) + at(0, 1) + at(1, 1) + 2) / 4;
        out.pixels.push_back({static_cast<std::uint8_t>(mean), 0, 0});
      }
    }
    return out;
  }
  std::vector<vpe::core::RgbImage> images_;
  std::vector<panorama::ImageLevel> levels_;
};

// Smooth, without a step at the seam.
vpe::core::RgbImage wave(int width, int height) {
  vpe::core::RgbImage image{width, height, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double angle = 2.0 * 3.141592653589793 * (x + 0.5) / width;
      image.pixels.push_back(
          {static_cast<std::uint8_t>(std::lround(127.5 + 100.0 * std::sin(angle) + 20.0 * y / height)), 0, 0});
    }
  }
  return image;
}

panorama::TiledImage tiled(vpe::core::RgbImage image, int levels) {
  return {std::make_unique<ImageTiles>(std::move(image), levels), std::size_t{1} << 26};
}

TEST(PagePyramid, LevelsHalveUntilOneTileIsLeft) {
  for (const std::int64_t width : {1, 511, 512, 513, 6000, 60000, 1000000}) {
    const PagePyramid pyramid = panorama::pyramid_of(panorama::cylinder_map(width, 300, double(width), 0, 100));
    EXPECT_EQ(pyramid.columns(pyramid.levels - 1), 1);
    EXPECT_EQ(pyramid.rows(pyramid.levels - 1), 1);
    if (pyramid.levels > 1) {
      EXPECT_GT(pyramid.columns(pyramid.levels - 2), 1);
    }
    std::int64_t side = width;
    for (int level = 0; level < pyramid.levels; ++level) {
      EXPECT_EQ(pyramid.level_width_px(level), side) << level;
      side = (side + 1) / 2;
    }
  }
  const PagePyramid giant = panorama::pyramid_of(panorama::cylinder_map(60000, 17196, 60000, 0, 9000));
  EXPECT_EQ(giant.levels, 8);
  EXPECT_EQ(giant.columns(0) * giant.rows(0), 118 * 34);
}

TEST(PagePyramid, LevelZeroIsTheImage) {
  const auto image = tiled(page_test::pattern(700, 300), 1);
  const PageImage from{image, {}, panorama::cylinder_map(700, 300, 700, 0, 150)};
  const auto got = panorama::read_page_pixels(from, 0, {100, 50, 300, 200});
  for (int y = 0; y < 200; ++y) {
    for (int x = 0; x < 300; ++x)
      ASSERT_EQ(got.pixels[static_cast<std::size_t>(y * 300 + x)], page_test::colour_at(x + 100, y + 50));
  }
}

TEST(PagePyramid, BordersGoOnAtTheSeamAndRepeatAtEdges) {
  const auto image = tiled(page_test::pattern(700, 300), 1);
  PanoramaMap map = panorama::cylinder_map(700, 300, 700, 0, 150);
  const auto round = panorama::read_page_pixels({image, {}, map}, 0, {-1, -1, 702, 302});
  const auto at = [&](const vpe::core::RgbImage& from, int x, int y) {
    return from.pixels[static_cast<std::size_t>((y + 1) * from.width + x + 1)];
  };
  EXPECT_EQ(at(round, -1, 7), page_test::colour_at(699, 7));
  EXPECT_EQ(at(round, 700, 7), page_test::colour_at(0, 7));
  EXPECT_EQ(at(round, 5, -1), page_test::colour_at(5, 0));
  EXPECT_EQ(at(round, 5, 300), page_test::colour_at(5, 299));
  map.turn_px = 1400;
  const auto part = panorama::read_page_pixels({image, {}, map}, 0, {-1, -1, 702, 302});
  EXPECT_EQ(at(part, -1, 7), page_test::colour_at(0, 7));
  EXPECT_EQ(at(part, 700, 7), page_test::colour_at(699, 7));
}

// Means by brute force over the image, whatever levels the source has.
TEST(PagePyramid, PixelsAreMeansOfTheirAreas) {
  const int width = 1001;
  const int height = 403;
  const vpe::core::RgbImage image = wave(width, height);
  const PanoramaMap map = panorama::cylinder_map(width, height, width, 0, 200);
  for (const int levels : {1, 2, 4}) {
    const auto source = tiled(image, levels);
    for (const int level : {1, 2, 3}) {
      const std::int64_t side = std::int64_t{1} << level;
      const std::int64_t columns = (width + side - 1) / side;
      const std::int64_t rows = (height + side - 1) / side;
      const auto got = panorama::read_page_pixels({source, {}, map}, level, {-1, 0, columns + 2, rows});
      for (std::int64_t j = 0; j < rows; ++j) {
        for (std::int64_t i = -1; i < columns + 1; ++i) {
          double sum = 0;
          double count = 0;
          for (std::int64_t y = j * side; y < std::min<std::int64_t>((j + 1) * side, height); ++y) {
            for (std::int64_t x = i * side; x < (i + 1) * side; ++x) {
              sum += image.pixels[static_cast<std::size_t>(y * width + (x % width + width) % width)].r;
              ++count;
            }
          }
          // Copies of an odd width are a little wider than half, and are rounded themselves.
          ASSERT_NEAR(got.pixels[static_cast<std::size_t>(j * got.width + i + 1)].r, sum / count,
                      levels == 1 ? 0.51 : 1.6)
              << levels << " " << level << " " << i << "," << j;
        }
      }
    }
  }
}

TEST(PagePyramid, TheSecondEyeOfAPairBeginsWhereItIs) {
  const auto image = tiled(page_test::pattern(1400, 300), 1);
  const PanoramaMap map = panorama::cylinder_map(700, 300, 700, 0, 150);
  const auto right = panorama::read_page_pixels({image, {700, 0}, map}, 0, {-1, 0, 4, 1});
  EXPECT_EQ(right.pixels[0], page_test::colour_at(1399, 0));
  EXPECT_EQ(right.pixels[1], page_test::colour_at(700, 0));
  EXPECT_EQ(right.pixels[3], page_test::colour_at(702, 0));
}

TEST(PagePyramid, TilesHaveABorder) {
  const auto image = tiled(page_test::pattern(700, 300), 1);
  const PageImage from{image, {}, panorama::cylinder_map(700, 300, 700, 0, 150)};
  const PagePyramid pyramid = panorama::pyramid_of(from.map);
  ASSERT_EQ(pyramid.levels, 2);
  EXPECT_EQ(pyramid.all_tiles(), 3);
  const auto first = panorama::read_page_tile(from, pyramid, 0, 0, 0);
  EXPECT_EQ(first.width, 514);
  EXPECT_EQ(first.height, 302);
  const auto second = panorama::read_page_tile(from, pyramid, 0, 1, 0);
  EXPECT_EQ(second.width, 700 - 512 + 2);
  EXPECT_EQ(second.pixels[static_cast<std::size_t>(second.width)], page_test::colour_at(511, 0));
}

}  // namespace
