#include "panorama/page/page_layers.h"

#include <cmath>
#include <limits>

#include "tests/panorama/page/page_fixture.h"

namespace {

using panorama::PackedBand;
using panorama::PageBand;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// Returns what panorama/page/web/planes.js makes of a band.
std::vector<double> unpacked(const PackedBand& packed, bool is_log, std::size_t count) {
  std::vector<double> values(count, kNan);
  for (std::size_t n = 0; n < count && packed.bytes > 0; ++n) {
    double number = 0;
    for (int k = packed.bytes - 1; k >= 0; --k)
      number =
          number * 256 + packed.data[n * static_cast<std::size_t>(packed.bytes) + static_cast<std::size_t>(k)];
    if (number == 0) continue;
    const double value = packed.offset + packed.step * (number - 1);
    values[n] = is_log ? std::exp(value) : value;
  }
  return values;
}

void expect_within(const std::vector<double>& values, const PageBand& band, int bytes) {
  const PackedBand packed = panorama::pack_band(values, band);
  EXPECT_EQ(packed.bytes, bytes) << band.name;
  const auto back = unpacked(packed, band.is_log, values.size());
  for (std::size_t n = 0; n < values.size(); ++n) {
    const bool is_none = !std::isfinite(values[n]) || (band.is_log && values[n] <= 0);
    ASSERT_EQ(std::isnan(back[n]), is_none) << n;
    if (is_none) continue;
    const double most = 0.5 * packed.step * (1 + 1e-9);
    if (band.is_log) {
      ASSERT_NEAR(std::log(back[n]), std::log(values[n]), most);
    } else {
      ASSERT_NEAR(back[n], values[n], most + 1e-9 * std::abs(values[n]));
    }
  }
}

TEST(PageLayers, ValuesComeBackWithinHalfAStep) {
  test_support::Random random(8);
  const auto drawn = [&](double low, double high) {
    std::vector<double> values{kNan, low, high, std::numeric_limits<double>::infinity()};
    for (int n = 0; n < 5000; ++n) values.push_back(random.uniform(low, high));
    return values;
  };
  expect_within(drawn(2, 500000), {"range_m", 2e-4, true}, 2);
  expect_within(drawn(-4500.0, -4498.0), {"elevation_m", 0.02, false}, 1);
  expect_within(drawn(-4500.0, -3500.0), {"elevation_m", 0.02, false}, 2);
  expect_within(drawn(-8000, 21000), {"elevation_m", 0.02, false}, 3);
  expect_within(drawn(-180, 180), {"lon_deg", 2e-7, false}, 4);
  expect_within(drawn(1, 3), {"other", 0, false}, 3);
  expect_within({0, 1, kNan, 1}, {"synthetic", 1, false}, 1);
  expect_within({7, 7}, {"other", 0, false}, 1);
  expect_within({-1, 0, 5}, {"range_m", 2e-4, true}, 1);
  expect_within(drawn(-1e12, 1e12), {"elevation_m", 0.02, false}, 6);
  expect_within(drawn(-1e18, 1e18), {"elevation_m", 0.02, false}, 6);
  EXPECT_EQ(panorama::pack_band(std::vector<double>{kNan, kNan}, {"x", 1, false}).bytes, 0);
  EXPECT_EQ(panorama::pack_band({}, {"x", 1, false}).bytes, 0);
}

TEST(PageLayers, TilesHoldTheLayersOfThePanorama) {
  const test_support::TempDir folder;
  const page_test::Opened opened(page_test::write_sample(folder.path()));
  for (const int step : {1, 3}) {
    const panorama::PageLayers layers = panorama::layers_of(opened.description, step);
    ASSERT_EQ(layers.bands.size(), 3U);
    EXPECT_EQ(layers.bands[0].name, "lon_deg");
    EXPECT_EQ(layers.bands[2].name, "range_m");
    const panorama::LayerPacker packer(opened.description, layers);
    for (std::int64_t row = 0; row < layers.rows(); ++row) {
      for (std::int64_t column = 0; column < layers.columns(); ++column) {
        const auto json = page_test::json_in(packer.tile_script(column, row), ",", ");");
        const std::int64_t width_px = std::min<std::int64_t>(256, layers.width_px - 256 * column);
        const std::int64_t height_px = std::min<std::int64_t>(256, layers.height_px - 256 * row);
        const auto values = [&](const char* name) {
          const auto& band = json.at(name);
          const PackedBand packed{band.at("bytes"), band.at("offset"), band.at("scale"),
                                  page_test::from_base64(band.at("data").get<std::string>())};
          return unpacked(packed, band.at("log"), static_cast<std::size_t>(width_px * height_px));
        };
        const auto ranges = values("range_m");
        const auto lons = values("lon_deg");
        for (std::int64_t n = 0; n < width_px * height_px; ++n) {
          const std::int64_t x = (column * 256 + n % width_px) * step + step / 2;
          const std::int64_t y = (row * 256 + n / width_px) * step + step / 2;
          const auto k = static_cast<std::size_t>(n);
          ASSERT_EQ(std::isnan(ranges[k]), page_test::is_sky(y));
          if (page_test::is_sky(y)) continue;
          const double range_m = double{page_test::range_at(x, y)};
          ASSERT_NEAR(ranges[k], range_m, 1.001e-4 * range_m) << x << "," << y;
          ASSERT_NEAR(lons[k], page_test::lon_at(x, y), 1.001e-7);
        }
      }
    }
  }
}

TEST(PageLayers, LargePanoramasAreThinned) {
  panorama::PanoramaDescription description;
  description.map = panorama::cylinder_map(60000, 17196, 60000, 0, 9000);
  const panorama::PageLayers layers = panorama::layers_of(description, 0);
  EXPECT_EQ(layers.step, 8);
  EXPECT_LE(layers.width_px * layers.height_px, panorama::kMostLayerPixels);
  EXPECT_TRUE(layers.bands.empty());
  EXPECT_EQ(panorama::layers_of(description, 1).width_px, 60000);
}

}  // namespace
