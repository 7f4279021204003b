// Views of images that are far larger than memory.
#include <cmath>
#include <fstream>

#include "panorama/image/tiled_image.h"
#include "panorama/viewer/render_view.h"
#include "panorama/viewer/viewer.h"
#include "tests/panorama/big_tiff_file.h"
#include "tests/panorama/test_images.h"
#include "tests/support/sanitized.h"

namespace {

namespace fs = std::filesystem;

// A number of /proc/self/NAME, kibibytes or bytes.
std::int64_t of_process(const std::string& name, const std::string& key) {
  std::ifstream file("/proc/self/" + name);
  std::string word;
  std::int64_t value = 0;
  while (file >> word) {
    if (word == key) file >> value;
  }
  return value;
}
std::int64_t bytes_asked_for() { return of_process("io", "rchar:"); }

constexpr std::int64_t kWidth = 100'000;
constexpr std::int64_t kHeight = 20'000;
constexpr std::size_t kBudget = std::size_t{192} << 20;  // what vpe gives it of --memory 256

// Random views; returns the most that the image kept.
void view_panorama(const fs::path& path, int requests) {
  const std::int64_t before = bytes_asked_for();
  panorama::TiledImageOptions options;
  options.budget_bytes = kBudget;
  const auto tiled_image = panorama::open_tiled_image(path, panorama::ImageFileFormat::kTiff, options);
  ASSERT_EQ(tiled_image->levels().size(), 9U);
  EXPECT_LT(bytes_asked_for() - before, 100'000);  // of directories

  const panorama::PanoramaMap map =
      panorama::equirectangular_map(kWidth, kHeight, static_cast<double>(kWidth), 0.0, 0.5 * kHeight);
  test_support::Random random(42);
  panorama::RenderViewOptions view_options;
  view_options.outside = {1, 2, 3};
  [[maybe_unused]] const std::int64_t resident_kib = of_process("status", "VmRSS:");
  for (int n = 0; n < requests; ++n) {
    panorama::Viewer viewer(map, 64, 36);
    const double azimuth_deg = random.uniform(-1e4, 1e4);
    viewer.look_at(azimuth_deg, random.uniform(-90.0, 90.0));
    viewer.set_fov(random.log_uniform(0.05, 120.0));
    view_options.threads = 1;
    const vpe::core::RgbImage image = panorama::render_view(*tiled_image, map, viewer.view(), view_options);
    for (const vpe::base::Rgb& p : image.pixels) {
      ASSERT_TRUE(p == view_options.outside || (p.r >= 100 && p.r <= 107 && p.g == p.r && p.b == p.r));
    }
    ASSERT_LE(tiled_image->bytes(), kBudget / 2);
  }
  EXPECT_GT(tiled_image->reads(), requests / 4);
  // What was read of pixels are tiles; 16 bytes tell where each of them is.
  EXPECT_LT(bytes_asked_for() - before, tiled_image->reads() * 210'000 + 2'000'000);
  if (!test_support::kIsSanitized) {
    EXPECT_LT(of_process("status", "VmHWM:") - resident_kib, static_cast<std::int64_t>(kBudget >> 10));
  }
}

TEST(BigImage, ViewsReadTheTilesThatTheyNeed) {
  const test_support::TempDir folder;
  panorama_test::SharedTiles::write(folder / "big.tif", kWidth, kHeight);
  view_panorama(folder / "big.tif", 200);
}

TEST(LongBigImage, TenThousandRandomViewsInBoundedMemory) {
  const test_support::TempDir folder;
  panorama_test::SharedTiles::write(folder / "big.tif", kWidth, kHeight);
  view_panorama(folder / "big.tif", 10'000);
}

// Every pixel of a view straight at a tile's middle is that tile's, drawn from the full image.
TEST(BigImage, TilesAreWhereTheyBelong) {
  const test_support::TempDir folder;
  panorama_test::SharedTiles::write(folder / "big.tif", kWidth, kHeight);
  const auto tiled_image = panorama::open_tiled_image(folder / "big.tif", panorama::ImageFileFormat::kTiff, {});
  const panorama::PanoramaMap map =
      panorama::equirectangular_map(kWidth, kHeight, static_cast<double>(kWidth), 0.0, 0.5 * kHeight);
  for (const auto& [column, row] : {std::pair(0, 39), {1, 40}, {390, 39}, {200, 20}, {13, 60}}) {
    // The last column of tiles is not whole: the full circle begins again behind it.
    const panorama::Direction middle =
        map.to_direction(std::min(256.0 * column + 128.0, kWidth - 80.0), 256.0 * row + 128.0);
    const vpe::core::View view = panorama::view_of(middle.azimuth_deg, middle.elevation_deg, 0.05, 16, 16);
    const auto grey = static_cast<std::uint8_t>(panorama_test::SharedTiles::grey(column, row));
    for (const vpe::base::Rgb& p : panorama::render_view(*tiled_image, map, view, {}).pixels)
      ASSERT_EQ(p, (vpe::base::Rgb{grey, grey, grey})) << column << "," << row;
  }
}

}  // namespace
