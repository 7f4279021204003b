#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <thread>

#include "mars/geodesy/sphere.h"
#include "mars/sources/source.h"
#include "tests/mars/source_files.h"
#include "tests/support/support.h"

namespace {

using source_files::box;
using source_files::Raster;

struct Seen {
  vpe::base::Rgb colour;
  int alpha = 0;
};

Seen look(const mars::ImageSource& image, mars::LonLat place, double texel_m) {
  const glm::dvec3 direction = mars::direction(place);
  Seen seen;
  std::uint8_t alpha = 0;
  image.sample({&direction, 1}, texel_m, {&seen.colour, 1}, {&alpha, 1});
  seen.alpha = alpha;
  return seen;
}

Raster patch(int bands, GDALDataType type) {
  Raster raster;
  raster.width = 4;
  raster.height = 4;
  raster.bands = bands;
  raster.type = type;
  raster.geotransform = box(0, 4, 4, 0, 4, 4);
  return raster;
}

double one_degree_m() { return mars::kMarsRadius_m * mars::kRadiansPerDegree; }

TEST(GdalImage, Colour) {
  const test_support::TempDir folder;
  Raster raster = patch(3, GDT_Byte);
  raster.options = {"PHOTOMETRIC=RGB"};
  raster.value = [](int band, int column, int row) { return 10 * column + row + 60 * band; };
  const auto image = mars::open_image(source_files::write(folder / "c.tif", raster));
  EXPECT_EQ(look(*image, {2.5, 2.5}, 1).colour, (vpe::base::Rgb{81, 141, 201}));
  EXPECT_EQ(look(*image, {3.0, 2.5}, 1).colour, (vpe::base::Rgb{86, 146, 206}));
  EXPECT_EQ(look(*image, {2.5, 2.5}, 1).alpha, 255);
  EXPECT_EQ(look(*image, {5, 2.5}, 1).alpha, 0);
  EXPECT_NEAR(image->infos().at(0).resolution_m, one_degree_m(), 1);
  EXPECT_NEAR(image->spacing_in({mars::direction({2, 2}), 0.001}), one_degree_m(), 1);
  EXPECT_TRUE(std::isinf(image->spacing_in({mars::direction({90, 2}), 0.001})));
}

TEST(GdalImage, BandsInAnotherOrder) {
  const test_support::TempDir folder;
  Raster raster = patch(3, GDT_Byte);
  raster.colours = {GCI_BlueBand, GCI_GreenBand, GCI_RedBand};
  raster.value = [](int band, int, int) { return 50 * band; };
  const auto image = mars::open_image(source_files::write(folder / "b.tif", raster));
  EXPECT_EQ(look(*image, {2, 2}, 1).colour, (vpe::base::Rgb{150, 100, 50}));
}

TEST(GdalImage, GreyAndGreyWithAlpha) {
  const test_support::TempDir folder;
  Raster raster = patch(1, GDT_Byte);
  raster.value = [](int, int column, int) { return 20 * column; };
  EXPECT_EQ(look(*mars::open_image(source_files::write(folder / "g.tif", raster)), {3.5, 1}, 1).colour,
            (vpe::base::Rgb{60, 60, 60}));
  raster = patch(2, GDT_Byte);
  raster.colours = {GCI_GrayIndex, GCI_AlphaBand};
  raster.value = [](int band, int column, int) { return band == 1 ? 20 * column : column < 2 ? 0 : 255; };
  const auto image = mars::open_image(source_files::write(folder / "a.tif", raster));
  EXPECT_EQ(look(*image, {0.5, 1.5}, 1).alpha, 0);
  EXPECT_EQ(look(*image, {2.5, 1.5}, 1).alpha, 255);
  // Beside the edge only what is visible counts.
  EXPECT_EQ(look(*image, {2.2, 1.5}, 1).colour, (vpe::base::Rgb{40, 40, 40}));
}

TEST(GdalImage, Palette) {
  const test_support::TempDir folder;
  Raster raster = patch(1, GDT_Byte);
  raster.palette = {{0, 0, 0, 255}, {200, 100, 50, 255}, {10, 20, 30, 255}};
  raster.value = [](int, int column, int) { return column < 2 ? 1 : 2; };
  const auto image = mars::open_image(source_files::write(folder / "p.tif", raster));
  EXPECT_EQ(look(*image, {1, 2}, 1).colour, (vpe::base::Rgb{200, 100, 50}));
  EXPECT_EQ(look(*image, {3, 2}, 1).colour, (vpe::base::Rgb{10, 20, 30}));
  EXPECT_EQ(look(*image, {2, 2}, 1).colour, (vpe::base::Rgb{105, 60, 40}));  // mixed as colours, not as numbers
  EXPECT_EQ(look(*image, {2, 2}, 4 * one_degree_m()).colour, (vpe::base::Rgb{105, 60, 40}));
}

TEST(GdalImage, NodataInAllBandsIsTransparent) {
  const test_support::TempDir folder;
  Raster raster = patch(3, GDT_Byte);
  raster.nodata = 0;
  raster.options = {"PHOTOMETRIC=RGB"};
  raster.value = [](int band, int column, int) { return column == 0 ? 0 : band == 1 ? 0 : 90; };
  const auto image = mars::open_image(source_files::write(folder / "n.tif", raster));
  EXPECT_EQ(look(*image, {0.5, 2.5}, 1).alpha, 0);
  EXPECT_EQ(look(*image, {2.5, 2.5}, 1).alpha, 255);
  EXPECT_EQ(look(*image, {2.5, 2.5}, 1).colour, (vpe::base::Rgb{0, 90, 90}));
}

TEST(GdalImage, WideValuesAreStretchedBetweenPercentiles) {
  const test_support::TempDir folder;
  for (const GDALDataType type : {GDT_UInt16, GDT_Int16, GDT_Float32}) {
    Raster raster = patch(1, type);
    raster.width = 100;
    raster.height = 100;
    raster.geotransform = box(0, 100 - 50, 100, -50, 100, 100);
    raster.nodata = 0;
    // 1000 .. 10999 in order, with the last ones (0.1 %) blown up and a hole.
    raster.value = [](int, int column, int row) {
      const int i = row * 100 + column;
      return i == 5000 ? 0.0 : i >= 9990 ? 30000.0 : 1000.0 + i;
    };
    const auto image = mars::open_image(source_files::write(folder / "w.tif", raster));
    const auto expected = [](double value) { return 255 * (value - 1050) / (10950 - 1050); };
    EXPECT_NEAR(look(*image, {30.5, 50 - 20.5}, 1).colour.r, expected(3030), 1.0) << type;
    EXPECT_NEAR(look(*image, {80.5, 50 - 80.5}, 1).colour.g, expected(9080), 1.0) << type;
    EXPECT_EQ(look(*image, {99.5, 50 - 99.5}, 1).colour.b, 255);
    EXPECT_EQ(look(*image, {0.5, 49.5}, 1).colour.b, 0);
    EXPECT_EQ(look(*image, {0.5, 50 - 50.5}, 1).alpha, 0);
  }
}

TEST(GdalImage, SignedBytesAreStretchedInTheirOrder) {
  const test_support::TempDir folder;
  Raster raster = patch(1, GDT_Byte);
  raster.options = {"PIXELTYPE=SIGNEDBYTE"};
  raster.nodata = -5;
  raster.value = [](int, int column, int row) {
    return (60 * column - 100 - (row == 3 ? 0 : 5) * row + 256) % 256;
  };
  const auto image = mars::open_image(source_files::write(folder / "s.tif", raster));
  for (const double lat : {0.5, 3.5}) {
    int before = -1;
    for (const double lon : {0.5, 1.5, 2.5, 3.5}) {
      EXPECT_GT(look(*image, {lon, lat}, 1).colour.r, before) << lon;
      before = look(*image, {lon, lat}, 1).colour.r;
    }
  }
}

TEST(GdalImage, AveragesOverTheTexel) {
  // A checkerboard of single pixels: any texel of some pixels is grey, at every phase.
  const test_support::TempDir folder;
  Raster raster = patch(1, GDT_Byte);
  raster.width = 1000;
  raster.height = 500;
  raster.geotransform = box(-180, 90, 180, -90, 1000, 500);
  raster.value = [](int, int column, int row) { return (column + row) % 2 == 0 ? 0 : 254; };
  const std::string path = source_files::write(folder / "k.tif", raster);
  const auto image = mars::open_image(path);
  const double pixel_m = image->infos().at(0).resolution_m;
  test_support::Random random(3);
  for (int i = 0; i < 500; ++i) {
    const mars::LonLat p{random.uniform(-180, 180), random.uniform(-80, 80)};
    for (const double texels : {2.0, 3.0, 4.0, 10.0, 60.0}) {
      EXPECT_NEAR(look(*image, p, texels * pixel_m).colour.r, 127, 2) << texels;
    }
  }
  EXPECT_EQ(look(*image, {-180 + 0.18, 90 - 0.36 * 100.5}, pixel_m).colour.r, 0);
  EXPECT_EQ(look(*image, {-180 + 0.54, 90 - 0.36 * 100.5}, pixel_m).colour.r, 254);
}

TEST(GdalImage, IsSeamlessAndRoundThePoleAtEveryLevel) {
  const test_support::TempDir folder;
  Raster raster = patch(1, GDT_Byte);
  raster.width = 720;
  raster.height = 360;
  raster.geotransform = box(0, 90, 360, -90, 720, 360);
  raster.value = [](int, int column, int row) {
    return 128 + 100 * std::cos(2 * mars::kPi * (column + 0.5) / 720) * std::sin(mars::kPi * (row + 0.5) / 360);
  };
  const auto image = mars::open_image(source_files::write(folder / "s.tif", raster));
  const double pixel_m = image->infos().at(0).resolution_m;
  for (const double texels : {1.0, 4.0, 16.0, 64.0, 300.0}) {
    for (double lat = -88; lat <= 88; lat += 11) {
      EXPECT_NEAR(look(*image, {-1e-7, lat}, texels * pixel_m).colour.r,
                  look(*image, {1e-7, lat}, texels * pixel_m).colour.r, 1);
      EXPECT_EQ(look(*image, {180, lat}, texels * pixel_m).colour,
                look(*image, {-180, lat}, texels * pixel_m).colour);
    }
    const vpe::base::Rgb pole = look(*image, {0, 90}, texels * pixel_m).colour;
    for (int lon = 0; lon < 360; lon += 45) {
      EXPECT_NEAR(look(*image, {static_cast<double>(lon), 90 - 1e-7}, texels * pixel_m).colour.r, pole.r, 1);
      EXPECT_EQ(look(*image, {static_cast<double>(lon), 90}, texels * pixel_m).alpha, 255);
    }
  }
  // The coarsest levels still distinguish east and west.
  EXPECT_GT(look(*image, {0, 0}, 32 * pixel_m).colour.r, 200);
  EXPECT_LT(look(*image, {180, 0}, 32 * pixel_m).colour.r, 60);
}

TEST(GdalImage, UsesOverviewsThatFit) {
  // The overview was painted over: only one that is read can show it.
  const test_support::TempDir folder;
  Raster raster = patch(1, GDT_Byte);
  raster.width = 600;
  raster.height = 600;
  raster.geotransform = box(0, 60, 60, 0, 600, 600);
  raster.value = [](int, int, int) { return 40; };
  const std::string path = source_files::write(folder / "o.tif", raster);
  GDALDatasetH dataset = GDALOpen(path.c_str(), GA_Update);
  int factor = 4;
  ASSERT_EQ(GDALBuildOverviews(dataset, "AVERAGE", 1, &factor, 0, nullptr, nullptr, nullptr), CE_None);
  GDALRasterBandH overview = GDALGetOverview(GDALGetRasterBand(dataset, 1), 0);
  std::vector<unsigned char> paint(150 * 150, 200);
  ASSERT_EQ(GDALRasterIO(overview, GF_Write, 0, 0, 150, 150, paint.data(), 150, 150, GDT_Byte, 0, 0), CE_None);
  GDALClose(dataset);
  const auto image = mars::open_image(path);
  const double pixel_m = image->infos().at(0).resolution_m;
  EXPECT_EQ(look(*image, {30, 30}, 2 * pixel_m).colour.r, 40);
  EXPECT_EQ(look(*image, {30, 30}, 4 * pixel_m).colour.r, 200);
  EXPECT_EQ(look(*image, {30, 30}, 32 * pixel_m).colour.r, 200);
}

TEST(GdalImage, ThreadsGetTheSameColours) {
  const test_support::TempDir folder;
  Raster raster = patch(3, GDT_Byte);
  raster.width = 900;
  raster.height = 700;
  raster.options = {"COMPRESS=DEFLATE", "PHOTOMETRIC=RGB"};
  raster.geotransform = box(-180, 90, 180, -90, 900, 700);
  raster.value = [](int band, int column, int row) { return (column * 7 * band + row * 13) % 256; };
  const std::string path = source_files::write(folder / "t.tif", raster);
  test_support::Random random(9);
  std::vector<glm::dvec3> directions;
  for (int i = 0; i < 4000; ++i) directions.push_back(random.direction());
  const auto one = mars::open_image(path);
  const auto many = mars::open_image(path);
  const double texel_m = 5 * one->infos().at(0).resolution_m;
  std::vector<vpe::base::Rgb> expected(directions.size());
  std::vector<std::uint8_t> alpha(directions.size());
  one->sample(directions, texel_m, expected, alpha);
  std::vector<std::vector<vpe::base::Rgb>> results(8, std::vector<vpe::base::Rgb>(directions.size()));
  std::vector<std::thread> threads;
  for (auto& result : results) {
    threads.emplace_back([&] {
      std::vector<std::uint8_t> own(directions.size());
      many->sample(directions, texel_m, result, own);
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const auto& result : results) EXPECT_EQ(result, expected);
}

}  // namespace
