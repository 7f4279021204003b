// Tiled images: the tiles that are read, and those that are kept.
#include "panorama/image/tiled_image.h"

#include <tiffio.h>

#include <atomic>
#include <fstream>

#include "panorama/image/row_source.h"
#include "panorama/image/tile_writer.h"
#include "tests/panorama/test_images.h"
#include "vpe/base/file.h"
#include "vpe/base/parallel.h"

namespace {

namespace fs = std::filesystem;
using panorama::ImageFileFormat;
using panorama::ImageLevel;
using panorama::Tile;
using panorama::TiledImage;
using panorama_test::message_of;

// Tiles of 64 x 64 that know where they are, of an image of any size.
class FakeTiles : public panorama::TileSource {
 public:
  FakeTiles(std::int64_t width_px, std::int64_t height_px, int levels) {
    for (int n = 0; n < levels; ++n) levels_.push_back({width_px >> n, height_px >> n, 64, 64});
  }
  const std::vector<ImageLevel>& levels() const override { return levels_; }
  std::shared_ptr<const Tile> read(int level, std::int64_t column, std::int64_t row) const override {
    ++reads;
    if (fails) throw vpe::base::FileError("no such tile");
    auto tile = std::make_shared<Tile>();
    tile->width_px = tile->height_px = 64;
    tile->pixels.assign(64 * 64, {static_cast<std::uint8_t>(level), static_cast<std::uint8_t>(column),
                                  static_cast<std::uint8_t>(row)});
    return tile;
  }
  mutable std::atomic<int> reads = 0;
  std::atomic<bool> fails = false;

