// Makes small rasters whose every pixel is known to the test.
#pragma once

#include <gdal.h>

#include <array>
#include <filesystem>
#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>

#include "mars/geodesy/sphere.h"
#include "mars/sources/source.h"

namespace source_files {

inline const std::string kSphere = "+proj=longlat +R=3396190 +no_defs";

struct Raster {
  int width = 0;
  int height = 0;
  int bands = 1;
  GDALDataType type = GDT_Float32;
  std::string crs = kSphere;  // anything SetFromUserInput takes; empty = none
  std::optional<std::array<double, 6>> geotransform;
  std::optional<double> nodata;
  std::optional<double> scale;
  std::optional<double> offset;
  std::string unit;
  std::vector<GDALColorInterp> colours;
  std::vector<std::array<short, 4>> palette;
  std::string driver = "GTiff";
  std::vector<std::string> options;
  // Returns the stored value of a pixel; bands count from 1.
  std::function<double(int band, int column, int row)> value = [](int, int, int) { return 0.0; };
};

// Returns the north-up geotransform of a box in the units of the CRS.
std::array<double, 6> box(double west, double north, double east, double south, int width, int height);

// Writes a raster. Returns the path as a string.
std::string write(const std::filesystem::path& path, const Raster& raster);

void write_text(const std::filesystem::path& path, const std::string& text);

// Returns one value of a source.
double height_at(const mars::ElevationSource& source, mars::LonLat place);

// Returns what() of the SourceError that opening throws, or "" if the raster opens.
std::string elevation_error(const std::string& path);

// Projects with PROJ, degrees to metres and back: an oracle that shares no code with GDAL's CRS classes.
class Proj {
 public:
  explicit Proj(const std::string& definition);
  ~Proj();
  Proj(const Proj&) = delete;
  Proj& operator=(const Proj&) = delete;
  glm::dvec2 forward(mars::LonLat place) const;
  mars::LonLat inverse(const glm::dvec2& map) const;

 private:
  void* context_;
  void* transformation_;
};

}  // namespace source_files
