#include "vpe/core/image/image.h"

#include <gdal_priv.h>
#include <sys/resource.h>

#include <bit>
#include <clocale>
#include <cmath>
#include <csignal>
#include <cstring>
#include <fstream>
#include <limits>

#include "tests/support/support.h"

namespace vpe::core {
namespace {

namespace fs = std::filesystem;

// Smooth, so that JPEG can keep it, with all three channels different.
std::vector<vpe::base::Rgb> smooth_image(int width, int height) {
  std::vector<vpe::base::Rgb> pixels;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      pixels.push_back({static_cast<std::uint8_t>(127 + 100 * std::sin(0.05 * x)),
                        static_cast<std::uint8_t>(127 + 100 * std::cos(0.04 * y)),
                        static_cast<std::uint8_t>(127 + 60 * std::sin(0.03 * (x + y)))});
    }
  }
  return pixels;
}

std::vector<vpe::base::Rgb> noise_image(int width, int height) {
  test_support::Random random(1);
  std::vector<vpe::base::Rgb> pixels(static_cast<std::size_t>(width * height));
  const auto byte = [&random] { return static_cast<std::uint8_t>(random.integer(0, 255)); };
  for (vpe::base::Rgb& p : pixels) p = {byte(), byte(), byte()};
  return pixels;
}

int worst_difference(const std::vector<vpe::base::Rgb>& a, const std::vector<vpe::base::Rgb>& b) {
  int worst = 0;
  for (std::size_t n = 0; n < a.size(); ++n) {
    worst = std::max({worst, std::abs(a[n].r - b[n].r), std::abs(a[n].g - b[n].g), std::abs(a[n].b - b[n].b)});
  }
  return worst;
}

// A band as GDAL reads it.
template <class Value>
std::vector<Value> gdal_band(const fs::path& path, int band, GDALDataType type, std::size_t count, int bands) {
  GDALAllRegister();
  const std::unique_ptr<GDALDataset> file(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER));
  std::vector<Value> values(count);
  if (file == nullptr || file->GetRasterCount() != bands) return {};
  GDALRasterBand* raster = file->GetRasterBand(band);
  if (static_cast<std::size_t>(raster->GetXSize()) * static_cast<std::size_t>(raster->GetYSize()) != count)
    return {};
  if (raster->RasterIO(GF_Read, 0, 0, raster->GetXSize(), raster->GetYSize(), values.data(), raster->GetXSize(),
                       raster->GetYSize(), type, 0, 0) != CE_None) {
    return {};
  }
  return values;
}

std::string thrown(const std::function<void()>& action) {
  try {
    action();
  } catch (const std::runtime_error& e) {
    return e.what();
  }
  return "";
}

void expect_words(const std::string& message, std::initializer_list<const char*> words) {
  for (const char* word : words)
    EXPECT_NE(message.find(word), std::string::npos) << message << "\nlacks: " << word;
}

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
  return names;
}

// Files of this process cannot grow over `bytes`: what a full disk looks like to a writer.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) : old_handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &old_limit_);
    const rlimit limit{bytes, old_limit_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &old_limit_);
    std::signal(SIGXFSZ, old_handler_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  void (*old_handler_)(int);
  rlimit old_limit_{};
};

TEST(Image, PngIsLosslessAsGdalReadsIt) {
  const test_support::TempDir folder;
  for (const int compression : {1, 3, 9}) {
    const std::vector<vpe::base::Rgb> pixels = noise_image(61, 37);
    write_image(folder / "a.PNG", pixels, 61, 37, {.png_compression = compression});
    for (int band = 1; band <= 3; ++band) {
      const auto values = gdal_band<std::uint8_t>(folder / "a.PNG", band, GDT_Byte, pixels.size(), 3);
      ASSERT_EQ(values.size(), pixels.size());
      for (std::size_t n = 0; n < values.size(); ++n) {
        ASSERT_EQ(values[n], band == 1 ? pixels[n].r : band == 2 ? pixels[n].g : pixels[n].b);
      }
    }
    const RgbImage back = read_image(folder / "a.PNG");
    EXPECT_EQ(back.width, 61);
    EXPECT_EQ(back.height, 37);
    EXPECT_EQ(back.pixels, pixels);
  }
}

