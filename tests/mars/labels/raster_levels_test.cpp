// Rasters whose bands are the levels of a volume: order, types, nodata, raw files with a header, limits, bad input.
#include "mars/raster/raster_levels.h"

#include <gdal_priv.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <vector>

#include "mars/raster/gdal/gdal_scope.h"
#include "mars/sources/source.h"
#include "tests/support/support.h"

namespace {

constexpr mars::RasterLevelsLimits kLimits{.side = 64, .values = 10000};

// The value at a column, at a row from the south, and at a level.
double value_at(int x, int y, int z) { return 1 + x + 10 * y + 100 * z; }

class RasterLevels : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const char* driver, int width, int height, int levels,
                    GDALDataType type, double nodata = NAN) const {
    const mars::GdalScope scope;
    const std::string path = (folder_ / name).string();
    GDALDataset* const made = GetGDALDriverManager()->GetDriverByName(driver)->Create(
        path.c_str(), width, height, levels, type, nullptr);
    for (int z = 0; z < levels; ++z) {
      for (int y = 0; y < height; ++y) {
        std::vector<double> row;
        for (int x = 0; x < width; ++x) row.push_back(value_at(x, height - 1 - y, z));
        EXPECT_EQ(made->GetRasterBand(z + 1)->RasterIO(GF_Write, 0, y, width, 1, row.data(), width, 1,
                                                       GDT_Float64, 0, 0),
                  CE_None);
      }
      if (!std::isnan(nodata)) made->GetRasterBand(z + 1)->SetNoDataValue(nodata);
    }
    GDALClose(made);
    return path;
  }

  static void expect_values(const mars::RasterLevels& cube, int width, int height, int levels,
                            double empty = NAN) {
    ASSERT_EQ(cube.width, width);
    ASSERT_EQ(cube.height, height);
    ASSERT_EQ(cube.levels, levels);
    ASSERT_EQ(cube.values.size(), static_cast<std::size_t>(width * height * levels));
    for (int z = 0; z < levels; ++z)
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
          const double value = value_at(x, y, z);
          EXPECT_EQ(cube.values[static_cast<std::size_t>((z * height + y) * width + x)],
                    value == empty ? 0 : value);
        }
  }

  test_support::TempDir folder_;
};

TEST_F(RasterLevels, AreReadFromTheLowestBandAndFromSouth) {
  for (const GDALDataType type : {GDT_Float32, GDT_Float64, GDT_UInt16, GDT_Int32}) {
    const std::string path = write("cube.tif", "GTiff", 7, 5, 4, type);
    expect_values(mars::read_raster_levels(path, kLimits), 7, 5, 4);
  }
  // A raw file of bytes with a header of text.
  expect_values(mars::read_raster_levels(write("cube.img", "ENVI", 6, 4, 3, GDT_UInt16), kLimits), 6, 4, 3);
}

TEST_F(RasterLevels, RawBytesAreReadThroughAVirtualRaster) {
  std::ofstream raw(folder_ / "cube.raw", std::ios::binary);
  for (int z = 0; z < 2; ++z)
    for (int y = 2; y >= 0; --y)
      for (int x = 0; x < 4; ++x) raw.put(static_cast<char>(static_cast<unsigned char>(value_at(x, y, z))));
  raw.close();
  std::string text = "<VRTDataset rasterXSize=\"4\" rasterYSize=\"3\">";
  for (int z = 0; z < 2; ++z)
    text += "<VRTRasterBand dataType=\"Byte\" band=\"" + std::to_string(z + 1) +
            "\" subClass=\"VRTRawRasterBand\"><SourceFilename relativetoVRT=\"1\">cube.raw</SourceFilename>"
            "<ImageOffset>" +
            std::to_string(12 * z) + "</ImageOffset></VRTRasterBand>";
  std::ofstream(folder_ / "cube.vrt") << text << "</VRTDataset>";
  expect_values(mars::read_raster_levels((folder_ / "cube.vrt").string(), kLimits), 4, 3, 2);
}

TEST_F(RasterLevels, NodataAndWhatIsNotFiniteIsNothing) {
  const std::string path = write("cube.tif", "GTiff", 5, 3, 2, GDT_Float32, value_at(2, 1, 1));
  expect_values(mars::read_raster_levels(path, kLimits), 5, 3, 2, value_at(2, 1, 1));
  {
    const mars::GdalScope scope;
    auto* const dataset = static_cast<GDALDataset*>(GDALOpen(path.c_str(), GA_Update));
    ASSERT_NE(dataset, nullptr);
    std::vector<double> row{NAN, INFINITY, -INFINITY};
    EXPECT_EQ(dataset->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, 3, 1, row.data(), 3, 1, GDT_Float64, 0, 0),
              CE_None);
    GDALClose(dataset);
  }
  const mars::RasterLevels cube = mars::read_raster_levels(path, kLimits);
  for (std::size_t x = 0; x < 3; ++x) EXPECT_EQ(cube.values[10 + x], 0);
}

TEST_F(RasterLevels, WhatIsNoVolumeIsRefusedBeforeItIsRead) {
  const auto error_of = [](const std::string& path, const mars::RasterLevelsLimits& limits) -> std::string {
    try {
      mars::read_raster_levels(path, limits);
    } catch (const mars::SourceError& error) {
      return error.what();
    }
    return "";
  };
  const std::string flat = write("flat.tif", "GTiff", 5, 3, 1, GDT_Byte);
  EXPECT_NE(error_of(flat, kLimits).find("5 x 3 pixels in 1 band"), std::string::npos)
      << error_of(flat, kLimits);
  const std::string cube = write("cube.tif", "GTiff", 9, 3, 4, GDT_Byte);
  EXPECT_EQ(error_of(cube, {.side = 9, .values = 108}), "");
  EXPECT_NE(error_of(cube, {.side = 8, .values = 108}).find("at most 8 each way"), std::string::npos);
  EXPECT_NE(error_of(cube, {.side = 9, .values = 107}).find("107 in all"), std::string::npos);
  EXPECT_NE(error_of((folder_ / "none.tif").string(), kLimits).find("none.tif"), std::string::npos);
  std::ofstream(folder_ / "text.tif") << "no raster";
  EXPECT_NE(error_of((folder_ / "text.tif").string(), kLimits), "");
  // A file that ends early.
  std::filesystem::resize_file(cube, std::filesystem::file_size(cube) / 2);
  EXPECT_NE(error_of(cube, kLimits), "");
}

}  // namespace
