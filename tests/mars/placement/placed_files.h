// Makes rasters that have no map but control points or an RPC.
#pragma once

#include <functional>
#include <glm/vec2.hpp>
#include <map>
#include <string>
#include <vector>

#include "mars/geodesy/sphere.h"
#include "tests/mars/source_files.h"

namespace placed_files {

struct Point {
  glm::dvec2 pixel{0};  // (0, 0) is the outer corner of the first pixel
  glm::dvec2 ground{0};
};

// Adds control points to a raster. `crs`: any text of GDAL, in which x comes first; empty: none.
void set_points(const std::string& path, const std::vector<Point>& points, const std::string& crs);

// Adds an RPC to a raster.
void set_rpc(const std::string& path, const std::map<std::string, std::string>& values);

// Returns a raster without a map whose values are the numbers of columns, or of rows.
source_files::Raster numbers(int width, int height, bool rows);

// Runs a program of GDAL with a line on its standard input. Returns what it writes; "" if it is not installed.
std::string run_tool(const std::string& command, const std::string& input);

}  // namespace placed_files