// Rows that differ least from the left, from above, or from neither; of every small size.
TEST(Image, PngIsLosslessWhateverItsRowsAreLike) {
  test_support::Random random(8);
  for (int n = 0; n < 300; ++n) {
    const int width = random.integer(1, n % 10 == 0 ? 700 : 70);
    const int height = random.integer(1, 40);
    std::vector<vpe::base::Rgb> pixels = noise_image(width, height);
    const int kind = random.integer(0, 3);
    for (std::size_t k = 0; k < pixels.size(); ++k) {
      const auto x = static_cast<int>(k % static_cast<std::size_t>(width));
      const auto y = static_cast<int>(k / static_cast<std::size_t>(width));
      const int value = kind == 0 ? 3 * x : kind == 1 ? 5 * y : 127 + (x + y) % 2;
      const auto byte = static_cast<std::uint8_t>(value);
      if (kind < 3) pixels[k] = {byte, static_cast<std::uint8_t>(byte + 1), 255};
    }
    const RgbImage back = decode_png(encode_png(pixels, width, height));
    ASSERT_EQ(back.width, width);
    ASSERT_EQ(back.height, height);
    ASSERT_EQ(back.pixels, pixels) << width << "x" << height << " kind " << kind;
  }
}

TEST(Image, PngWithAlphaKeepsColourUnderTransparency) {
  const test_support::TempDir folder;
  const std::vector<vpe::base::Rgb> colours = noise_image(20, 30);
  std::vector<Rgba> pixels;
  for (std::size_t n = 0; n < colours.size(); ++n) {
    pixels.push_back({colours[n].r, colours[n].g, colours[n].b, static_cast<std::uint8_t>(n)});
  }
  write_image(folder / "a.png", pixels, 20, 30);
  const auto alpha = gdal_band<std::uint8_t>(folder / "a.png", 4, GDT_Byte, pixels.size(), 4);
  const auto red = gdal_band<std::uint8_t>(folder / "a.png", 1, GDT_Byte, pixels.size(), 4);
  ASSERT_EQ(alpha.size(), pixels.size());
  for (std::size_t n = 0; n < pixels.size(); ++n) {
    ASSERT_EQ(alpha[n], pixels[n].a);
    ASSERT_EQ(red[n], pixels[n].r);
  }
  EXPECT_EQ(read_image(folder / "a.png").pixels, colours);
}

TEST(Image, JpegIsCloseAndGdalAgrees) {
  const test_support::TempDir folder;
  const std::vector<vpe::base::Rgb> pixels = smooth_image(129, 129);
  int before = 256;
  for (const int quality : {40, 75, 90, 100}) {
    write_image(folder / "a.jpg", pixels, 129, 129, {.jpeg_quality = quality});
    const RgbImage back = read_image(folder / "a.jpg");
    ASSERT_EQ(back.width, 129);
    const int worst = worst_difference(back.pixels, pixels);
    EXPECT_LE(worst, before + 1);
    before = worst;
    const auto red = gdal_band<std::uint8_t>(folder / "a.jpg", 1, GDT_Byte, pixels.size(), 3);
    ASSERT_EQ(red.size(), pixels.size());
    // Decoders may differ by a step of rounding and in how they widen chroma.
    for (std::size_t n = 0; n < red.size(); ++n) ASSERT_NEAR(red[n], back.pixels[n].r, quality < 90 ? 6 : 2);
  }
  EXPECT_LE(before, 4);
}

