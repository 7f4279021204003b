// Makes PDS3 labels and raw images for tests.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/vec2.hpp>
#include <map>
#include <string>

#include "mars/geodesy/sphere.h"
#include "mars/raster/gdal_raster.h"

namespace pds_files {

// Holds the keywords of a label. Those of `image` and `map` go into the objects of these names. Values are
// written as given, including quotes and units. Lines end with CR LF.
struct Label {
  std::string first = "PDS_VERSION_ID = PDS3";
  std::map<std::string, std::string> file;
  std::map<std::string, std::string> image;
  std::map<std::string, std::string> map;
  std::string map_object = "IMAGE_MAP_PROJECTION";

  std::string text() const;
};

// Returns a 16-bit map of Mars by MOLA's conventions, SAMPLE_TYPE MSB_INTEGER, with the keywords that all
// projections need.
Label label(const std::string& projection, int columns, int rows);

// Writes NAME.lbl and NAME.img (the values, row by row, as `bits` big-endian or little-endian integers);
// returns the path of the label.
std::string write(const std::filesystem::path& folder, const std::string& name, Label label,
                  const std::function<std::int64_t(int column, int row)>& value, bool big_endian = true);

// Returns the position of a planetocentric place in the raster, in the 360 degrees that begin at its first
// column.
glm::dvec2 pixel_of(const mars::GdalRaster& raster, mars::LonLat place);

}  // namespace pds_files
