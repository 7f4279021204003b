// Images with a PDS3 label that the test writes.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

namespace test_support {

// Keywords of a label that say that a camera took the image in sunlight.
inline const std::string kCameraKeywords =
    "INSTRUMENT_NAME = \"CONTEXT CAMERA\"\r\nINSTRUMENT_ID = CTX\r\nINCIDENCE_ANGLE = 55.2 <DEG>\r\n";

// Writes NAME.lbl and NAME.img, an image of the whole of Mars whose label has these keywords outside of its objects. Returns
// the path of the label.
inline std::string write_labelled_image(const std::filesystem::path& folder, const std::string& name,
                                        const std::string& keywords) {
  constexpr int kColumns = 180;
  constexpr int kRows = 90;
  std::string data;
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      const int value = 300 + 2 * column + 5 * row + (column * column + row * row) % 97;
      data += static_cast<char>(value >> 8);
      data += static_cast<char>(value & 0xff);
    }
  }
  std::ofstream(folder / (name + ".img"), std::ios::binary) << data;
  std::ofstream(folder / (name + ".lbl"), std::ios::binary)
      << "PDS_VERSION_ID = PDS3\r\nRECORD_TYPE = FIXED_LENGTH\r\nRECORD_BYTES = 360\r\nFILE_RECORDS = 90\r\n"
         "^IMAGE = \"" +
             name + ".img\"\r\nTARGET_NAME = MARS\r\n" + keywords +
             "OBJECT = IMAGE\r\n  LINES = 90\r\n  LINE_SAMPLES = 180\r\n  SAMPLE_TYPE = MSB_INTEGER\r\n"
             "  SAMPLE_BITS = 16\r\nEND_OBJECT = IMAGE\r\n"
             "OBJECT = IMAGE_MAP_PROJECTION\r\n  MAP_PROJECTION_TYPE = \"SIMPLE CYLINDRICAL\"\r\n"
             "  COORDINATE_SYSTEM_NAME = \"PLANETOCENTRIC\"\r\n  POSITIVE_LONGITUDE_DIRECTION = \"EAST\"\r\n"
             "  A_AXIS_RADIUS = 3396.19 <KM>\r\n  B_AXIS_RADIUS = 3396.19 <KM>\r\n  C_AXIS_RADIUS = 3396.19 <KM>\r\n"
             "  CENTER_LATITUDE = 0.0 <DEGREE>\r\n  CENTER_LONGITUDE = 0.0 <DEGREE>\r\n"
             "  FIRST_STANDARD_PARALLEL = \"N/A\"\r\n  SECOND_STANDARD_PARALLEL = \"N/A\"\r\n"
             "  MAP_PROJECTION_ROTATION = 0.0\r\n  MAP_RESOLUTION = 0.5\r\n  MAP_SCALE = 118.55\r\n"
             "  MAXIMUM_LATITUDE = 90.0\r\n  LINE_PROJECTION_OFFSET = 45.5\r\n  SAMPLE_PROJECTION_OFFSET = 90.5\r\n"
             "END_OBJECT = IMAGE_MAP_PROJECTION\r\nEND\r\n";
  return (folder / (name + ".lbl")).string();
}

}  // namespace test_support
