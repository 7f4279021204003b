#include "mars/raster/output/raster_file.h"

#include <cpl_string.h>
#include <gdal_priv.h>
#include <vrtdataset.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mars/raster/gdal/gdal_scope.h"

namespace mars {
namespace {

constexpr const char* kBlock = "512";
constexpr int kBlockRows = 512;
constexpr int kRowsOfTile = 16;  // TIFF tiles have multiples of them

GDALDataType gdal_type(BandType type) {
  switch (type) {
    case BandType::byte: return GDT_Byte;
    case BandType::int16: return GDT_Int16;
    case BandType::int32: return GDT_Int32;
    case BandType::float32: return GDT_Float32;
  }
  return GDT_Float32;
}

const char* predictor(BandType type) { return type == BandType::float32 ? "FLOATING_POINT" : "STANDARD"; }

GDALDriver& driver_of(const char* name) {
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName(name);
  if (driver == nullptr)
    throw SourceError(std::string("this GDAL has no driver ") + name + "; install all of GDAL");
  return *driver;
}

DatasetPointer owned(GDALDataset* dataset) {
  return {dataset, [](GDALDataset* d) {
            const GdalScope quiet;
            GDALClose(d);
          }};
}

SourceError cannot(const std::filesystem::path& path, const char* operation, const std::string& words) {
  return source_error(path.string(), operation, words,
                      "check the space on the disk and the rights of its folder");
}

void describe(GDALDataset& dataset, const RasterInfo& info) {
  std::array<double, 6> to_map = info.to_map;
  dataset.SetGeoTransform(to_map.data());
  OGRSpatialReference crs;
  crs.SetFromUserInput(info.wkt.c_str(), OGRSpatialReference::SET_FROM_USER_INPUT_LIMITATIONS_get());
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  dataset.SetSpatialRef(&crs);
  for (const auto& [key, value] : info.metadata) dataset.SetMetadataItem(key.c_str(), value.c_str());
  for (std::size_t i = 0; i < info.bands.size(); ++i) {
    GDALRasterBand* band = dataset.GetRasterBand(static_cast<int>(i) + 1);
    const BandInfo& own = info.bands[i];
    band->SetDescription(own.name.c_str());
    if (!own.unit.empty()) band->SetUnitType(own.unit.c_str());
    // Beside other bands they confuse the threads that compress: libtiff complains of ExtraSamples.
    constexpr std::array kColours{GCI_RedBand, GCI_GreenBand, GCI_BlueBand};
    if (info.bands.size() == kColours.size() && info.type == BandType::byte)
      band->SetColorInterpretation(kColours[i]);
    band->SetNoDataValue(info.nodata);
    for (const auto& [key, value] : own.metadata) band->SetMetadataItem(key.c_str(), value.c_str());
  }
}

}  // namespace

DatasetPointer make_plain_raster(const std::filesystem::path& path, const RasterInfo& info) {
  const GdalScope scope;
  CPLStringList options;
  options.SetNameValue("TILED", "YES");
  options.SetNameValue("BLOCKXSIZE", kBlock);
  // Such files live for a short time, and floats without a predictor hardly shrink.
  const int rows = std::min(kBlockRows, (info.rows + kRowsOfTile - 1) / kRowsOfTile * kRowsOfTile);
  options.SetNameValue("BLOCKYSIZE", std::to_string(rows).c_str());
  options.SetNameValue("INTERLEAVE", "BAND");
  options.SetNameValue("BIGTIFF", "IF_SAFER");
  DatasetPointer dataset = owned(driver_of("GTiff").Create(path.c_str(), info.columns, info.rows,
                                                           static_cast<int>(info.bands.size()),
                                                           gdal_type(info.type), options.List()));
  if (!dataset) throw cannot(path, "cannot be made", scope.message());
  describe(*dataset, info);
  return dataset;
}

void write_rows(GDALDataset& dataset, const RasterInfo& info, int band, int first_row,
                std::span<const float> values) {
  const GdalScope scope;
  const int rows = static_cast<int>(values.size() / static_cast<std::size_t>(info.columns));
  // GDAL rounds and clamps to integer types by itself, and takes NaN for 0.
  std::vector<float> copy;
  const float* data = values.data();
  if (info.type != BandType::float32) {
    copy.assign(values.begin(), values.end());
    std::ranges::replace_if(
        copy, [](float v) { return std::isnan(v); }, static_cast<float>(info.nodata));
    data = copy.data();
  }
  if (dataset.GetRasterBand(band + 1)->RasterIO(GF_Write, 0, first_row, info.columns, rows,
                                                const_cast<float*>(data), info.columns, rows, GDT_Float32, 0, 0,
                                                nullptr) != CE_None) {
    throw cannot(dataset.GetDescription(), "cannot be written", scope.message());
  }
}

void write_optimised(GDALDataset& dataset, const RasterInfo& info, const std::filesystem::path& path) {
  const GdalScope scope;
  CPLStringList options;
  options.SetNameValue("COMPRESS", "DEFLATE");
  options.SetNameValue("PREDICTOR", predictor(info.type));
  options.SetNameValue("OVERVIEW_PREDICTOR", predictor(info.type));
  options.SetNameValue("OVERVIEW_RESAMPLING", info.nearest_overviews ? "NEAREST" : "AVERAGE");
  options.SetNameValue("BLOCKSIZE", kBlock);
  options.SetNameValue("NUM_THREADS", "2");
  options.SetNameValue("BIGTIFF", "IF_SAFER");
  dataset.FlushCache(false);
  const DatasetPointer made =
      owned(driver_of("COG").CreateCopy(path.c_str(), &dataset, 0, options.List(), nullptr, nullptr));
  if (!made) throw cannot(path, "cannot be made", scope.message());
}

void close_raster(DatasetPointer dataset, const std::filesystem::path& path) {
  const GdalScope scope;
  dataset->FlushCache(true);
  const bool failed = CPLGetLastErrorType() >= CE_Failure;
  const std::string words = scope.message();
  dataset.reset();
  if (failed) throw cannot(path, "cannot be written", words);
}

DatasetPointer open_joined(std::span<const RasterStrip> strips, const RasterInfo& info) {
  const GdalScope scope;
  DatasetPointer joined = owned(driver_of("VRT").Create("", info.columns, info.rows, 0, GDT_Unknown, nullptr));
  if (!joined) throw SourceError("GDAL cannot make a virtual raster: " + scope.message());
  for (std::size_t i = 0; i < info.bands.size(); ++i) joined->AddBand(gdal_type(info.type), nullptr);
  describe(*joined, info);
  int top = 0;
  for (const RasterStrip& strip : strips) {
    for (std::size_t i = 0; i < info.bands.size(); ++i) {
      const int number = static_cast<int>(i) + 1;
      auto* band = static_cast<VRTSourcedRasterBand*>(joined->GetRasterBand(number));
      if (band->AddSimpleSource(strip.path.c_str(), number, 0, 0, info.columns, strip.rows, 0, top,
                                info.columns, strip.rows) != CE_None) {
        throw cannot(strip.path, "cannot be joined", scope.message());
      }
    }
    top += strip.rows;
  }
  return joined;
}

}  // namespace mars
