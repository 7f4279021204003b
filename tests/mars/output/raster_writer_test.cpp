// Files of RasterWriter and of joined strips, read by GDAL.
#include "mars/raster/output/raster_writer.h"

#include <gdal_priv.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iterator>

#include "mars/raster/output/raster_strips.h"
#include "mars/sources/source.h"
#include "tests/support/support.h"

namespace {

namespace fs = std::filesystem;

constexpr int kColumns = 700;
constexpr int kRows = 530;

mars::RasterInfo info_of(mars::BandType type = mars::BandType::float32) {
  mars::RasterInfo info;
  info.columns = kColumns;
  info.rows = kRows;
  info.to_map = {1000, 50, 0, 2000, 0, -50};
  info.wkt = "IAU_2015:49910";
  info.type = type;
  info.nodata = type == mars::BandType::float32 ? std::nan("") : 0;
  info.bands = {{"elevation", "m", {{"meaning", "height"}}}, {"slope", "deg", {}}};
  info.metadata = {{"VPE_DATUM", "areoid"}, {"TIFFTAG_SOFTWARE", "vpe test"}};
  return info;
}

float value_at(int band, int column, int row) {
  if ((column + row) % 97 == 0) return std::nanf("");
  return static_cast<float>(1000 * band + 0.25 * column - 0.5 * row);
}

std::vector<float> rows_of(int band, int first, int count) {
  std::vector<float> out;
  for (int row = first; row < first + count; ++row) {
    for (int column = 0; column < kColumns; ++column) out.push_back(value_at(band, column, row));
  }
  return out;
}

std::vector<char> bytes_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class GdalFile {
 public:
  explicit GdalFile(const fs::path& path) {
    GDALAllRegister();
    file_.reset(GDALDataset::Open(path.c_str()));
  }
  GDALDataset& operator*() const { return *file_; }
  GDALDataset* operator->() const { return file_.get(); }
  explicit operator bool() const { return file_ != nullptr; }

 private:
  std::unique_ptr<GDALDataset> file_;
};

void expect_contents(const fs::path& path) {
  const GdalFile file(path);
  ASSERT_TRUE(static_cast<bool>(file)) << path;
  EXPECT_EQ(file->GetRasterXSize(), kColumns);
  EXPECT_EQ(file->GetRasterYSize(), kRows);
  std::array<double, 6> to_map{};
  file->GetGeoTransform(to_map.data());
  EXPECT_EQ(to_map, info_of().to_map);
  ASSERT_NE(file->GetSpatialRef(), nullptr);
  EXPECT_EQ(file->GetSpatialRef()->GetSemiMajor(), 3396190);
  EXPECT_STREQ(file->GetMetadataItem("VPE_DATUM"), "areoid");
  EXPECT_STREQ(file->GetMetadataItem("LAYOUT", "IMAGE_STRUCTURE"), "COG");
  ASSERT_EQ(file->GetRasterCount(), 2);
  for (int band = 1; band <= 2; ++band) {
    GDALRasterBand* own = file->GetRasterBand(band);
    EXPECT_STREQ(own->GetDescription(), band == 1 ? "elevation" : "slope");
    EXPECT_STREQ(own->GetUnitType(), band == 1 ? "m" : "deg");
    int has_nodata = 0;
    EXPECT_TRUE(std::isnan(own->GetNoDataValue(&has_nodata)));
    EXPECT_EQ(has_nodata, 1);
    EXPECT_GE(own->GetOverviewCount(), 1);
    std::vector<float> values(static_cast<std::size_t>(kColumns) * kRows);
    ASSERT_EQ(own->RasterIO(GF_Read, 0, 0, kColumns, kRows, values.data(), kColumns, kRows, GDT_Float32, 0, 0,
                            nullptr),
              CE_None);
    const std::vector<float> expected = rows_of(band - 1, 0, kRows);
    int wrong = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const bool same = std::isnan(expected[i]) ? std::isnan(values[i]) : values[i] == expected[i];
      wrong += same ? 0 : 1;
    }
    EXPECT_EQ(wrong, 0) << "band " << band;
  }
  EXPECT_STREQ(file->GetRasterBand(1)->GetMetadataItem("meaning"), "height");
}