 private:
  std::vector<ImageLevel> levels_;
};

constexpr std::size_t kTileBytes = 64 * 64 * 3;

TEST(TiledImage, KeepsWithinItsBudgetTheLastUsed) {
  auto source = std::make_unique<FakeTiles>(6400, 640, 3);
  const FakeTiles& fake = *source;
  const TiledImage tiled_image(std::move(source), 10 * (kTileBytes + 200));
  for (int n = 0; n < 10; ++n) tiled_image.tile(0, n, 0);
  EXPECT_EQ(fake.reads, 10);
  for (int n = 0; n < 10; ++n) tiled_image.tile(0, n, 0);
  EXPECT_EQ(fake.reads, 10);
  tiled_image.tile(0, 0, 0);
  tiled_image.tile(0, 50, 0);  // removes the least recently used tile: 1
  tiled_image.tile(0, 0, 0);
  EXPECT_EQ(fake.reads, 11);
  tiled_image.tile(0, 1, 0);
  EXPECT_EQ(fake.reads, 12);
  test_support::Random random(7);
  for (int n = 0; n < 10000; ++n) {
    const int column = random.integer(0, 99);
    const auto tile = tiled_image.tile(0, column, random.integer(0, 9));
    ASSERT_EQ(tile->pixels.size(), 64U * 64U);
    ASSERT_LE(tiled_image.bytes(), 10 * (kTileBytes + 200));
  }
  EXPECT_EQ(tiled_image.reads(), fake.reads);
}

TEST(TiledImage, ThreadsThatWantOneTileReadItOnce) {
  auto source = std::make_unique<FakeTiles>(6400, 640, 1);
  const FakeTiles& fake = *source;
  const TiledImage tiled_image(std::move(source), std::size_t{64} << 20);
  vpe::base::parallel_for(20000, 8, [&](std::size_t n) {
    const auto column = static_cast<std::int64_t>(n % 100);
    const auto row = static_cast<std::int64_t>(n / 100 % 10);
    const auto tile = tiled_image.tile(0, column, row);
    EXPECT_EQ(tile->pixels[5],
              (vpe::base::Rgb{0, static_cast<std::uint8_t>(column), static_cast<std::uint8_t>(row)}));
  });
  EXPECT_EQ(fake.reads, 1000);
}

TEST(TiledImage, AFailureIsReportedAndTriedAgain) {
  auto source = std::make_unique<FakeTiles>(640, 640, 1);
  FakeTiles& fake = *source;
  const TiledImage tiled_image(std::move(source), std::size_t{1} << 20);
  fake.fails = true;
  EXPECT_SAYS(message_of([&] { tiled_image.tile(0, 1, 1); }), "no such tile");
  fake.fails = false;
  EXPECT_EQ(tiled_image.tile(0, 1, 1)->pixels[0].g, 1);
}

vpe::base::Rgb colour_at(int x, int y) {
  return {static_cast<std::uint8_t>(x * 3), static_cast<std::uint8_t>(y * 5), static_cast<std::uint8_t>(x + y)};
}

vpe::core::RgbImage pattern(int width, int height) {
  vpe::core::RgbImage image{width, height, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) image.pixels.push_back(colour_at(x, y));
  return image;
}

vpe::base::Rgb pixel(const TiledImage& tiled_image, int level, std::int64_t x, std::int64_t y) {
  const ImageLevel& size = tiled_image.levels()[static_cast<std::size_t>(level)];
  const auto tile = tiled_image.tile(level, x / size.tile_width_px, y / size.tile_height_px);
  return tile
      ->pixels[static_cast<std::size_t>(y % size.tile_height_px * tile->width_px + x % size.tile_width_px)];
}

// All of level 0 as the pattern; sizes of levels halve, rounded either way.
void expect_pattern(const TiledImage& tiled_image, int width, int height) {
  ASSERT_EQ(tiled_image.levels()[0].width_px, width);
  ASSERT_EQ(tiled_image.levels()[0].height_px, height);
  for (int y = 0; y < height; y += 31) {
    for (int x = 0; x < width; ++x) ASSERT_EQ(pixel(tiled_image, 0, x, y), colour_at(x, y)) << x << "," << y;
  }
  for (std::size_t n = 1; n < tiled_image.levels().size(); ++n)
    EXPECT_LE(std::abs(2 * tiled_image.levels()[n].width_px - tiled_image.levels()[n - 1].width_px), 1);
  EXPECT_LE(tiled_image.levels().back().width_px, 256);
}

panorama::TiledImageOptions options(const test_support::TempDir& folder, std::size_t budget_bytes) {
  panorama::TiledImageOptions options;
  options.budget_bytes = budget_bytes;
  options.cache_folder = [path = folder / "cache"] {
    fs::create_directories(path);
    return path;
  };
  return options;
}

// More than kMinBudget_bytes / 9 pixels, so that copies are needed.
constexpr int kWidth = 2001;
constexpr int kHeight = 1003;

TEST(OpenImage, SmallOnesLieInMemory) {
  const test_support::TempDir folder;
  const vpe::core::RgbImage image = pattern(701, 301);
  vpe::core::write_image(folder / "a.png", image.pixels, 701, 301);
  const auto tiled_image =
      panorama::open_tiled_image(folder / "a.png", ImageFileFormat::kPng, options(folder, 1 << 26));
  expect_pattern(*tiled_image, 701, 301);
  EXPECT_EQ(tiled_image->levels().size(), 3U);
  EXPECT_FALSE(fs::exists(folder / "cache"));
}

TEST(OpenImage, LargePngIsCopiedOnce) {
  const test_support::TempDir folder;
  const vpe::core::RgbImage image = pattern(kWidth, kHeight);
  vpe::core::write_image(folder / "a.png", image.pixels, kWidth, kHeight);
  int steps = 0;
  auto opening = options(folder, 0);
  opening.progress = [&](double fraction) {
    EXPECT_LE(fraction, 1.0);
    ++steps;
  };
  expect_pattern(*panorama::open_tiled_image(folder / "a.png", ImageFileFormat::kPng, opening), kWidth,
                 kHeight);
  EXPECT_GT(steps, 5);
  steps = 0;
  expect_pattern(*panorama::open_tiled_image(folder / "a.png", ImageFileFormat::kPng, opening), kWidth,
                 kHeight);
  EXPECT_EQ(steps, 0);
  // Another image under that name is another one.
  vpe::core::write_image(folder / "a.png", pattern(kWidth + 4, kHeight).pixels, kWidth + 4, kHeight);
  expect_pattern(*panorama::open_tiled_image(folder / "a.png", ImageFileFormat::kPng, opening), kWidth + 4,
                 kHeight);
}

TEST(OpenImage, CopiesThatLostALevelAreMadeAgain) {
  const test_support::TempDir folder;
  vpe::core::write_image(folder / "a.png", pattern(kWidth, kHeight).pixels, kWidth, kHeight);
  panorama::open_tiled_image(folder / "a.png", ImageFileFormat::kPng, options(folder, 0));
  for (const char* name : {"level-0.tif", "level-1.tif"}) {
    for (const auto& entry : fs::directory_iterator(folder / "cache")) fs::remove(entry.path() / name);
    expect_pattern(*panorama::open_tiled_image(folder / "a.png", ImageFileFormat::kPng, options(folder, 0)),
                   kWidth, kHeight);
  }
}

TEST(OpenImage, LargeJpegIsTheSameAsInMemory) {
  const test_support::TempDir folder;
  vpe::core::write_image(folder / "a.jpg", pattern(kWidth, kHeight).pixels, kWidth, kHeight);
  const auto small = panorama::open_tiled_image(folder / "a.jpg", ImageFileFormat::kJpeg, options(folder, 0));
  EXPECT_TRUE(fs::exists(folder / "cache"));
  const auto large = panorama::open_tiled_image(folder / "a.jpg", ImageFileFormat::kJpeg,
                                                options(folder, std::size_t{1} << 28));
  ASSERT_EQ(small->levels().size(), large->levels().size());
  for (int level = 0; level < static_cast<int>(small->levels().size()); ++level) {
    const ImageLevel& size = small->levels()[static_cast<std::size_t>(level)];
    for (std::int64_t y = 0; y < size.height_px; y += 3) {
      for (std::int64_t x = 0; x < size.width_px; x += 3)
        ASSERT_EQ(pixel(*small, level, x, y), pixel(*large, level, x, y)) << level;
    }
  }
}

TEST(OpenImage, AnInterruptedCopyLeavesNothing) {
  const test_support::TempDir folder;
  vpe::core::write_image(folder / "a.png", pattern(kWidth, kHeight).pixels, kWidth, kHeight);
  auto opening = options(folder, 0);
  opening.progress = [](double fraction) {
    if (fraction > 0.5) throw std::runtime_error("stopped");
  };
  EXPECT_SAYS(message_of([&] { panorama::open_tiled_image(folder / "a.png", ImageFileFormat::kPng, opening); }),
              "stopped");
  EXPECT_TRUE(fs::is_empty(folder / "cache"));
}

TEST(OpenImage, DamagedOnesAreNamed) {
  const test_support::TempDir folder;
  const vpe::core::RgbImage image = pattern(kWidth, kHeight);
  for (const char* name : {"a.png", "a.jpg"}) {
    vpe::core::write_image(folder / name, image.pixels, kWidth, kHeight);
    fs::resize_file(folder / name, fs::file_size(folder / name) / 2);
    const ImageFileFormat format =
        name == std::string("a.png") ? ImageFileFormat::kPng : ImageFileFormat::kJpeg;
    for (const std::size_t budget : {std::size_t{0}, std::size_t{1} << 28}) {
      EXPECT_SAYS(
          message_of([&] { panorama::open_tiled_image(folder / name, format, options(folder, budget)); }), name,
          "cannot read", "damaged");
    }
  }
  EXPECT_TRUE(!fs::exists(folder / "cache") || fs::is_empty(folder / "cache"));
}

// Writes a tiled TIFF.
void write_tiled(const fs::path& path, const vpe::core::RgbImage& image) {
  panorama::TileWriter writer(path, {image.width, image.height, 64, 64});
  for (int y = 0; y < image.height; ++y) {
    writer.take(std::span(image.pixels)
                    .subspan(static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width),
                             static_cast<std::size_t>(image.width)));
  }
  writer.finish();
}

