#include "tests/mars/placement/placed_files.h"

#include <cpl_conv.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <array>
#include <cstdio>
#include <stdexcept>

namespace placed_files {
namespace {

GDALDataset* open_to_change(const std::string& path) {
  auto* dataset = GDALDataset::FromHandle(GDALOpen(path.c_str(), GA_Update));
  if (dataset == nullptr) throw std::runtime_error("cannot change " + path);
  return dataset;
}

}  // namespace

void set_points(const std::string& path, const std::vector<Point>& points, const std::string& crs) {
  GDALDataset* dataset = open_to_change(path);
  std::vector<std::string> names;
  for (std::size_t i = 0; i < points.size(); ++i) names.push_back("P" + std::to_string(i + 1));
  std::vector<GDAL_GCP> gcps;
  for (std::size_t i = 0; i < points.size(); ++i) {
    gcps.push_back({names[i].data(), const_cast<char*>(""), points[i].pixel.x, points[i].pixel.y,
                    points[i].ground.x, points[i].ground.y, 0});
  }
  OGRSpatialReference system;
  if (!crs.empty() && system.SetFromUserInput(crs.c_str()) != OGRERR_NONE)
    throw std::runtime_error("bad CRS " + crs);
  system.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  dataset->SetGCPs(static_cast<int>(gcps.size()), gcps.data(), crs.empty() ? nullptr : &system);
  GDALClose(dataset);
}

void set_rpc(const std::string& path, const std::map<std::string, std::string>& values) {
  GDALDataset* dataset = open_to_change(path);
  for (const auto& [key, value] : values) dataset->SetMetadataItem(key.c_str(), value.c_str(), "RPC");
  GDALClose(dataset);
}

source_files::Raster numbers(int width, int height, bool rows) {
  source_files::Raster raster;
  raster.width = width;
  raster.height = height;
  raster.crs.clear();
  raster.value = [rows](int, int column, int row) { return rows ? row : column; };
  return raster;
}

std::string run_tool(const std::string& command, const std::string& input) {
  const std::string line = "printf '" + input + "\\n' | " + command + " 2>/dev/null";
  FILE* pipe = popen(line.c_str(), "r");
  if (pipe == nullptr) return "";
  std::string text;
  std::array<char, 256> buffer{};
  while (std::fgets(buffer.data(), static_cast<int>(buffer.size()), pipe) != nullptr) text += buffer.data();
  return pclose(pipe) == 0 ? text : "";
}

}  // namespace placed_files
