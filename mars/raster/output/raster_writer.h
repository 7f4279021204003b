// Writes rasters by blocks of rows into cloud-optimised GeoTIFF files.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace mars {

enum class BandType { byte, int16, int32, float32 };

// Describes a band. All bands of a file have one type.
struct BandInfo {
  std::string name;
  std::string unit;  // as "m", "deg"; empty: none
  std::map<std::string, std::string> metadata;
};

struct RasterInfo {
  int columns = 0;
  int rows = 0;
  std::array<double, 6> to_map{};  // GDAL's geotransform, of the corners of pixels
  std::string wkt;
  BandType type = BandType::float32;
  double nodata = 0;  // NaN is possible with float32
  std::vector<BandInfo> bands;
  std::map<std::string, std::string> metadata;
  bool nearest_overviews = false;  // classes and indices are not averaged
};

// Writes a file that appears under its name when it is complete. One thread uses it at a time.
class RasterWriter {
 public:
  // Throws SourceError.
  RasterWriter(std::filesystem::path path, RasterInfo info);
  // Removes what is unfinished.
  ~RasterWriter();
  RasterWriter(const RasterWriter&) = delete;
  RasterWriter& operator=(const RasterWriter&) = delete;

  // Writes whole rows of one band, counted from 0; values beyond the band's type are clamped. Throws SourceError.
  void write(int band, int first_row, std::span<const float> values);

  // Makes overviews, and the file in its final order. Throws SourceError.
  void finish();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace mars