TEST(RasterWriter, WritesWhatGdalReads) {
  const test_support::TempDir dir;
  mars::RasterWriter writer(dir / "a.tif", info_of());
  EXPECT_FALSE(fs::exists(dir / "a.tif"));
  for (const auto& [first, count] : {std::pair(0, 100), std::pair(100, 30), std::pair(130, 400)}) {
    for (int band = 0; band < 2; ++band) writer.write(band, first, rows_of(band, first, count));
  }
  EXPECT_FALSE(fs::exists(dir / "a.tif")) << "before it is complete";
  writer.finish();
  expect_contents(dir / "a.tif");
}

TEST(RasterWriter, AnUnfinishedFileLeavesNothing) {
  const test_support::TempDir dir;
  {
    mars::RasterWriter writer(dir / "a.tif", info_of());
    writer.write(0, 0, rows_of(0, 0, 10));
  }
  EXPECT_TRUE(fs::is_empty(dir.path()));
}

TEST(RasterWriter, PassesTheValidatorOfCloudOptimisedFiles) {
  if (std::system(
          "/usr/bin/python3 -c 'import osgeo_utils.samples.validate_cloud_optimized_geotiff' > /dev/null 2>&1") !=
      0)
    GTEST_SKIP() << "skipped: no validator of GDAL (python3-gdal)";
  const test_support::TempDir dir;
  for (const mars::BandType type : {mars::BandType::float32, mars::BandType::byte, mars::BandType::int16}) {
    mars::RasterWriter writer(dir / "a.tif", info_of(type));
    for (int band = 0; band < 2; ++band) writer.write(band, 0, rows_of(band, 0, kRows));
    writer.finish();
    const std::string command =
        "/usr/bin/python3 -m osgeo_utils.samples.validate_cloud_optimized_geotiff -q '" +
        (dir / "a.tif").string() + "' > /dev/null 2>&1";
    EXPECT_EQ(std::system(command.c_str()), 0) << "type " << static_cast<int>(type);
  }
}

TEST(RasterWriter, ValuesBeyondATypeAreItsEnds) {
  const test_support::TempDir dir;
  mars::RasterInfo info = info_of(mars::BandType::byte);
  info.columns = 5;
  info.rows = 1;
  info.bands = {{"grey", "", {}}};
  mars::RasterWriter writer(dir / "b.tif", info);
  writer.write(0, 0, std::vector<float>{-7, 300, 12.4F, 12.6F, std::nanf("")});
  writer.finish();
  const GdalFile file(dir / "b.tif");
  std::array<int, 5> values{};
  ASSERT_EQ(
      file->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, 5, 1, values.data(), 5, 1, GDT_Int32, 0, 0, nullptr),
      CE_None);
  EXPECT_EQ(values, (std::array{0, 255, 12, 13, 0}));
}

TEST(RasterWriter, SaysWhatIsWrongWithAFolder) {
  try {
    mars::RasterWriter writer("/nowhere/a.tif", info_of());
    FAIL() << "made a file in a folder that is not there";
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string(e.what()).find("/nowhere"), std::string::npos) << e.what();
  }
}

TEST(RasterStrips, JoinToTheBytesOfOneFile) {
  const test_support::TempDir dir;
  mars::RasterWriter writer(dir / "a.tif", info_of());
  for (int band = 0; band < 2; ++band) writer.write(band, 0, rows_of(band, 0, kRows));
  writer.finish();
  std::vector<mars::RasterStrip> strips;
  for (int first = 0; first < kRows; first += 128) {
    mars::RasterInfo info = info_of();
    info.rows = std::min(128, kRows - first);
    info.to_map[3] -= 50.0 * first;
    const fs::path path = dir / ("strip" + std::to_string(first) + ".tif");
    mars::write_strip(path, info, std::vector{rows_of(0, first, info.rows), rows_of(1, first, info.rows)});
    strips.push_back({path, info.rows});
  }
  mars::join_strips(dir / "b.tif", info_of(), strips);
  expect_contents(dir / "b.tif");
  EXPECT_EQ(bytes_of(dir / "b.tif"), bytes_of(dir / "a.tif"));
}

TEST(RasterStrips, AMissingStripIsAnError) {
  const test_support::TempDir dir;
  const std::vector<mars::RasterStrip> strips{{dir / "gone.tif", kRows}};
  EXPECT_THROW(mars::join_strips(dir / "b.tif", info_of(), strips), mars::SourceError);
  EXPECT_FALSE(fs::exists(dir / "b.tif"));
}

}  // namespace