TEST(Image, JpegBytesAreTheFile) {
  const test_support::TempDir folder;
  const std::vector<vpe::base::Rgb> pixels = smooth_image(64, 48);
  write_image(folder / "a.jpeg", pixels, 64, 48, {.jpeg_quality = 80});
  const std::vector<std::uint8_t> bytes = encode_jpeg(pixels, 64, 48, 80);
  EXPECT_EQ(base::read_file(folder / "a.jpeg", 1 << 20), bytes);
  EXPECT_EQ(decode_jpeg(bytes).pixels, read_image(folder / "a.jpeg").pixels);
  EXPECT_LT(bytes.size(), encode_jpeg(pixels, 64, 48, 95).size());
}

TEST(Image, TiffKeepsEveryFloatToTheBit) {
  const test_support::TempDir folder;
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  std::vector<float> values{0.0F,
                            -0.0F,
                            1.5F,
                            kInfinity,
                            -kInfinity,
                            std::numeric_limits<float>::quiet_NaN(),
                            std::numeric_limits<float>::denorm_min(),
                            std::numeric_limits<float>::max(),
                            1e-30F};
  test_support::Random random(2);
  while (values.size() < 301 * 700) {
    values.push_back(random.integer(0, 3) == 0 ? kInfinity : static_cast<float>(random.log_uniform(0.1, 1e8)));
  }
  for (const TiffCompression compression :
       {TiffCompression::kNone, TiffCompression::kLzw, TiffCompression::kDeflate}) {
    write_tiff(folder / "range.tif", values, 301, 700, {.tiff = compression});
    const auto by_gdal = gdal_band<float>(folder / "range.tif", 1, GDT_Float32, values.size(), 1);
    const FloatImage back = read_tiff(folder / "range.tif");
    ASSERT_EQ(by_gdal.size(), values.size());
    ASSERT_EQ(back.pixels.size(), values.size());
    EXPECT_EQ(back.width, 301);
    EXPECT_EQ(back.height, 700);
    EXPECT_EQ(std::memcmp(by_gdal.data(), values.data(), values.size() * sizeof(float)), 0);
    EXPECT_EQ(std::memcmp(back.pixels.data(), values.data(), values.size() * sizeof(float)), 0);
  }
}

TEST(Image, OnePixel) {
  const test_support::TempDir folder;
  const std::vector<vpe::base::Rgb> pixel{{1, 2, 3}};
  write_image(folder / "a.png", pixel, 1, 1);
  EXPECT_EQ(read_image(folder / "a.png").pixels, pixel);
  EXPECT_LE(worst_difference(decode_jpeg(encode_jpeg(pixel, 1, 1, 100)).pixels, pixel), 2);
  const std::vector<float> range{7};
  write_tiff(folder / "a.tif", range, 1, 1);
  EXPECT_EQ(read_tiff(folder / "a.tif").pixels, range);
}

TEST(Image, SizesAreCheckedBeforeAnythingIsDone) {
  const test_support::TempDir folder;
  const std::vector<vpe::base::Rgb> pixels(12);
  const std::vector<float> values(12);
  for (const auto& size : {std::pair{0, 12}, {12, 0}, {-3, -4}, {100000, 100000}, {3, 3}, {12, 2}}) {
    const int width = size.first;
    const int height = size.second;
    for (const char* name : {"a.png", "a.jpg"}) {
      expect_words(thrown([&] { write_image(folder / name, pixels, width, height); }), {name, "image of"});
    }
    expect_words(thrown([&] { write_tiff(folder / "a.tif", values, width, height); }), {"a.tif", "image of"});
  }
  EXPECT_TRUE(names_in(folder.path()).empty());
}

