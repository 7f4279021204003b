// Files written piece by piece, read back by the libraries of others.
#include "panorama/image/big_tiff.h"

#include <gtest/gtest.h>
#include <tiffio.h>
#include <unistd.h>

#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <mutex>
#include <random>

#include "panorama/image/row_file.h"
#include "panorama/image/strip_file.h"
#include "panorama/image/xmp_file.h"
#include "panorama/metadata/gpano.h"
#include "tests/panorama/test_images.h"
#include "vpe/core/image/image.h"

namespace panorama {
namespace {

using vpe::base::OutputFile;

struct BigTiff : ::testing::Test {
  test_support::TempDir dir;
  std::filesystem::path path = dir / "x.tif";
  vpe::base::ThreadPool pool{2};
};

vpe::core::TiffMetadata nan_is_nodata() {
  vpe::core::TiffMetadata metadata;
  metadata.nodata = "nan";
  return metadata;
}

using Tiff = std::unique_ptr<TIFF, void (*)(TIFF*)>;
Tiff open(const std::filesystem::path& path) { return {TIFFOpen(path.c_str(), "r"), TIFFClose}; }

// Smooth with some noise, different in every channel.
vpe::base::Rgb colour_at(std::int64_t x, std::int64_t y) {
  const auto n = static_cast<unsigned>(x * 7919 + y * 104729);
  return {static_cast<std::uint8_t>(x / 3), static_cast<std::uint8_t>(y + (n % 5)),
          static_cast<std::uint8_t>((n * 2654435761U) >> 29)};
}

std::vector<std::uint8_t> tile_of(std::int64_t across, std::int64_t down, std::int64_t width,
                                  std::int64_t height) {
  std::vector<std::uint8_t> tile;
  for (std::int64_t j = 0; j < kTile_px; ++j) {
    for (std::int64_t i = 0; i < kTile_px; ++i) {
      const vpe::base::Rgb c =
          colour_at(std::min(across * kTile_px + i, width - 1), std::min(down * kTile_px + j, height - 1));
      tile.insert(tile.end(), {c.r, c.g, c.b});
    }
  }
  return tile;
}

TEST_F(BigTiff, ColoursAndReducedPagesAreReadByLibtiff) {
  constexpr std::int64_t kWidth = 1031;
  constexpr std::int64_t kHeight = 517;
  const std::string xmp = to_xmp(gpano_of(cylinder_map(kWidth, kHeight, kWidth, 0, 200)));
  {
    OutputFile file(path);
    BigTiffWriter writer(file, kWidth, kHeight, kRgb, {"someone", xmp});
    EXPECT_THROW(writer.finish(), std::logic_error);
    for (std::int64_t x = writer.tiles_across(); x-- > 0;) {
      for (std::int64_t y = 0; y < writer.tiles_down(); ++y)
        writer.put(x, y, pack_tile(tile_of(x, y, kWidth, kHeight), kRgb));
    }
    double last = 0;
    writer.add_reduced_pages(pool, [&](double done) { last = done; });
    EXPECT_GT(last, 0.5);
    writer.finish();
    file.commit();
  }
  const Tiff tiff = open(path);
  ASSERT_NE(tiff, nullptr);
  std::vector<vpe::base::Rgb> finer;
  std::int64_t width = kWidth;
  std::int64_t height = kHeight;
  int pages = 0;
  do {
    std::uint32_t w = 0;
    std::uint32_t h = 0;
    std::uint32_t reduced = 9;
    TIFFGetField(tiff.get(), TIFFTAG_IMAGEWIDTH, &w);
    TIFFGetField(tiff.get(), TIFFTAG_IMAGELENGTH, &h);
    TIFFGetField(tiff.get(), TIFFTAG_SUBFILETYPE, &reduced);
    ASSERT_EQ(w, width);
    ASSERT_EQ(h, height);
    EXPECT_EQ(reduced, pages == 0 ? 0U : 1U);
    std::vector<std::uint32_t> raster(std::size_t{w} * h);
    ASSERT_EQ(TIFFReadRGBAImageOriented(tiff.get(), w, h, raster.data(), ORIENTATION_TOPLEFT, 1), 1);
    std::vector<vpe::base::Rgb> now;
    for (const std::uint32_t p : raster) {
      now.push_back({static_cast<std::uint8_t>(TIFFGetR(p)), static_cast<std::uint8_t>(TIFFGetG(p)),
                     static_cast<std::uint8_t>(TIFFGetB(p))});
    }
    for (std::int64_t y = 0; y < height; ++y) {
      for (std::int64_t x = 0; x < width; ++x) {
        const vpe::base::Rgb is = now[static_cast<std::size_t>(y * width + x)];
        if (pages == 0) {
          ASSERT_EQ(is, colour_at(x, y)) << x << " " << y;
          continue;
        }
        const std::int64_t fine_width = pages == 1 ? kWidth : (kWidth + 1) / 2;
        const std::int64_t fine_height = pages == 1 ? kHeight : (kHeight + 1) / 2;
        if (pages > 2) continue;
        int sum = 0;
        for (int n = 0; n < 4; ++n) {
          const std::int64_t fx = std::min(2 * x + n % 2, fine_width - 1);
          const std::int64_t fy = std::min(2 * y + n / 2, fine_height - 1);
          sum += finer[static_cast<std::size_t>(fy * fine_width + fx)].g;
        }
        ASSERT_EQ(is.g, (sum + 2) / 4) << pages << ": " << x << " " << y;
      }
    }
    finer = now;
    width = (width + 1) / 2;
    height = (height + 1) / 2;
    ++pages;
  } while (TIFFReadDirectory(tiff.get()) == 1);
  EXPECT_EQ(pages, 4);  // 1031, 516, 258, 129
  const ImageFileHeader header = read_image_header(path);
  EXPECT_EQ(header.format, ImageFileFormat::kTiff);
  EXPECT_EQ(header.xmp, xmp);
}

template <class Number>
void expect_numbers(const std::filesystem::path& path, int samples) {
  constexpr std::int64_t kWidth = 300;
  constexpr std::int64_t kHeight = 40;
  const SampleFormat format{samples, sizeof(Number)};
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal(0, 1e5);
  std::vector<std::vector<Number>> tiles;
  {
    OutputFile file(path);
    BigTiffWriter writer(file, kWidth, kHeight, format, {"someone", "", nan_is_nodata()});
    for (int n = 0; n < 2; ++n) {
      std::vector<Number> tile(static_cast<std::size_t>(kTile_px * kTile_px * samples));
      for (Number& value : tile) value = static_cast<Number>(normal(random));
      tile[5] = std::numeric_limits<Number>::quiet_NaN();
      tile[6] = std::numeric_limits<Number>::infinity();
      const auto* bytes = reinterpret_cast<const std::uint8_t*>(tile.data());
      const std::vector<std::uint8_t> packed = pack_tile({bytes, tile.size() * sizeof(Number)}, format);
      const std::vector<std::uint8_t> again = unpack_tile(packed, format);
      EXPECT_EQ(std::memcmp(again.data(), bytes, again.size()), 0);
      writer.put(n, 0, packed);
      tiles.push_back(tile);
    }
    writer.finish();
    file.commit();
  }
  const Tiff tiff = open(path);
  ASSERT_NE(tiff, nullptr);
  for (std::uint32_t n = 0; n < 2; ++n) {
    std::vector<Number> is(tiles[n].size());
    ASSERT_GT(TIFFReadEncodedTile(tiff.get(), n, is.data(), static_cast<tmsize_t>(is.size() * sizeof(Number))),
              0);
    EXPECT_EQ(std::memcmp(is.data(), tiles[n].data(), is.size() * sizeof(Number)), 0);
  }
}

TEST_F(BigTiff, NumbersKeepTheirBits) {
  expect_numbers<float>(path, 1);
  expect_numbers<double>(path, 2);
}

// A small image that needs several tiles, each of one colour: the number of the tile.
std::vector<std::uint8_t> plain_tile(std::int64_t number) {
  return pack_tile(std::vector<std::uint8_t>(kRgb.tile_bytes(), static_cast<std::uint8_t>(number)), kRgb);
}

void expect_plain_tiles(const std::filesystem::path& path, std::uint32_t tiles) {
  const Tiff tiff = open(path);
  ASSERT_NE(tiff, nullptr);
  ASSERT_EQ(TIFFNumberOfTiles(tiff.get()), tiles);
  std::vector<std::uint8_t> is(kRgb.tile_bytes());
  for (std::uint32_t n = 0; n < tiles; ++n) {
    ASSERT_EQ(TIFFReadEncodedTile(tiff.get(), n, is.data(), static_cast<tmsize_t>(is.size())),
              static_cast<tmsize_t>(is.size()));
    EXPECT_EQ(is.front(), n);
    EXPECT_EQ(is.back(), n);
  }
}

TEST_F(BigTiff, TilesArePackedByManyThreadsAndPutInAnyOrder) {
  constexpr std::int64_t kAcross = 13;
  constexpr std::int64_t kDown = 7;
  test_support::Random random(12);
  for (int round = 0; round < 3; ++round) {
    std::vector<std::int64_t> order(kAcross * kDown);
    for (std::size_t n = 0; n < order.size(); ++n) order[n] = static_cast<std::int64_t>(n);
    for (std::size_t n = order.size() - 1; n > 0; --n)
      std::swap(order[n], order[static_cast<std::size_t>(random.integer(0, static_cast<int>(n)))]);
    OutputFile file(path);
    BigTiffWriter writer(file, kAcross * kTile_px, kDown * kTile_px, kRgb, {});
    vpe::base::ThreadPool many(8);
    std::mutex mutex;
    many.run(order.size(), [&](std::size_t n) {
      const std::vector<std::uint8_t> packed = plain_tile(order[n]);
      const std::lock_guard lock(mutex);
      writer.put(order[n] % kAcross, order[n] / kAcross, packed);
    });
    EXPECT_THROW(writer.put(kAcross, 0, plain_tile(0)), std::out_of_range);
    EXPECT_THROW(writer.put(0, -1, plain_tile(0)), std::out_of_range);
    writer.finish();
    file.commit();
    expect_plain_tiles(path, kAcross * kDown);
  }
}

TEST_F(BigTiff, TilesAndDirectoriesLieBeyondFourGigabytes) {
  {
    OutputFile file(path);
    BigTiffWriter writer(file, 3 * kTile_px, kTile_px, kRgb, {"someone", "<x/>"});
    writer.put(2, 0, plain_tile(2));
    // Sparse: takes no room on the disk.
    constexpr off_t kFiveGigabytes = off_t{5} << 30;
    ASSERT_EQ(std::fflush(file.stream()), 0);
    ASSERT_EQ(::ftruncate(::fileno(file.stream()), kFiveGigabytes), 0);
    writer.put(0, 0, plain_tile(0));
    writer.put(1, 0, plain_tile(1));
    writer.add_reduced_pages(pool, [](double) {});
    writer.finish();
    file.commit();
  }
  EXPECT_GT(std::filesystem::file_size(path), std::uintmax_t{5} << 30);
  expect_plain_tiles(path, 3);
  EXPECT_EQ(read_image_header(path).xmp, "<x/>");
  const Tiff tiff = open(path);
  EXPECT_GE(TIFFGetStrileOffset(tiff.get(), 0), std::uint64_t{5} << 30);
  ASSERT_EQ(TIFFReadDirectory(tiff.get()), 1);
  EXPECT_EQ(TIFFReadDirectory(tiff.get()), 1);  // 768, 384 and 192 columns
  EXPECT_EQ(TIFFReadDirectory(tiff.get()), 0);
}

TEST_F(BigTiff, TagsSayWhatThePixelsAre) {
  for (const SampleFormat format : {kRgb, SampleFormat{1, 4}, SampleFormat{2, 8}}) {
    {
      OutputFile file(path);
      BigTiffWriter writer(file, 10, 20, format,
                           {"someone", "<x/>", format == kRgb ? vpe::core::TiffMetadata{} : nan_is_nodata()});
      writer.put(0, 0, pack_tile(std::vector<std::uint8_t>(format.tile_bytes()), format));
      writer.finish();
      file.commit();
    }
    const std::vector<std::uint8_t> start = vpe::base::read_file(path, 1 << 24);
    EXPECT_EQ(start[2], 43);  // BigTIFF
    const Tiff tiff = open(path);
    ASSERT_NE(tiff, nullptr);
    const auto number = [&](std::uint32_t tag) {
      std::uint16_t value = 0;
      EXPECT_EQ(TIFFGetField(tiff.get(), tag, &value), 1) << tag;
      return value;
    };
    EXPECT_EQ(number(TIFFTAG_BITSPERSAMPLE), 8 * format.bytes);
    EXPECT_EQ(number(TIFFTAG_SAMPLESPERPIXEL), format.samples);
    EXPECT_EQ(number(TIFFTAG_COMPRESSION), COMPRESSION_ADOBE_DEFLATE);
    EXPECT_EQ(number(TIFFTAG_PLANARCONFIG), PLANARCONFIG_CONTIG);
    const bool is_rgb = format == kRgb;
    EXPECT_EQ(number(TIFFTAG_PHOTOMETRIC), is_rgb ? PHOTOMETRIC_RGB : PHOTOMETRIC_MINISBLACK);
    EXPECT_EQ(number(TIFFTAG_PREDICTOR), is_rgb ? PREDICTOR_HORIZONTAL : PREDICTOR_FLOATINGPOINT);
    EXPECT_EQ(number(TIFFTAG_SAMPLEFORMAT), is_rgb ? SAMPLEFORMAT_UINT : SAMPLEFORMAT_IEEEFP);
    std::uint16_t extra = 0;
    const std::uint16_t* kinds = nullptr;
    EXPECT_EQ(TIFFGetField(tiff.get(), TIFFTAG_EXTRASAMPLES, &extra, &kinds), format.samples == 2 ? 1 : 0);
    EXPECT_EQ(extra, format.samples == 2 ? 1 : 0);
    const char* text = nullptr;
    ASSERT_EQ(TIFFGetField(tiff.get(), TIFFTAG_SOFTWARE, &text), 1);
    EXPECT_STREQ(text, "someone");
    EXPECT_EQ(read_image_header(path).xmp, "<x/>");
    const std::string info = panorama_test::output_of("gdalinfo", {path.string()});
    EXPECT_EQ(info.find("NoData Value=nan") != std::string::npos, !is_rgb) << info;
  }
}

TEST_F(BigTiff, ADamagedTileIsAnError) {
  std::vector<std::uint8_t> packed = pack_tile(tile_of(0, 0, 256, 256), kRgb);
  packed.resize(packed.size() / 2);
  EXPECT_THROW(unpack_tile(packed, kRgb), std::runtime_error);
  EXPECT_THROW(unpack_tile({}, kRgb), std::runtime_error);
}

std::vector<vpe::base::Rgb> rows_of(std::int64_t width, std::int64_t height) {
  std::vector<vpe::base::Rgb> rows;
  for (std::int64_t y = 0; y < height; ++y) {
    for (std::int64_t x = 0; x < width; ++x) rows.push_back(colour_at(x, y));
  }
  return rows;
}

TEST_F(BigTiff, RowsMakeThePngThatOthersRead) {
  constexpr std::int64_t kWidth = 3001;
  constexpr std::int64_t kHeight = 300;  // several blocks
  const std::vector<vpe::base::Rgb> rows = rows_of(kWidth, kHeight);
  const std::string xmp = to_xmp(gpano_of(cylinder_map(kWidth, kHeight, kWidth, 0, 200)));
  std::vector<std::uint8_t> bytes[2];
  for (const int threads : {1, 3}) {
    vpe::base::ThreadPool own(threads);
    OutputFile file(path);
    const auto writer = make_png_writer(file, kWidth, kHeight, xmp, own);
    EXPECT_THROW(writer->finish(), std::logic_error);
    writer->write(std::span(rows).subspan(0, kWidth));
    writer->write(std::span(rows).subspan(kWidth));
    EXPECT_THROW(writer->write(std::span(rows).subspan(0, kWidth)), std::logic_error);
    writer->finish();
    file.commit();
    bytes[threads > 1] = vpe::base::read_file(path, 1 << 30);
  }
  EXPECT_EQ(bytes[0], bytes[1]);
  const vpe::core::RgbImage image = vpe::core::decode_png(bytes[0]);
  EXPECT_EQ(image.width, kWidth);
  EXPECT_EQ(image.pixels, rows);
  EXPECT_EQ(read_image_header(path).xmp, xmp);
  // Not much larger than what libpng makes of it.
  EXPECT_LT(bytes[0].size(), vpe::core::encode_png(rows, kWidth, kHeight).size() * 11 / 10);
}

TEST_F(BigTiff, RowsMakeTheJpegThatOthersRead) {
  constexpr std::int64_t kWidth = 601;
  constexpr std::int64_t kHeight = 130;
  const std::vector<vpe::base::Rgb> rows = rows_of(kWidth, kHeight);
  const std::string xmp = to_xmp(gpano_of(cylinder_map(kWidth, kHeight, kWidth, 0, 60)));
  {
    OutputFile file(path);
    const auto writer = make_jpeg_writer(file, kWidth, kHeight, xmp, 90);
    writer->write(std::span(rows).subspan(0, kWidth * 64));
    writer->write(std::span(rows).subspan(kWidth * 64));
    writer->finish();
    file.commit();
  }
  const ImageFileHeader header = read_image_header(path);
  EXPECT_EQ(header.format, ImageFileFormat::kJpeg);
  EXPECT_EQ(header.xmp, xmp);
  // The same image as in one go.
  const auto whole = vpe::core::decode_jpeg(vpe::core::encode_jpeg(rows, kWidth, kHeight, 90));
  EXPECT_EQ(vpe::core::read_image(path).pixels, whole.pixels);
}

TEST_F(BigTiff, StripsAreReadOnlyWhole) {
  const std::vector<std::vector<std::uint8_t>> blocks{{1, 2, 3}, {}, std::vector<std::uint8_t>(100000, 7)};
  const auto write = [&] {
    OutputFile file(path);
    StripWriter writer(file, "abc");
    for (const auto& block : blocks) writer.add(block);
    writer.finish();
    file.commit();
  };
  write();
  const auto strip = StripFile::open(path, "abc", 3);
  ASSERT_TRUE(strip);
  for (std::size_t n = 0; n < 3; ++n) EXPECT_EQ(strip->block(n), blocks[n]);
  EXPECT_FALSE(StripFile::open(path, "abd", 3));
  EXPECT_FALSE(StripFile::open(path, "abc", 2));
  EXPECT_FALSE(StripFile::open(dir / "none", "abc", 3));
  const auto bytes = vpe::base::read_file(path, 1 << 20);
  for (const std::size_t at : {std::size_t{0}, std::size_t{14}, std::size_t{20}, std::size_t{40},
                               bytes.size() - 1, bytes.size() - 9, bytes.size() - 20}) {
    auto bad = bytes;
    bad[at] ^= 1;
    vpe::base::write_file(path, bad);
    EXPECT_FALSE(StripFile::open(path, "abc", 3)) << at;
    bad.resize(at);
    vpe::base::write_file(path, bad);
    EXPECT_FALSE(StripFile::open(path, "abc", 3)) << at;
  }
}

}  // namespace
}  // namespace panorama