TEST(OpenImage, TiledTiffWithoutCopiesKeepsItsOwnPixels) {
  const test_support::TempDir folder;
  write_tiled(folder / "a.tif", pattern(kWidth, kHeight));
  const auto tiled_image =
      panorama::open_tiled_image(folder / "a.tif", ImageFileFormat::kTiff, options(folder, 0));
  expect_pattern(*tiled_image, kWidth, kHeight);
  for (const auto& entry : fs::recursive_directory_iterator(folder / "cache"))
    EXPECT_NE(entry.path().filename(), "level-0.tif");
}

// Handles that are opened later are of the file that was opened first.
TEST(OpenImage, ReplacedWhileItIsInUse) {
  const test_support::TempDir folder;
  write_tiled(folder / "a.tif", pattern(kWidth, kHeight));
  const auto tiled_image =
      panorama::open_tiled_image(folder / "a.tif", ImageFileFormat::kTiff, options(folder, 0));
  write_tiled(folder / "b.tif", {kWidth, kHeight, std::vector<vpe::base::Rgb>(std::size_t{kWidth} * kHeight)});
  fs::rename(folder / "b.tif", folder / "a.tif");
  expect_pattern(*tiled_image, kWidth, kHeight);
}

TEST(OpenImage, TiffOfOtherProgramsWithReducedPages) {
  const test_support::TempDir folder;
  vpe::core::write_image(folder / "a.png", pattern(kWidth, kHeight).pixels, kWidth, kHeight);
  // A COG has its copies in the chain of images, with JPEG, LZW, a mask or 16 bits; gdaladdo adds to any.
  panorama_test::output_of("gdal_translate", {"-q", "-of", "COG", "-co", "COMPRESS=LZW", "-co", "BLOCKSIZE=128",
                                              (folder / "a.png").string(), (folder / "cog.tif").string()});
  const auto cog = panorama::open_tiled_image(folder / "cog.tif", ImageFileFormat::kTiff, options(folder, 0));
  expect_pattern(*cog, kWidth, kHeight);
  EXPECT_FALSE(fs::exists(folder / "cache"));
  panorama_test::output_of("gdal_translate",
                           {"-q", "-ot", "UInt16", "-scale", "0", "255", "0", "65535", "-of", "COG", "-co",
                            "BLOCKSIZE=128", (folder / "a.png").string(), (folder / "deep.tif").string()});
  expect_pattern(*panorama::open_tiled_image(folder / "deep.tif", ImageFileFormat::kTiff, options(folder, 0)),
                 kWidth, kHeight);
  // In rows: all of it is copied.
  panorama_test::output_of("gdal_translate",
                           {"-q", (folder / "a.png").string(), (folder / "rows.tif").string()});
  expect_pattern(*panorama::open_tiled_image(folder / "rows.tif", ImageFileFormat::kTiff, options(folder, 0)),
                 kWidth, kHeight);
  EXPECT_TRUE(fs::exists(folder / "cache"));
}