TEST(Image, ReadersRefuseMoreThanTheyAreAllowed) {
  const test_support::TempDir folder;
  const std::vector<vpe::base::Rgb> pixels(100 * 50);
  write_image(folder / "a.png", pixels, 100, 50);
  write_image(folder / "a.jpg", pixels, 100, 50);
  write_tiff(folder / "a.tif", std::vector<float>(100 * 50), 100, 50);
  EXPECT_NO_THROW(read_image(folder / "a.png", 5000));
  expect_words(thrown([&] { read_image(folder / "a.png", 4999); }), {"a.png", "100x50", "at most 4999"});
  expect_words(thrown([&] { read_image(folder / "a.jpg", 4999); }), {"a.jpg", "100x50", "at most 4999"});
  expect_words(thrown([&] { read_tiff(folder / "a.tif", 4999); }), {"a.tif", "100x50", "at most 4999"});

  // A PNG whose header claims 2^31 - 1 squared.
  std::vector<std::uint8_t> bytes = encode_png(pixels, 100, 50);
  for (const std::size_t at : {16U, 20U}) {
    bytes[at] = 0x7F;
    bytes[at + 1] = bytes[at + 2] = bytes[at + 3] = 0xFF;
  }
  EXPECT_THROW(decode_png(bytes), ImageError);
}

TEST(Image, CutShortIsAnErrorAtEveryLength) {
  const std::vector<vpe::base::Rgb> pixels = noise_image(16, 16);
  for (const auto& bytes : {encode_png(pixels, 16, 16), encode_jpeg(pixels, 16, 16, 90)}) {
    const bool is_png = bytes[0] == 0x89;
    // What follows the last pixel (IEND, EOI) may be missing.
    for (std::size_t size = 0; size + 13 < bytes.size(); ++size) {
      const std::span<const std::uint8_t> cut(bytes.data(), size);
      EXPECT_THROW(is_png ? decode_png(cut) : decode_jpeg(cut), ImageError) << size << " of " << bytes.size();
    }
  }
}

TEST(Image, FlippedBytesNeverCrash) {
  test_support::Random random(3);
  const std::vector<vpe::base::Rgb> pixels = noise_image(24, 24);
  const test_support::TempDir folder;
  write_tiff(folder / "a.tif", std::vector<float>(24 * 24, 1.0F), 24, 24);
  const std::vector<std::uint8_t> sources[] = {encode_png(pixels, 24, 24), encode_jpeg(pixels, 24, 24, 80),
                                               base::read_file(folder / "a.tif", 1 << 20)};
  int refused = 0;
  for (int round = 0; round < 3000; ++round) {
    const auto kind = static_cast<std::size_t>(round % 3);
    std::vector<std::uint8_t> bytes = sources[kind];
    for (int n = random.integer(1, 4); n > 0; --n) {
      bytes[static_cast<std::size_t>(random.integer(0, static_cast<int>(bytes.size()) - 1))] =
          static_cast<std::uint8_t>(random.integer(0, 255));
    }
    try {
      if (kind == 0) decode_png(bytes, 1 << 16);
      if (kind == 1) decode_jpeg(bytes, 1 << 16);
      if (kind == 2) {
        base::write_file(folder / "b.tif", bytes);
        read_tiff(folder / "b.tif", 1 << 16);
      }
    } catch (const std::runtime_error& e) {
      EXPECT_GT(std::strlen(e.what()), 20U);
      ++refused;
    }
  }
  EXPECT_GT(refused, 500);
}

