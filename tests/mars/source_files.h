// Small rasters made on the spot, so that tests know every pixel.
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
  std::optional<double> no_data;
  std::optional<double> scale;
  std::optional<double> offset;
  std::string unit;
  std::vector<GDALColorInterp> colours;
  std::vector<std::array<short, 4>> palette;
  std::string driver = "GTiff";
  std::vector<std::string> options;
  // Stored value of a pixel; band from 1.
  std::function<double(int band, int column, int row)> value = [](int, int, int) { return 0.0; };
};

// North-up geotransform of a box in the units of the CRS.
std::array<double, 6> box(double west, double north, double east, double south, int width, int height);

// Writes it; returns the path as a string.
std::string write(const std::filesystem::path& path, const Raster& raster);

void write_text(const std::filesystem::path& path, const std::string& text);

// One value of a source.
double height_at(const mars::ElevationSource& source, mars::LonLat place);

// what() of the SourceError that opening throws; empty when it opens.
std::string elevation_error(const std::string& path);

// Projection by PROJ itself, degrees to metres and back: an oracle that shares no code with GDAL's CRS classes.
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
