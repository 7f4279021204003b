// Every unusable raster gives one message that names the file, the failure and what to do.
#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "mars/geodesy/sphere.h"
#include "mars/sources/source.h"
#include "tests/mars/source_files.h"
#include "tests/support/support.h"

namespace {

namespace fs = std::filesystem;
using source_files::box;
using source_files::elevation_error;
using source_files::Raster;

Raster small() {
  Raster raster;
  raster.width = 4;
  raster.height = 4;
  raster.geotransform = box(0, 4, 4, 0, 4, 4);
  return raster;
}

void expect_words(const std::string& message, const std::vector<std::string>& words) {
  ASSERT_FALSE(message.empty()) << "no error";
  for (const std::string& word : words)
    EXPECT_NE(message.find(word), std::string::npos) << word << " not in: " << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

class SourceErrors : public ::testing::Test {
 protected:
  std::string file(const Raster& raster) const { return source_files::write(folder_ / "f.tif", raster); }
  std::string image_error(const std::string& path) const {
    try {
      mars::open_image(path);
    } catch (const mars::SourceError& error) {
      return error.what();
    }
    return {};
  }
  test_support::TempDir folder_;
};

TEST_F(SourceErrors, MissingFile) {
  const std::string path = (folder_ / "none.tif").string();
  expect_words(elevation_error(path), {path, "cannot open", "No such file", "check the name"});
  expect_words(image_error(path), {path, "No such file"});
  expect_words(elevation_error(""), {"cannot open"});
}

TEST_F(SourceErrors, NotARaster) {
  source_files::write_text(folder_ / "notes.txt", "nothing but words\n");
  const std::string path = (folder_ / "notes.txt").string();
  expect_words(elevation_error(path), {path, "cannot open as a raster", "not recognized", "gdalinfo"});
  source_files::write_text(folder_ / "empty.tif", "");
  expect_words(elevation_error((folder_ / "empty.tif").string()), {"empty.tif", "cannot open as a raster"});
  expect_words(elevation_error(folder_.path().string()), {folder_.path().string(), "cannot open as a raster"});
}

TEST_F(SourceErrors, NoGeoreference) {
  Raster raster = small();
  raster.geotransform.reset();
  expect_words(elevation_error(file(raster)), {"f.tif", "has no georeference", "gdal_translate -a_srs"});
  expect_words(image_error(file(raster)), {"f.tif", "has no georeference"});
}

TEST_F(SourceErrors, NoCoordinateSystem) {
  Raster raster = small();
  raster.crs.clear();
  expect_words(elevation_error(file(raster)), {"f.tif", "no coordinate system", "-a_srs"});
}

TEST_F(SourceErrors, CoordinateSystemThatIsOnNoPlanet) {
  Raster raster = small();
  raster.crs = "LOCAL_CS[\"workbench\",UNIT[\"metre\",1]]";
  expect_words(elevation_error(file(raster)),
               {"f.tif", "cannot transform its coordinate system", "workbench", "gdalwarp"});
}

TEST_F(SourceErrors, FlatGeotransform) {
  source_files::write_text(
      folder_ / "flat.vrt",
      "<VRTDataset rasterXSize=\"4\" rasterYSize=\"4\"><SRS>IAU_2015:49900</SRS>"
      "<GeoTransform>0,1,1,0,1,1</GeoTransform><VRTRasterBand dataType=\"Byte\" band=\"1\"/></VRTDataset>");
  expect_words(elevation_error((folder_ / "flat.vrt").string()), {"flat.vrt", "geotransform has no inverse"});
}

TEST_F(SourceErrors, OnlyParts) {
  // A netCDF file of two variables is a raster without bands.
  const std::string path = (folder_ / "two.nc").string();
  GDALAllRegister();
  {
    const auto dataset =
        std::unique_ptr<GDALDataset>(GetGDALDriverManager()->GetDriverByName("netCDF")->CreateMultiDimensional(
            path.c_str(), nullptr, nullptr));
    ASSERT_NE(dataset, nullptr);
    const auto root = dataset->GetRootGroup();
    const auto y = root->CreateDimension("y", "", "", 4, nullptr);
    const auto x = root->CreateDimension("x", "", "", 5, nullptr);
    for (const char* name : {"height", "count"}) {
      ASSERT_NE(root->CreateMDArray(name, {y, x}, GDALExtendedDataType::Create(GDT_Float32), nullptr), nullptr);
    }
  }
  expect_words(elevation_error(path), {"two.nc", "has no raster bands", "NETCDF:", "height"});
}

TEST_F(SourceErrors, ComplexNumbers) {
  Raster raster = small();
  raster.type = GDT_CFloat32;
  expect_words(elevation_error(file(raster)), {"f.tif", "complex numbers"});
}

TEST_F(SourceErrors, ColourGivenAsElevation) {
  Raster raster = small();
  raster.bands = 3;
  raster.type = GDT_Byte;
  raster.options = {"PHOTOMETRIC=RGB"};
  expect_words(elevation_error(file(raster)), {"f.tif", "colour image, not elevation", "--image"});
}

TEST_F(SourceErrors, NothingButNodata) {
  Raster raster = small();
  raster.value = [](int, int, int) { return std::numeric_limits<double>::quiet_NaN(); };
  expect_words(elevation_error(file(raster)), {"f.tif", "holds no elevation", "nodata"});
  raster.nodata = 7;
  raster.value = [](int, int, int) { return 7; };
  expect_words(elevation_error(file(raster)), {"f.tif", "holds no elevation"});
}

TEST_F(SourceErrors, OnePixelIsARaster) {
  Raster raster = small();
  raster.width = 1;
  raster.height = 1;
  raster.geotransform = box(0, 4, 1, 3, 1, 1);
  raster.value = [](int, int, int) { return 12; };
  const auto source = mars::open_elevation(file(raster));
  EXPECT_EQ(source_files::height_at(*source, {0.5, 3.5}), 12);
  EXPECT_EQ(source_files::height_at(*source, {0.01, 3.99}), 12);
}

TEST_F(SourceErrors, CutShort) {
  Raster raster = small();
  raster.width = 700;
  raster.height = 700;
  raster.geotransform = box(0, 70, 70, 0, 700, 700);
  raster.value = [](int, int column, int row) { return column * 0.37 + row * 0.11; };
  for (const char* compression : {"COMPRESS=NONE", "COMPRESS=DEFLATE"}) {
    raster.options = {compression};
    const std::string path = file(raster);
    fs::resize_file(path, fs::file_size(path) * 3 / 4);
    std::string message = elevation_error(path);
    if (message.empty()) {
      const auto source = mars::open_elevation(path);
      EXPECT_TRUE(std::isfinite(source_files::height_at(*source, {1, 69})));
      try {
        source_files::height_at(*source, {1, 1});
      } catch (const mars::SourceError& error) {
        message = error.what();
      }
    }
    expect_words(message, {path, "cut short"});
  }
}

TEST_F(SourceErrors, RawImageCutShort) {
  Raster raster = small();
  raster.width = 700;
  raster.height = 700;
  raster.driver = "ENVI";
  raster.geotransform = box(0, 70, 70, 0, 700, 700);
  raster.value = [](int, int column, int row) { return 1 + column + row; };
  const std::string path = source_files::write(folder_ / "raw.dat", raster);
  fs::resize_file(path, fs::file_size(path) / 2);
  expect_words(elevation_error(path), {"raw.dat", "is cut short", "980000 of 1960000 bytes"});
}

TEST_F(SourceErrors, WritesNothingToStderr) {
  ::testing::internal::CaptureStderr();
  source_files::write_text(folder_ / "bad.tif", "II*\0garbage that looks like a TIFF");
  elevation_error((folder_ / "bad.tif").string());
  Raster raster = small();
  raster.crs = "LOCAL_CS[\"workbench\",UNIT[\"metre\",1]]";
  const std::string path = source_files::write(folder_ / "l.tif", raster);
  elevation_error(path);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

}  // namespace