TEST(Image, ErrorsNameFileOperationWordsAndAdvice) {
  const test_support::TempDir folder;
  const std::vector<vpe::base::Rgb> pixels(4);
  expect_words(thrown([&] { write_image(folder / "a.bmp", pixels, 2, 2); }), {"cannot write", "a.bmp", ".png"});
  expect_words(thrown([&] { write_image(folder / "none/a.png", pixels, 2, 2); }),
               {"cannot write", "none/a.png", "No such file", "folder exists"});
  expect_words(thrown([&] { write_image(folder / "a.jpg", std::vector<Rgba>(4), 2, 2); }),
               {"a.jpg", "alpha", ".png"});
  expect_words(thrown([&] { write_image(folder / "a.jpg", pixels, 2, 2, {.jpeg_quality = 0}); }),
               {"a.jpg", "quality 0", "1 to 100"});
  expect_words(thrown([&] { write_image(folder / "a.png", pixels, 2, 2, {.png_compression = 10}); }),
               {"a.png", "compression 10", "1 to 9"});
  expect_words(thrown([&] { read_image(folder / "absent.png"); }),
               {"cannot read", "absent.png", "No such file"});
  expect_words(thrown([&] { read_image(folder.path()); }), {"cannot read"});
  base::write_file(folder / "text.png", std::string_view("hello"));
  expect_words(thrown([&] { read_image(folder / "text.png"); }), {"text.png", "neither PNG nor JPEG"});
  expect_words(thrown([&] { read_tiff(folder / "text.png"); }), {"cannot read", "text.png", "damaged"});
  expect_words(thrown([&] { read_tiff(folder / "absent.tif"); }), {"absent.tif", "No such file"});
  fs::create_directory(folder / "dir.png");
  expect_words(thrown([&] { write_image(folder / "dir.png", pixels, 2, 2); }), {"dir.png", "directory"});
}

TEST(Image, AFullDiskLeavesTheOldFileAndNoHalfOne) {
  const test_support::TempDir folder;
  const std::vector<vpe::base::Rgb> pixels = noise_image(200, 200);
  std::vector<float> values;
  test_support::Random random(4);
  for (int n = 0; n < 400 * 400; ++n) values.push_back(static_cast<float>(random.uniform(1, 2)));
  base::write_file(folder / "a.png", std::string_view("old"));
  base::write_file(folder / "a.tif", std::string_view("old"));
  for (const rlim_t limit : {rlim_t{0}, rlim_t{5000}, rlim_t{100000}}) {
    const FullDisk full(limit);
    expect_words(thrown([&] { write_image(folder / "a.png", pixels, 200, 200); }), {"a.png", "File too large"});
    expect_words(thrown([&] { write_tiff(folder / "a.tif", values, 400, 400); }), {"cannot write", "a.tif"});
  }
  for (const char* name : {"a.png", "a.tif"}) {
    EXPECT_EQ(base::read_file(folder / name, 100), (std::vector<std::uint8_t>{'o', 'l', 'd'}));
  }
  EXPECT_EQ(names_in(folder.path()).size(), 2U);
}

TEST(Image, PathsAreBytesAndTheLocaleDoesNotMatter) {
  const test_support::TempDir folder;
  const std::string old = std::setlocale(LC_ALL, nullptr);
  for (const char* locale : {"C", "de_DE.UTF-8", "tr_TR.UTF-8"}) {
    if (std::setlocale(LC_ALL, locale) == nullptr) continue;
    const fs::path path = folder / "Čertovy žluté 火星.PNG";
    EXPECT_TRUE(is_image_path(path));
    write_image(path, std::vector<vpe::base::Rgb>(4), 2, 2);
    EXPECT_EQ(read_image(path).width, 2);
  }
  std::setlocale(LC_ALL, old.c_str());
}

TEST(OutputFile, AppearsOnlyWithCommit) {
  const test_support::TempDir folder;
  {
    base::OutputFile file(folder / "a.txt");
    file.write(std::vector<std::uint8_t>{1, 2, 3});
  }
  EXPECT_TRUE(names_in(folder.path()).empty());
  base::OutputFile file(folder / "a.txt");
  file.write(std::vector<std::uint8_t>{1, 2, 3});
  EXPECT_FALSE(fs::exists(folder / "a.txt"));
  file.commit();
  EXPECT_EQ(names_in(folder.path()), std::vector<std::string>{"a.txt"});
  EXPECT_EQ(base::read_file(folder / "a.txt", 3), (std::vector<std::uint8_t>{1, 2, 3}));
  expect_words(thrown([&] { base::read_file(folder / "a.txt", 2); }), {"a.txt", "3 bytes", "the 2"});
}

}  // namespace
}  // namespace vpe::core
