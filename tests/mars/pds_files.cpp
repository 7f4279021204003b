#include "tests/mars/pds_files.h"

#include <cmath>

#include "tests/mars/source_files.h"

namespace pds_files {

std::string Label::text() const {
  std::string text = first + "\r\n";
  const auto add = [&](const std::map<std::string, std::string>& values, const char* indent) {
    for (const auto& [key, value] : values) text += indent + key + " = " + value + "\r\n";
  };
  add(file, "");
  text += "OBJECT = IMAGE\r\n";
  add(image, "  ");
  text += "END_OBJECT = IMAGE\r\n\r\nOBJECT = " + map_object + "\r\n";
  add(map, "  ");
  return text + "END_OBJECT = " + map_object + "\r\nEND\r\n";
}

Label label(const std::string& projection, int columns, int rows) {
  Label label;
  label.file = {{"RECORD_TYPE", "FIXED_LENGTH"},
                {"RECORD_BYTES", std::to_string(2 * columns)},
                {"FILE_RECORDS", std::to_string(rows)},
                {"TARGET_NAME", "MARS"}};
  label.image = {{"LINES", std::to_string(rows)},
                 {"LINE_SAMPLES", std::to_string(columns)},
                 {"SAMPLE_TYPE", "MSB_INTEGER"},
                 {"SAMPLE_BITS", "16"}};
  label.map = {{"MAP_PROJECTION_TYPE", "\"" + projection + "\""},
               {"COORDINATE_SYSTEM_NAME", "\"PLANETOCENTRIC\""},
               {"A_AXIS_RADIUS", "3396.0 <KM>"},
               {"B_AXIS_RADIUS", "3396.0 <KM>"},
               {"C_AXIS_RADIUS", "3396.0 <KM>"},
               {"POSITIVE_LONGITUDE_DIRECTION", "\"EAST\""},
               {"CENTER_LATITUDE", "0.0 <DEGREE>"},
               {"CENTER_LONGITUDE", "0.0 <DEGREE>"},
               {"FIRST_STANDARD_PARALLEL", "\"N/A\""},
               {"SECOND_STANDARD_PARALLEL", "\"N/A\""},
               {"MAP_PROJECTION_ROTATION", "0.0"}};
  return label;
}

std::string write(const std::filesystem::path& folder, const std::string& name, Label label,
                  const std::function<std::int64_t(int column, int row)>& value, bool big_endian) {
  const int columns = std::stoi(label.image.at("LINE_SAMPLES"));
  const int rows = std::stoi(label.image.at("LINES"));
  const int bytes = std::stoi(label.image.at("SAMPLE_BITS")) / 8;
  std::string data;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const auto bits = static_cast<std::uint64_t>(value(column, row));
      for (int i = 0; i < bytes; ++i) data += static_cast<char>(bits >> 8 * (big_endian ? bytes - 1 - i : i));
    }
  }
  label.file.emplace("^IMAGE", "\"" + name + ".img\"");
  source_files::write_text(folder / (name + ".img"), data);
  source_files::write_text(folder / (name + ".lbl"), label.text());
  return (folder / (name + ".lbl")).string();
}

glm::dvec2 pixel_of(const mars::GdalRaster& raster, mars::LonLat place) {
  const glm::dvec3 direction = mars::direction(place);
  glm::dvec2 pixel;
  raster.georeference().to_pixels({&direction, 1}, {&pixel, 1});
  if (raster.grid().period > 0) {
    pixel.x -= raster.grid().period * std::floor((pixel.x + 0.5) / raster.grid().period);
  }
  return pixel;
}

}  // namespace pds_files