// What the libraries hold by then is given back: the address sanitizer looks.
TEST(OpenRows, RefusedImagesLeaveNothingBehind) {
  const test_support::TempDir folder;
  const std::vector<std::uint8_t> png = panorama_test::png(64, 48);
  vpe::base::write_file(folder / "cut.png", std::span(png).first(30));
  EXPECT_SAYS(message_of([&] { panorama::open_png_rows(folder / "cut.png"); }), "cut.png", "damaged");
  const std::vector<std::uint8_t> jpeg = panorama_test::jpeg(64, 48);
  vpe::base::write_file(folder / "cut.jpg", std::span(jpeg).first(200));
  EXPECT_SAYS(message_of([&] { panorama::open_jpeg_rows(folder / "cut.jpg"); }), "cut.jpg", "damaged");
  vpe::base::write_file(folder / "a.jpg", jpeg);
  panorama_test::output_of("gdal_translate", {"-q", "-of", "JPEG", "-co", "PROGRESSIVE=YES",
                                              (folder / "a.jpg").string(), (folder / "p.jpg").string()});
  EXPECT_SAYS(message_of([&] { panorama::open_jpeg_rows(folder / "p.jpg"); }), "p.jpg", "progressive",
              "--memory");
}

TEST(OpenImage, KindsThatCannotBeReadAreNamedWithAdvice) {
  const test_support::TempDir folder;
  vpe::core::write_tiff(folder / "float.tif", std::vector<float>(64, 1.0F), 8, 8);
  EXPECT_SAYS(message_of([&] {
                panorama::open_tiled_image(folder / "float.tif", ImageFileFormat::kTiff, options(folder, 0));
              }),
              "float.tif", "8 or 16 bits", "gdal_translate");
  std::ofstream(folder / "no.tif") << "II*\0 and nothing else";
  EXPECT_SAYS(message_of([&] {
                panorama::open_tiled_image(folder / "no.tif", ImageFileFormat::kTiff, options(folder, 0));
              }),
              "no.tif", "cannot read");
}

}  // namespace
