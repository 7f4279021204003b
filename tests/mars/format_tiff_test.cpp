// Nodata by masks, alpha bands and overviews of GeoTIFF and COG; extents beyond 360 degrees; every real file.
#include <cpl_conv.h>
#include <gdal_priv.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <memory>
#include <set>
#include <vector>

#include "mars/geodesy/sphere.h"
#include "mars/raster/gdal_raster.h"
#include "mars/sources/source.h"
#include "tests/mars/source_files.h"
#include "tests/support/support.h"

namespace {

using source_files::box;
using source_files::height_at;
using source_files::Raster;

constexpr int kSide = 600;  // more than two tiles

int value_of(int column, int row) { return 5 * column - 3 * row; }
bool is_nodata(int column, int row) { return (column / 37 + row / 23) % 3 == 0; }

std::unique_ptr<GDALDataset> open_to_change(const std::string& path) {
  return std::unique_ptr<GDALDataset>(GDALDataset::FromHandle(GDALOpen(path.c_str(), GA_Update)));
}

// A 60 x 60 degree DEM with a mask inside, made into a COG with overviews.
std::string masked_cog(const test_support::TempDir& folder) {
  Raster raster;
  raster.width = raster.height = kSide;
  raster.type = GDT_Int16;
  raster.geotransform = box(20, 40, 80, -20, kSide, kSide);
  raster.value = [](int, int column, int row) { return value_of(column, row); };
  const std::string plain = source_files::write(folder / "plain.tif", raster);
  CPLSetThreadLocalConfigOption("GDAL_TIFF_INTERNAL_MASK", "YES");
  {
    const auto dataset = open_to_change(plain);
    EXPECT_EQ(dataset->CreateMaskBand(GMF_PER_DATASET), CE_None);
    std::vector<unsigned char> line(kSide);
    for (int row = 0; row < kSide; ++row) {
      for (int column = 0; column < kSide; ++column) {
        line[static_cast<std::size_t>(column)] = is_nodata(column, row) ? 0 : 255;
      }
      EXPECT_EQ(dataset->GetRasterBand(1)->GetMaskBand()->RasterIO(GF_Write, 0, row, kSide, 1, line.data(),
                                                                   kSide, 1, GDT_Byte, 0, 0, nullptr),
                CE_None);
    }
  }
  CPLSetThreadLocalConfigOption("GDAL_TIFF_INTERNAL_MASK", nullptr);
  const auto dataset = open_to_change(plain);
  const char* const options[] = {"COMPRESS=DEFLATE", "BLOCKSIZE=128", "OVERVIEWS=IGNORE_EXISTING", nullptr};
  GDALDriver* cog = GetGDALDriverManager()->GetDriverByName("COG");
  std::string path = (folder / "cog.tif").string();
  GDALClose(cog->CreateCopy(path.c_str(), dataset.get(), FALSE, const_cast<char**>(options), nullptr, nullptr));
  return path;
}

TEST(Tiff, CogWithOverviewsAndAMaskBand) {
  const test_support::TempDir folder;
  const std::string path = masked_cog(folder);
  const mars::GdalRaster raster(path);
  {
    const auto dataset = raster.acquire();
    ASSERT_GE(dataset->GetRasterBand(1)->GetOverviewCount(), 1);
    ASSERT_EQ(dataset->GetRasterBand(1)->GetMaskFlags(), GMF_PER_DATASET);
  }
  const auto source = mars::open_elevation(path);
  const auto image = mars::open_image(path);
  int nodata = 0;
  for (int row = 3; row < kSide; row += 7) {
    for (int column = 1; column < kSide; column += 11) {
      const mars::LonLat place{20 + (column + 0.5) / 10, 40 - (row + 0.5) / 10};
      const double height_m = height_at(*source, place);
      ASSERT_EQ(std::isnan(height_m), is_nodata(column, row)) << column << " " << row;
      if (!is_nodata(column, row)) {
        EXPECT_NEAR(height_m, value_of(column, row), 1e-4);
      }
      const glm::dvec3 direction = mars::direction(place);
      vpe::base::Rgb colour;
      std::uint8_t alpha = 0;
      image->sample({&direction, 1}, 100, {&colour, 1}, {&alpha, 1});
      EXPECT_EQ(alpha > 128, !is_nodata(column, row));
      if (is_nodata(column, row)) ++nodata;
    }
  }
  EXPECT_GT(nodata, 1000);
}

TEST(Tiff, AlphaBandOfElevation) {
  const test_support::TempDir folder;
  Raster raster;
  raster.width = 8;
  raster.height = 6;
  raster.bands = 2;
  raster.type = GDT_UInt16;  // GDAL takes alpha in bytes and words only
  raster.geotransform = box(0, 6, 8, 0, 8, 6);
  raster.colours = {GCI_GrayIndex, GCI_AlphaBand};
  raster.options = {"ALPHA=YES"};
  raster.value = [](int band, int column, int row) {
    return band == 1 ? 10.0 * column + row : column == 3 && row == 2 ? 0.0 : 65535.0;
  };
  const auto source = mars::open_elevation(source_files::write(folder / "a.tif", raster));
  EXPECT_TRUE(std::isnan(height_at(*source, {3.5, 3.5})));
  EXPECT_NEAR(height_at(*source, {4.5, 3.5}), 42, 1e-6);
}

TEST(Tiff, GlobalMaskAppliesAtPolesAndSeam) {
  const test_support::TempDir folder;
  Raster raster;
  raster.width = 36;
  raster.height = 18;
  raster.geotransform = box(0, 90, 360, -90, 36, 18);
  raster.value = [](int, int, int row) { return row == 0 ? 500.0 : 20.0; };
  const std::string path = source_files::write(folder / "g.tif", raster);
  {
    const auto dataset = open_to_change(path);
    ASSERT_EQ(dataset->CreateMaskBand(GMF_PER_DATASET), CE_None);
    std::vector<unsigned char> mask(36 * 18, 255);
    std::fill_n(mask.begin(), 36, std::uint8_t{0});                 // the whole first row
    for (std::size_t row = 5; row < 12; ++row) mask[row * 36] = 0;  // and a part of the first column
    ASSERT_EQ(dataset->GetRasterBand(1)->GetMaskBand()->RasterIO(GF_Write, 0, 0, 36, 18, mask.data(), 36, 18,
                                                                 GDT_Byte, 0, 0, nullptr),
              CE_None);
  }
  const auto source = mars::open_elevation(path);
  EXPECT_TRUE(std::isnan(height_at(*source, {50, 90})));
  EXPECT_NEAR(height_at(*source, {50, -90}), 20, 1e-9);
  EXPECT_TRUE(std::isnan(height_at(*source, {5, 5})));
  EXPECT_TRUE(std::isnan(height_at(*source, {1, 5})));
  EXPECT_NEAR(height_at(*source, {-5, 5}), 20, 1e-9);
  EXPECT_NEAR(height_at(*source, {-1, 5}), 20, 1e-9);
}

TEST(Tiff, MoreThan360DegreesReadTheFirst360) {
  // 540 degrees, the second 360 with other values: the first decides where both have data, and there is no
  // nodata.
  const test_support::TempDir folder;
  Raster raster;
  raster.width = 54;
  raster.height = 18;
  raster.geotransform = box(-180, 90, 360, -90, 54, 18);
  raster.value = [](int, int column, int row) { return column < 36 ? column + 100.0 * row : -1e4; };
  const auto source = mars::open_elevation(source_files::write(folder / "m.tif", raster));
  for (int column = 0; column < 36; ++column) {
    EXPECT_NEAR(height_at(*source, {-175.0 + 10 * column, 5}), column + 800, 1e-4);
  }
}

TEST(RealFiles, EveryFileOpensOrExplainsWhatToDo) {
  VPE_NEED_SHARED(index, "INDEX.md");
  const std::set<std::string> rasters{".img", ".lbl", ".tif", ".vrt", ".cub", ".bin", ".jpg"};
  std::set<std::string> refused;
  int opened = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(index.parent_path())) {
    if (!entry.is_regular_file() || rasters.count(entry.path().extension().string()) == 0) continue;
    const std::string path = entry.path().string();
    try {
      const auto image = mars::open_image(path);
      EXPECT_GT(image->infos().at(0).resolution_m, 0) << path;
      ++opened;
      mars::open_elevation(path);
    } catch (const mars::SourceError& error) {
      const std::string words = error.what();
      EXPECT_EQ(words.find(path.substr(0, path.rfind('.'))), 0U) << words;
      EXPECT_NE(words.find("; "), std::string::npos) << words;
      if (words.find("colour image") == std::string::npos) refused.insert(entry.path().filename().string());
    }
  }
  EXPECT_GE(opened, 20);
  // Images that have no georeference, of which two come with a VRT that has it.
  for (const std::string& name : refused) EXPECT_EQ(std::filesystem::path(name).extension(), ".jpg") << name;
}

}  // namespace
