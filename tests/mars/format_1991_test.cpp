// Raw images that only their label describes: the Viking maps of 1991, and PDS3 images that GDAL misreads.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <sstream>

#include "mars/geodesy/sphere.h"
#include "mars/raster/gdal_raster.h"
#include "mars/raster/pds_image.h"
#include "mars/raster/pds_map.h"
#include "mars/sources/source.h"
#include "tests/mars/pds_files.h"
#include "tests/mars/source_files.h"
#include "tests/support/support.h"

namespace {

namespace fs = std::filesystem;
using pds_files::Label;

constexpr char kSfdu[] = "CCSD3ZF0000100000001NJPL3IF0PDS200000001 = SFDU_LABEL";
constexpr double kRadian = mars::kRadiansPerDegree;
constexpr double kAxes = 3375.73 / 3393.40;

double centric(double graphic_deg) {
  return std::atan(std::tan(graphic_deg * kRadian) * kAxes * kAxes) / kRadian;
}

// The numbers of the archive's label of MG30S317, but for the number of lines and samples.
Label mdim() {
  Label label;
  label.first = kSfdu;
  label.file = {{"RECORD_TYPE", "FIXED_LENGTH"},
                {"RECORD_BYTES", "284"},
                {"DATA_SET_ID", "\"VO1/VO2-M-VIS-5-DIM-V1.0\""},
                {"SPACECRAFT_NAME", "{VIKING_ORBITER_1,\r\n VIKING_ORBITER_2}"},
                {"TARGET_NAME", "MARS"}};
  label.image = {{"LINES", "320"},
                 {"LINE_SAMPLES", "284"},
                 {"SAMPLE_TYPE", "UNSIGNED_INTEGER"},
                 {"SAMPLE_BITS", "8"},
                 {"SAMPLE_BIT_MASK", "2#11111111#"}};
  label.map_object = "IMAGE_MAP_PROJECTION_CATALOG";
  label.map = {{"MAP_PROJECTION_TYPE", "SINUSOIDAL"},
               {"MAP_RESOLUTION", "64<PIXEL/DEG>"},
               {"MAP_SCALE", "0.925406<KM/PIXEL>"},
               {"MAXIMUM_LATITUDE", "-27.50000"},
               {"MINIMUM_LATITUDE", "-32.50000"},
               {"MAXIMUM_LONGITUDE", "320.00000"},
               {"MINIMUM_LONGITUDE", "314.99725"},
               {"X_AXIS_PROJECTION_OFFSET", "-1760.000"},
               {"Y_AXIS_PROJECTION_OFFSET", "141.922"},
               {"A_AXIS_RADIUS", "3393.40"},
               {"B_AXIS_RADIUS", "3393.40"},
               {"C_AXIS_RADIUS", "3375.73"},
               {"POSITIVE_LONGITUDE_DIRECTION", "WEST"},
               {"CENTER_LATITUDE", "0.00000"},
               {"CENTER_LONGITUDE", "317.50000"}};
  return label;
}

int grey(int column, int row) { return 1 + (3 * column + 7 * row) % 250; }

// Where a place given as the label counts it must lie, by the archive's equation without its INT: pixel i of
// the raster (from 0) covers i to i + 1 of the coordinate.
glm::dvec2 by_equation(double graphic_lat, double west_lon, double edge) {
  const double x = -1760.0 - graphic_lat * 64;
  const double y = 141.922 - (west_lon - 317.5) * 64 * std::cos(graphic_lat * kRadian);
  return {y - edge - 0.5, x - edge - 0.5};
}

TEST(Mdim, RealLabelsBoundsAreTheRastersEdges) {
  // The label's own bounds confirm in both axes how the equation is read.
  EXPECT_NEAR(by_equation(-27.5, 320.0, 0).y, -0.5, 1e-9);
  EXPECT_NEAR(by_equation(-27.5, 320.0, 0).x, -0.5, 1e-3);
  EXPECT_NEAR(by_equation(-32.5, 317.5, 0).y, 319.5, 1e-9);
  EXPECT_NEAR(by_equation(-27.5, 314.99725, 0).x, 283.5, 1e-3);
}

class MdimVersion : public ::testing::TestWithParam<std::tuple<double, bool>> {};

TEST_P(MdimVersion, EveryPixelAgreesWithTheEquation) {
  const auto [edge, attached] = GetParam();
  const test_support::TempDir folder;
  Label label = mdim();
  std::ostringstream offset_x, offset_y;
  offset_x << std::setprecision(12) << -1760.0 + edge;
  offset_y << std::setprecision(12) << 141.922 + edge;
  label.map["X_AXIS_PROJECTION_OFFSET"] = offset_x.str();
  label.map["Y_AXIS_PROJECTION_OFFSET"] = offset_y.str();
  std::string data;
  for (int row = 0; row < 320; ++row) {
    for (int column = 0; column < 284; ++column) data += static_cast<char>(grey(column, row));
  }
  std::string path = (folder / "mg30s317.img").string();
  if (attached) {
    label.file["^IMAGE_HISTOGRAM"] = "10";
    label.file["^IMAGE"] = "14";
    std::string text = label.text();
    text.resize(284 * 13, ' ');
    source_files::write_text(path, text + data);
  } else {
    label.file["^IMAGE"] = "(\"MG30S317.IMG\",1)";  // another case than the file's, as on the discs
    source_files::write_text(path, data);
    source_files::write_text(folder / "mg30s317.lbl", label.text());
  }
  const mars::GdalRaster raster(path);
  const auto source = mars::open_elevation(path);
  EXPECT_NEAR(source->infos().at(0).resolution_m, 925.4, 0.1);
  for (const auto& [lat, lon] : {std::pair{-27.6, 317.5}, {-30.0, 318.9}, {-32.4, 315.2}, {-28.77, 319.31}}) {
    const mars::LonLat place{-lon, centric(lat)};
    const glm::dvec2 expected = by_equation(lat, lon, 0);
    const glm::dvec2 pixel = pds_files::pixel_of(raster, place);
    EXPECT_NEAR(pixel.x, expected.x, 1e-6);
    EXPECT_NEAR(pixel.y, expected.y, 1e-6);
    const int column = static_cast<int>(std::lround(expected.x));
    const int row = static_cast<int>(std::lround(expected.y));
    // The pixel's own value at the pixel's own centre.
    const glm::dvec2 centre(column, row);
    glm::dvec3 direction;
    raster.georeference().to_directions({&centre, 1}, {&direction, 1});
    EXPECT_NEAR(source_files::height_at(*source, mars::lon_lat(direction)), grey(column, row), 1e-6);
  }
  std::int64_t bytes = 0;
  for (const auto& entry : fs::directory_iterator(folder.path()))
    bytes += static_cast<std::int64_t>(entry.file_size());
  EXPECT_EQ(source->infos().at(0).size_bytes, bytes);
  // As an image, east to the right.
  const auto image = mars::open_image(path);
  for (const glm::dvec2 pixel : {glm::dvec2(0, 0), {283, 0}, {141, 160}, {20, 319}}) {
    glm::dvec3 direction;
    raster.georeference().to_directions({&pixel, 1}, {&direction, 1});
    vpe::base::Rgb colour;
    std::uint8_t alpha = 0;
    image->sample({&direction, 1}, 925, {&colour, 1}, {&alpha, 1});
    EXPECT_EQ(alpha, 255);
    EXPECT_EQ(int{colour.r}, grey(static_cast<int>(pixel.x), static_cast<int>(pixel.y)));
  }
  glm::dvec3 left, right;
  const glm::dvec2 first(0, 0), last(283, 0);
  raster.georeference().to_directions({&first, 1}, {&left, 1});
  raster.georeference().to_directions({&last, 1}, {&right, 1});
  EXPECT_LT(mars::lon_lat(left).lon_deg, mars::lon_lat(right).lon_deg);
}

INSTANTIATE_TEST_SUITE_P(EdgeAt, MdimVersion,
                         ::testing::Combine(::testing::Values(0.0, 0.5, 1.0), ::testing::Bool()));

TEST(Mdim, NameTellsTheSecondVersionWhereBoundsAreRough) {
  Label label = mdim();
  label.map["MAXIMUM_LATITUDE"] = "-27.4941";  // 0.38 lines off: neither
  const auto edge = [&] {
    const mars::LabelGeoreference place = mars::pds_catalog_map("x", mars::parse_pds_label(label.text()));
    return -1760 - (*place.to_map)[3] / (*place.to_map)[1];
  };
  EXPECT_NEAR(edge(), 0, 1e-9);
  label.file["DATA_SET_ID"] = "\"VO1/VO2-M-VIS-5-DIM-V2.0\"";
  EXPECT_NEAR(edge(), 1, 1e-9);
}

TEST(Mdim, GlobalMapIsTheSamePlanetAcrossTheDateLine) {
  // 1/4 degree maps of the whole planet, centred at 180 W and at 0: the same values everywhere.
  const test_support::TempDir folder;
  const auto make = [&](const std::string& name, double centre_west) {
    Label label = mdim();
    label.file["RECORD_BYTES"] = "180";
    label.file["^IMAGE"] = "\"" + name + ".img\"";
    label.image["LINES"] = "90";
    label.image["LINE_SAMPLES"] = "180";
    label.image["SAMPLE_BITS"] = "16";
    label.image["SAMPLE_TYPE"] = "INTEGER";
    label.map["MAP_RESOLUTION"] = "0.5";
    label.map["MAXIMUM_LATITUDE"] = "90.0";
    label.map["MINIMUM_LATITUDE"] = "-90.0";
    label.map["X_AXIS_PROJECTION_OFFSET"] = "45.0";
    label.map["Y_AXIS_PROJECTION_OFFSET"] = "90.0";
    label.map["CENTER_LONGITUDE"] = std::to_string(centre_west);
    return pds_files::write(folder.path(), name, label, [&](int column, int row) {
      const double lat = 90 - (row + 0.5) * 2;
      const double west = centre_west - (column + 0.5 - 90) * 2 / std::cos(lat * kRadian);
      return std::lround(3000 * std::cos(west * kRadian) +
                         2000 * std::sin(2 * west * kRadian) * std::cos(lat * kRadian) + 20 * lat);
    });
  };
  const auto a = mars::open_elevation(make("a", 180));
  const auto b = mars::open_elevation(make("b", 0));
  test_support::Random random(8);
  for (int i = 0; i < 500; ++i) {
    const mars::LonLat place{random.uniform(-170, 170), random.uniform(-60, 60)};
    if (std::abs(place.lon_deg) < 8) continue;
    const double graphic = std::atan(std::tan(place.lat_deg * kRadian) / kAxes / kAxes) / kRadian;
    const double west = -place.lon_deg * kRadian;
    const double expected =
        3000 * std::cos(west) + 2000 * std::sin(2 * west) * std::cos(graphic * kRadian) + 20 * graphic;
    EXPECT_NEAR(source_files::height_at(*a, place), expected, 30) << place.lon_deg << " " << place.lat_deg;
    EXPECT_NEAR(source_files::height_at(*b, place), expected, 30) << place.lon_deg << " " << place.lat_deg;
  }
}

TEST(Mdim, RefusesWhatItCannotPlace) {
  const test_support::TempDir folder;
  const auto error = [&](const std::string& key, const std::string& text) {
    Label label = mdim();
    label.image["LINES"] = "4";
    if (text.empty()) {
      label.map.erase(key);
    } else {
      label.map[key] = text;
    }
    return source_files::elevation_error(
        pds_files::write(folder.path(), "e", label, [](int, int) { return 5; }));
  };
  EXPECT_EQ(error("TARGET_NAME", "MARS"), "");
  for (const auto& [key, text, words] :
       {std::tuple{"MAP_PROJECTION_TYPE", "MERCATOR", "neither SINUSOIDAL nor POLAR STEREOGRAPHIC: MERCATOR"},
        {"MAP_PROJECTION_TYPE", "POLAR_STEREOGRAPHIC", "CENTER_LATITUDE is no pole: 0.00000"},
        {"X_AXIS_PROJECTION_OFFSET", "", "no usable IMAGE_MAP_PROJECTION_CATALOG.X_AXIS_PROJECTION_OFFSET"},
        {"MAP_RESOLUTION", "0", "no usable radii or MAP_RESOLUTION"},
        {"A_AXIS_RADIUS", "\"N/A\"", "no usable radii"},
        {"MAXIMUM_LATITUDE", "-20.0", "offsets and MAXIMUM_LATITUDE disagree: by -480 lines"}}) {
    const std::string message = error(key, text);
    EXPECT_NE(message.find(words), std::string::npos) << message;
    EXPECT_NE(message.find("e.lbl"), std::string::npos) << message;
  }
}

// ---- Samples

Label cylinder(int columns, int rows) {
  Label label = pds_files::label("SIMPLE CYLINDRICAL", columns, rows);
  label.map["MAP_RESOLUTION"] = "1.0";
  label.map["MAP_SCALE"] = "59.27";
  label.map["MAXIMUM_LATITUDE"] = "10.0";
  label.map["LINE_PROJECTION_OFFSET"] = "10.5";
  label.map["SAMPLE_PROJECTION_OFFSET"] = "0.5";
  return label;
}

struct Sample {
  const char* type;
  int bits;
  bool big_endian;
  std::int64_t low, high;
};

class RawSamples : public ::testing::TestWithParam<std::tuple<Sample, bool>> {};

TEST_P(RawSamples, EveryIntegerTypeInEveryLabel) {
  const auto& [sample, old] = GetParam();
  if (sample.bits == 8 && !old) return;
  const test_support::TempDir folder;
  Label label = cylinder(7, 5);
  if (old) label.first = kSfdu;
  label.file["RECORD_BYTES"] = std::to_string(7 * sample.bits / 8);
  label.image["SAMPLE_TYPE"] = sample.type;
  label.image["SAMPLE_BITS"] = std::to_string(sample.bits);
  label.image["SCALING_FACTOR"] = "0.5";
  label.image["OFFSET"] = "-100";
  const auto value = [s = sample](int column, int row) {
    return s.low + (s.high - s.low) / 34 * (column + 7 * row);
  };
  const auto source =
      mars::open_elevation(pds_files::write(folder.path(), "s", label, value, sample.big_endian));
  for (int row = 0; row < 5; ++row) {
    for (int column = 0; column < 7; ++column) {
      EXPECT_NEAR(source_files::height_at(*source, {column + 0.5, 9.5 - row}),
                  0.5 * static_cast<double>(value(column, row)) - 100,
                  1e-6 * std::abs(static_cast<double>(sample.high)) + 1e-6)
          << sample.type << " " << sample.bits << " " << column << " " << row;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Types, RawSamples,
    ::testing::Combine(::testing::Values(Sample{"UNSIGNED_INTEGER", 8, true, 1, 255},
                                         Sample{"MSB_INTEGER", 16, true, -32000, 32000},
                                         Sample{"INTEGER", 16, true, -32000, 32000},
                                         Sample{"LSB_INTEGER", 16, false, -32000, 32000},
                                         Sample{"VAX_INTEGER", 16, false, -32000, 32000},
                                         Sample{"\"PC_INTEGER\"", 16, false, -32000, 32000},
                                         Sample{"UNSIGNED_INTEGER", 16, true, 1, 65000},
                                         Sample{"MSB_UNSIGNED_INTEGER", 16, true, 1, 65000},
                                         Sample{"LSB_UNSIGNED_INTEGER", 16, false, 1, 65000},
                                         Sample{"MSB_INTEGER", 32, true, -2000000, 2000000},
                                         Sample{"LSB_INTEGER", 32, false, -2000000, 2000000},
                                         Sample{"MSB_UNSIGNED_INTEGER", 32, true, 1, 2000000}),
                       ::testing::Bool()));

TEST(RawImage, PrefixSuffixRecordsAndNodata) {
  const test_support::TempDir folder;
  for (const bool old : {false, true}) {
    Label label = cylinder(6, 4);
    if (old) label.first = kSfdu;
    label.file["RECORD_BYTES"] = "20";
    label.file["^IMAGE"] = "(\"p.dat\", 3)";
    label.image["LINE_PREFIX_BYTES"] = "5";
    label.image["LINE_SUFFIX_BYTES"] = "3";
    label.image["MISSING_CONSTANT"] = "16#8001#";
    std::string data(40, 'x');
    for (int row = 0; row < 4; ++row) {
      data += "PREFI";
      for (int column = 0; column < 6; ++column) {
        const int value = column == 2 && row == 1 ? -32767 : 1000 * row - 100 * column;
        data += static_cast<char>(value >> 8);
        data += static_cast<char>(value);
      }
      data += "SUF";
    }
    source_files::write_text(folder / "p.dat", data);
    source_files::write_text(folder / "p.lbl", label.text());
    const auto source = mars::open_elevation((folder / "p.lbl").string());
    for (int row = 0; row < 4; ++row) {
      for (int column = 0; column < 6; ++column) {
        const double height_m = source_files::height_at(*source, {column + 0.5, 9.5 - row});
        if (column == 2 && row == 1) {
          EXPECT_TRUE(std::isnan(height_m));
        } else {
          EXPECT_NEAR(height_m, 1000 * row - 100 * column, 1e-6);
        }
      }
    }
  }
}

TEST(RawImage, ThreeBandsInEveryOrder) {
  const test_support::TempDir folder;
  for (const char* order : {"BAND_SEQUENTIAL", "LINE_INTERLEAVED", "SAMPLE_INTERLEAVED"}) {
    Label label = cylinder(6, 4);
    label.first = kSfdu;
    label.image["SAMPLE_BITS"] = "8";
    label.image["SAMPLE_TYPE"] = "UNSIGNED_INTEGER";
    label.image["BANDS"] = "3";
    label.image["BAND_STORAGE_TYPE"] = order;
    label.file["^IMAGE"] = "\"c.img\"";
    std::string data(72, '\0');
    for (int band = 0; band < 3; ++band) {
      for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 6; ++column) {
          const int place = order[0] == 'B'   ? (band * 4 + row) * 6 + column
                            : order[0] == 'L' ? (row * 3 + band) * 6 + column
                                              : (row * 6 + column) * 3 + band;
          data[static_cast<std::size_t>(place)] = static_cast<char>(10 + 60 * band + 10 * row + column);
        }
      }
    }
    source_files::write_text(folder / "c.img", data);
    source_files::write_text(folder / "c.lbl", label.text());
    const auto image = mars::open_image((folder / "c.lbl").string());
    const glm::dvec3 direction = mars::direction({3.5, 7.5});
    vpe::base::Rgb colour;
    std::uint8_t alpha = 0;
    image->sample({&direction, 1}, 59000, {&colour, 1}, {&alpha, 1});
    EXPECT_EQ(int{colour.r}, 33) << order;
    EXPECT_EQ(int{colour.g}, 93) << order;
    EXPECT_EQ(int{colour.b}, 153) << order;
    EXPECT_EQ(alpha, 255);
  }
}

TEST(RawImage, UnusableImagesAreRefused) {
  const test_support::TempDir folder;
  const auto error = [&](const std::map<std::string, std::string>& image,
                         const std::map<std::string, std::string>& file) {
    Label label = cylinder(6, 4);
    label.first = kSfdu;
    for (const auto& [key, text] : image) label.image[key] = text;
    for (const auto& [key, text] : file) label.file[key] = text;
    source_files::write_text(folder / "u.img", std::string(48, 'x'));
    label.file.emplace("^IMAGE", "\"u.img\"");
    source_files::write_text(folder / "u.lbl", label.text());
    return source_files::elevation_error((folder / "u.lbl").string());
  };
  EXPECT_EQ(error({}, {}), "");
  const auto expect = [](const std::string& message, const std::string& words) {
    EXPECT_NE(message.find(words), std::string::npos) << words << " not in: " << message;
    EXPECT_NE(message.find("u."), std::string::npos) << message;
  };
  expect(error({{"SAMPLE_TYPE", "VAX_REAL"}, {"SAMPLE_BITS", "32"}}, {}),
         "cannot be read: of type VAX_REAL in 32 bits");
  expect(error({{"SAMPLE_TYPE", "MSB_INTEGER"}, {"SAMPLE_BITS", "8"}}, {}), "of type MSB_INTEGER in 8 bits");
  expect(error({{"SAMPLE_BITS", "12"}}, {}), "in 12 bits");
  expect(error({{"ENCODING_TYPE", "\"HUFFMAN_FIRST_DIFFERENCE\""}}, {}), "is compressed: HUFFMAN");
  expect(error({{"LINES", "5"}}, {}), "is cut short: 48 of 60 bytes");
  expect(error({{"LINES", "2000000000"}, {"LINE_SAMPLES", "2000000000"}}, {}), "is cut short");
  expect(error({{"LINES", "-4"}}, {}), "no usable IMAGE.LINES: -4");
  expect(error({}, {{"^IMAGE", "\"none.img\""}}), "names an image that does not exist: none.img");
  expect(error({}, {{"^IMAGE", "(\"u.img\", 0)"}}), "no usable ^IMAGE");
  expect(error({}, {{"^IMAGE", "9223372036854775807"}}), "no usable ^IMAGE");
  expect(error({}, {{"^IMAGE", "2"}, {"RECORD_BYTES", "\"N/A\""}}), "no usable RECORD_BYTES");
  // The same of PDS3, whose VAX_REAL GDAL takes for IEEE.
  Label label = cylinder(3, 4);
  label.image["SAMPLE_TYPE"] = "VAX_REAL";
  label.image["SAMPLE_BITS"] = "32";
  label.file["RECORD_BYTES"] = "12";
  expect(source_files::elevation_error(pds_files::write(folder.path(), "u", label, [](int, int) { return 1; })),
         "of type VAX_REAL");
}

TEST(RawImage, AFileWithoutAMapHasNoGeoreference) {
  const test_support::TempDir folder;
  Label label = cylinder(6, 4);
  label.first = kSfdu;
  label.map_object = "IMAGE_NOTHING";
  const std::string message =
      source_files::elevation_error(pds_files::write(folder.path(), "n", label, [](int, int) { return 1; }));
  EXPECT_NE(message.find("has no georeference"), std::string::npos) << message;
}

}  // namespace
