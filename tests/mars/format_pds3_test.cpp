// PDS3 products: their places by the products' own formulae, to a millionth of a pixel.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <iomanip>
#include <sstream>

#include "mars/geodesy/sphere.h"
#include "mars/raster/gdal_raster.h"
#include "mars/raster/pds_map.h"
#include "mars/sources/source.h"
#include "tests/mars/pds_files.h"
#include "tests/mars/source_files.h"
#include "tests/support/support.h"

namespace {

using pds_files::Label;
using pds_files::label;
using pds_files::pixel_of;

constexpr double kExact_px = 1e-6;
constexpr double kRadian = mars::kRadiansPerDegree;

void expect_pixel(const mars::GdalRaster& raster, mars::LonLat place, double column, double row) {
  const glm::dvec2 pixel = pixel_of(raster, place);
  EXPECT_NEAR(pixel.x, column, kExact_px) << place.lon_deg << " " << place.lat_deg;
  EXPECT_NEAR(pixel.y, row, kExact_px) << place.lon_deg << " " << place.lat_deg;
}

std::string number(double value) {
  std::ostringstream out;
  out << std::setprecision(17) << value;
  return out.str();
}

// Makes a sparse file of the right length; its values are not read.
std::string write_empty(const std::filesystem::path& folder, const std::string& name, Label label) {
  const auto size = std::stoull(label.image.at("LINES")) * std::stoull(label.image.at("LINE_SAMPLES")) *
                    (std::stoull(label.image.at("SAMPLE_BITS")) / 8);
  label.file.emplace("^IMAGE", "\"" + name + ".img\"");
  source_files::write_text(folder / (name + ".img"), "");
  std::filesystem::resize_file(folder / (name + ".img"), size);
  source_files::write_text(folder / (name + ".lbl"), label.text());
  return (folder / (name + ".lbl")).string();
}

// ---- MEGDR, cylindrical

struct Tiling {
  double per_degree;
  int lines, samples;  // of a tile
  double top_deg;      // of the northernmost tiles
};

class Megdr : public ::testing::TestWithParam<Tiling> {};

TEST_P(Megdr, EveryTileAtItsPlaceInBothConventions) {
  const Tiling& t = GetParam();
  const test_support::TempDir folder;
  const double tall = t.lines / t.per_degree;
  const double wide = t.samples / t.per_degree;
  for (double north = t.top_deg; north > -t.top_deg + 1e-9; north -= tall) {
    for (double west = 0; west < 360 - 1e-9; west += wide) {
      for (const double first : {0.0, 1.0}) {
        Label l = label("SIMPLE CYLINDRICAL", t.samples, t.lines);
        l.map["CENTER_LONGITUDE"] = "180.0 <DEGREE>";
        l.map["MAP_RESOLUTION"] = number(t.per_degree) + " <PIXEL/DEGREE>";
        l.map["MAP_SCALE"] =
            t.per_degree == 128 ? "0.463 <KM/PIXEL>" : number(59.275 / t.per_degree) + " <KM/PIXEL>";
        l.map["MAXIMUM_LATITUDE"] = number(north) + " <DEGREE>";
        l.map["MINIMUM_LATITUDE"] = number(north - tall) + " <DEGREE>";
        l.map["WESTERNMOST_LONGITUDE"] = number(west) + " <DEGREE>";
        l.map["EASTERNMOST_LONGITUDE"] = number(west + wide) + " <DEGREE>";
        // The archive's formulae: SAMPLE = OFFSET + RES (LON - CENTER), LINE = OFFSET - RES LAT, from 1.
        l.map["LINE_PROJECTION_OFFSET"] = number(north * t.per_degree - 0.5 + first);
        l.map["SAMPLE_PROJECTION_OFFSET"] = number((180 - west) * t.per_degree - 0.5 + first);
        const mars::GdalRaster raster(write_empty(folder.path(), "tile", l));
        const double half = 0.5 / t.per_degree;
        expect_pixel(raster, {west + half, north - half}, 0, 0);
        expect_pixel(raster, {west + wide - half, north - half}, t.samples - 1, 0);
        expect_pixel(raster, {west + half, north - tall + half}, 0, t.lines - 1);
        expect_pixel(raster, {west + wide - half, north - tall + half}, t.samples - 1, t.lines - 1);
        expect_pixel(raster, {west + wide / 2 + half, north - tall / 2 - half}, t.samples / 2, t.lines / 2);
        // Tiles of 360 degrees wrap, others do not, and no tile up to 88 degrees includes a pole.
        EXPECT_EQ(raster.grid().wraps, wide == 360);
        EXPECT_EQ(raster.grid().has_first_pole(), wide == 360);
        EXPECT_DOUBLE_EQ(raster.georeference().resolution_m(), 3396000 * kRadian / t.per_degree);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Resolutions, Megdr,
                         ::testing::Values(Tiling{4, 720, 1440, 90}, Tiling{16, 2880, 5760, 90},
                                           Tiling{32, 5760, 11520, 90}, Tiling{64, 5760, 11520, 90},
                                           Tiling{128, 5632, 11520, 88}));

TEST(MegdrValues, TopographyRadiusAreoidAndCounts) {
  const test_support::TempDir folder;
  struct Kind {
    const char* name;
    const char* more_key;
    const char* offset;
    double offset_m;
  };
  for (const Kind& kind :
       {Kind{"MEDIAN_TOPOGRAPHY", "UNIT", "0", 0}, Kind{"PLANETARY_RADIUS", "UNIT", "3396000", 3396000},
        Kind{"AREOID_RADIUS", "UNIT", "3396000.", 3396000}, Kind{"COUNTS", "UNIT", "0.0", 0}}) {
    Label l = label("SIMPLE CYLINDRICAL", 36, 18);
    l.image["NAME"] = kind.name;
    l.image["SCALING_FACTOR"] = "1";
    l.image["OFFSET"] = kind.offset;
    l.image[kind.more_key] = "METER";
    l.map["MAP_RESOLUTION"] = "0.1";
    l.map["MAP_SCALE"] = "592.7";
    l.map["MAXIMUM_LATITUDE"] = "90.0";
    l.map["LINE_PROJECTION_OFFSET"] = "9.5";
    l.map["SAMPLE_PROJECTION_OFFSET"] = "18.5";
    const auto source = mars::open_elevation(pds_files::write(
        folder.path(), "k", l, [](int column, int row) { return 1000 * row - 300 * column - 5000; }));
    EXPECT_NEAR(source_files::height_at(*source, {-175 + 70, 85 - 30}), 3000 - 2100 - 5000 + kind.offset_m,
                1e-6)
        << kind.name;
    EXPECT_EQ(source->infos().at(0).quantum_m, 1) << kind.name;
  }
}

// ---- MEGDR, polar

struct Polar {
  bool north;
  double first;  // what the first pixel's centre counts
  const char* a_axis;
  const char* words;  // of COORDINATE_SYSTEM_NAME
};

class MegdrPolar : public ::testing::TestWithParam<Polar> {};

TEST_P(MegdrPolar, ByItsFormulaAndScaledValues) {
  const Polar& p = GetParam();
  const int n = 96;
  const double per_degree = 4;
  Label l = label("POLAR STEREOGRAPHIC", n, n);
  l.image["SAMPLE_TYPE"] = "MSB_UNSIGNED_INTEGER";
  l.image["SCALING_FACTOR"] = "0.25";
  l.image["OFFSET"] = "-8000";
  l.map["COORDINATE_SYSTEM_NAME"] = p.words;
  l.map["A_AXIS_RADIUS"] = p.a_axis;
  l.map["B_AXIS_RADIUS"] = p.a_axis;
  l.map["C_AXIS_RADIUS"] = "3376.2 <KM>";
  l.map["CENTER_LATITUDE"] = p.north ? "90.0 <DEGREE>" : "-90.0 <DEGREE>";
  l.map["MAP_RESOLUTION"] = "4.0 <PIXEL/DEGREE>";
  l.map["MAP_SCALE"] = "14.73 <KM/PIXEL>";  // rounded: half a pixel off at the rim
  l.map["LINE_PROJECTION_OFFSET"] = number(n / 2 - 0.5 + p.first);
  l.map["SAMPLE_PROJECTION_OFFSET"] = number(n / 2 - 0.5 + p.first);
  const test_support::TempDir folder;
  const auto value = [](int column, int row) { return 600 * column + 85 * row + 3; };  // beyond 32767 too
  const std::string path = pds_files::write(folder.path(), "polar", l, value);
  const auto source = mars::open_elevation(path);
  const mars::GdalRaster raster(path);
  for (const auto& [i, j] :
       {std::pair{1, 1}, {n, 1}, {1, n}, {n, n}, {n / 2, n / 2}, {n / 2 + 1, n / 2}, {70, 20}}) {
    // The catalogue's formulae for sample I and line J, from 1: in the north longitude 0 goes down from the
    // pole and 90 E to the right, in the south 0 goes up.
    const double x = (i - n / 2 - 0.5) / per_degree;
    const double y = (j - n / 2 - 0.5) / per_degree * (p.north ? 1 : -1);
    const double r = std::hypot(x, y);
    const double lat = 90 - 2 * std::atan(r * mars::kPi / 360) / kRadian;
    const mars::LonLat place{std::atan2(x, y) / kRadian, p.north ? lat : -lat};
    expect_pixel(raster, place, i - 1, j - 1);
    const double expected_m = 0.25 * value(i - 1, j - 1) - 8000;
    EXPECT_NEAR(source_files::height_at(*source, place), expected_m, 1e-6 * 700);
  }
}

INSTANTIATE_TEST_SUITE_P(Labels, MegdrPolar,
                         ::testing::Values(Polar{true, 1, "3376.2 <KM>", "\"PLANETOCENTRIC\""},
                                           Polar{true, 1, "3396.19 <KM>", "\"PLANETOCENTRIC\""},
                                           Polar{true, 0, "3376.2 <KM>", "PLANETOCENTRIC"},
                                           Polar{false, 1, "3396.19 <KM>", "PLANETOCENTRIC"},
                                           Polar{false, 0, "3376.2 <KM>", "\"PLANETOCENTRIC\""}));

TEST(PdsPolar, ExactScaleOfAnotherRadiusIsNotTakenForARounding) {
  // 128 pixels a degree on the equatorial radius, in a map on the polar one: 0.6 % between the two.
  const test_support::TempDir folder;
  Label l = label("POLAR STEREOGRAPHIC", 200, 200);
  l.map["A_AXIS_RADIUS"] = l.map["B_AXIS_RADIUS"] = "3396.19 <KM>";
  l.map["C_AXIS_RADIUS"] = "3376.20 <KM>";
  l.map["CENTER_LATITUDE"] = "90.0";
  l.map["MAP_RESOLUTION"] = "128.0 <PIXEL/DEGREE>";
  const double scale_m = 3396190 * kRadian / 128;
  l.map["MAP_SCALE"] = number(scale_m / 1000) + " <KM/PIXEL>";
  l.map["LINE_PROJECTION_OFFSET"] = "99.5";
  l.map["SAMPLE_PROJECTION_OFFSET"] = "99.5";
  const mars::GdalRaster raster(pds_files::write(folder.path(), "s", l, [](int, int) { return 1; }));
  const double lat = 90 - 2 * std::atan(80 * scale_m / 2 / 3376200) / kRadian;
  expect_pixel(raster, {90, lat}, 99.5 + 80, 99.5);
}

TEST(MegrPolar, FirstPixelWhereTheArchiveSaysIt) {
  // MEGR_S_128 and MEGR_S_512 (IEEE_REAL): their labels describe another projection, 2 sin(c/2), but the place
  // they give for the first pixel's corner, 37.4532 S and 73.1519 S at 315 E, is that of the stereographic one.
  const test_support::TempDir folder;
  for (const auto& [n, per_degree, lat] : {std::tuple{10240, 128, -37.4532}, {12288, 512, -73.1519}}) {
    Label l = label("POLAR STEREOGRAPHIC", n, n);
    l.image["SAMPLE_TYPE"] = "IEEE_REAL";
    l.image["SAMPLE_BITS"] = "32";
    l.map["CENTER_LATITUDE"] = "-90.0";
    l.map["MAP_RESOLUTION"] = std::to_string(per_degree) + ".0 <PIXEL/DEGREE>";
    l.map["MAP_SCALE"] = "0.115 <KM/PIXEL>";
    if (per_degree == 128) l.map["MAP_SCALE"] = "0.46 <KM/PIXEL>";
    l.map["LINE_PROJECTION_OFFSET"] = number(n / 2 + 0.5);
    l.map["SAMPLE_PROJECTION_OFFSET"] = number(n / 2 + 0.5);
    const glm::dvec2 corner = pixel_of(mars::GdalRaster(write_empty(folder.path(), "shape", l)), {315, lat});
    // Four decimals of a degree are up to 0.03 pixels.
    EXPECT_NEAR(corner.x, -0.5, 0.03);
    EXPECT_NEAR(corner.y, -0.5, 0.03);
  }
}

// ---- Every projection

struct Map {
  const char* type;
  const char* proj;  // PROJ's words without body and central meridian
  double centre_lat;
};

const Map kMaps[] = {
    {"SIMPLE CYLINDRICAL", "+proj=eqc", 0},
    {"SIMPLE_CYLINDRICAL", "+proj=eqc", 0},
    {"EQUIRECTANGULAR", "+proj=eqc +lat_ts=35", 35},
    {"SINUSOIDAL", "+proj=sinu", 0},
    {"MOLLWEIDE", "+proj=moll", 0},
    {"ORTHOGRAPHIC", "+proj=ortho +lat_0=20", 20},
    {"STEREOGRAPHIC", "+proj=stere +lat_0=20", 20},
    {"POLAR STEREOGRAPHIC", "+proj=stere +lat_0=90 +lat_ts=90", 90},
    {"STEREOGRAPHIC", "+proj=stere +lat_0=-90 +lat_ts=-90", -90},
    {"MERCATOR", "+proj=merc +lat_ts=15", 15},
    {"TRANSVERSE MERCATOR", "+proj=tmerc +lat_0=10", 10},
    {"LAMBERT CONFORMAL", "+proj=lcc +lat_0=30 +lat_1=20 +lat_2=50", 30},
    {"LAMBERT_CONFORMAL_CONIC", "+proj=lcc +lat_0=30 +lat_1=20 +lat_2=50", 30},
    {"ALBERS", "+proj=aea +lat_0=30 +lat_1=20 +lat_2=50", 30},
    {"LAMBERT AZIMUTHAL EQUAL AREA", "+proj=laea +lat_0=30", 30},
    {"CYLINDRICAL EQUAL AREA", "+proj=cea +lat_ts=20", 0},
};

Label label_of(const Map& map, double centre_lon, bool west) {
  Label l = label(map.type, 30, 20);
  l.map["CENTER_LATITUDE"] = number(map.centre_lat);
  l.map["CENTER_LONGITUDE"] = number(west ? 360 - centre_lon : centre_lon);
  l.map["POSITIVE_LONGITUDE_DIRECTION"] = west ? "WEST" : "EAST";
  l.map["FIRST_STANDARD_PARALLEL"] = "20.0";
  l.map["SECOND_STANDARD_PARALLEL"] = "50.0";
  l.map["MAP_SCALE"] = "25.0 <KM/PIXEL>";
  l.map["LINE_PROJECTION_OFFSET"] = "12.25";
  l.map["SAMPLE_PROJECTION_OFFSET"] = "-3.5";
  return l;
}

class PdsProjection : public ::testing::TestWithParam<Map> {};

TEST_P(PdsProjection, AgreesWithProjForEastAndWestLongitudes) {
  const Map& map = GetParam();
  const test_support::TempDir folder;
  for (const double centre_lon : {70.0, 337.5}) {
    for (const bool west : {false, true}) {
      const std::string path =
          pds_files::write(folder.path(), "m", label_of(map, centre_lon, west), [](int, int) { return 1; });
      const source_files::Proj proj(std::string(map.proj) + " +R=3396000 +lon_0=" + number(centre_lon));
      const mars::GdalRaster raster(path);
      for (const glm::dvec2 off : {glm::dvec2(1, 2), {9, -4}, {-6, 8}}) {
        const double sign = map.centre_lat > 0 ? -1 : 1;
        const mars::LonLat place{centre_lon + off.x, map.centre_lat + sign * std::abs(off.y)};
        const glm::dvec2 xy = proj.forward(place);
        const glm::dvec3 direction = mars::direction(place);
        glm::dvec2 pixel;
        raster.georeference().to_pixels({&direction, 1}, {&pixel, 1});
        // Pixel (0, 0) is counted 0, GDAL's convention, as no bounds say otherwise.
        glm::dvec2 away = pixel - glm::dvec2(xy.x / 25000 - 3.5, 12.25 - xy.y / 25000);
        if (raster.grid().period > 0) away.x = std::remainder(away.x, raster.grid().period);
        const double exact_px =
            raster.georeference().is_linear() ? mars::Georeference::kLinearError_px : kExact_px;
        EXPECT_NEAR(away.x, 0, exact_px) << map.type << west << centre_lon;
        EXPECT_NEAR(away.y, 0, exact_px) << map.type << west << centre_lon;
      }
    }
  }
}

TEST_P(PdsProjection, PlanetographicLatitudesOfAFlattenedBody) {
  // ISIS: spherical equations take planetographic latitudes as they are; the others are the ellipsoid's.
  const Map& map = GetParam();
  const std::string words = map.proj;
  const bool spherical = words.find("eqc") != std::string::npos || words.find("sinu") != std::string::npos ||
                         words.find("moll") != std::string::npos || words.find("ortho") != std::string::npos ||
                         words == "+proj=stere +lat_0=20";
  const test_support::TempDir folder;
  Label l = label_of(map, 70, false);
  l.map["COORDINATE_SYSTEM_NAME"] = "PLANETOGRAPHIC";
  l.map["A_AXIS_RADIUS"] = l.map["B_AXIS_RADIUS"] = "3396.19 <KM>";
  l.map["C_AXIS_RADIUS"] = "3376.20 <KM>";
  const std::string path = pds_files::write(folder.path(), "g", l, [](int, int) { return 1; });
  const source_files::Proj proj(words + " +lon_0=70" + (spherical ? " +R=3396190" : " +a=3396190 +b=3376200"));
  const double graphic = map.centre_lat < 0 ? -80 : map.centre_lat == 90 ? 80 : map.centre_lat + 2;
  const double ratio = 3376.20 / 3396.19;
  const double centric = std::atan(std::tan(graphic * kRadian) * ratio * ratio) / kRadian;
  const glm::dvec2 xy = proj.forward({73, graphic});
  const glm::dvec2 pixel = pixel_of(mars::GdalRaster(path), {73, centric});
  EXPECT_NEAR(pixel.x, xy.x / 25000 - 3.5, 1e-5) << map.type;
  EXPECT_NEAR(pixel.y, 12.25 - xy.y / 25000, 1e-5) << map.type;
}

INSTANTIATE_TEST_SUITE_P(Types, PdsProjection, ::testing::ValuesIn(kMaps));

TEST(PdsWest, MirroredNumbersGiveTheSamePlanet) {
  // A regional cylindrical map across the prime meridian, its bounds and centre in either counting.
  const test_support::TempDir folder;
  const auto value = [](int column, int row) { return 100 * column - 7 * row; };
  const auto make = [&](const char* name, bool west, double first) {
    Label l = label("SIMPLE CYLINDRICAL", 40, 30);
    l.map["POSITIVE_LONGITUDE_DIRECTION"] = west ? "WEST" : "EAST";
    l.map["CENTER_LONGITUDE"] = west ? "10.0" : "350.0";
    l.map["MAP_RESOLUTION"] = "2.0";
    l.map["MAP_SCALE"] = "29.6";
    l.map["MAXIMUM_LATITUDE"] = "40.0";
    l.map["WESTERNMOST_LONGITUDE"] = west ? "15.0" : "345.0";
    l.map["EASTERNMOST_LONGITUDE"] = west ? "-5.0" : "5.0";
    l.map["LINE_PROJECTION_OFFSET"] = number(80 - 0.5 + first);
    l.map["SAMPLE_PROJECTION_OFFSET"] = number(10 - 0.5 + first);
    return pds_files::write(folder.path(), name, l, value);
  };
  const auto east = mars::open_elevation(make("east", false, 1));
  const auto west = mars::open_elevation(make("west", true, 1));
  const auto west0 = mars::open_elevation(make("west0", true, 0));
  EXPECT_EQ(source_files::height_at(*east, {345.25, 39.75}), 0);
  test_support::Random random(3);
  int inside = 0;
  for (int i = 0; i < 2000; ++i) {
    const mars::LonLat place{random.uniform(-20, 10), random.uniform(20, 45)};
    const double height_m = source_files::height_at(*east, place);
    for (const auto* other : {&west, &west0}) {
      const double same_m = source_files::height_at(**other, place);
      if (std::isnan(height_m)) {
        EXPECT_TRUE(std::isnan(same_m)) << place.lon_deg;
      } else {
        EXPECT_NEAR(height_m, same_m, 1e-9) << place.lon_deg;
      }
    }
    if (!std::isnan(height_m)) ++inside;
  }
  EXPECT_GT(inside, 700);
}

TEST(PdsHirise, TerrainModelsOfTheArchive) {
  // DTEEC and its like: attached label, PC_REAL, equirectangular on the sphere of the local radius, MAP_SCALE
  // in metres, offsets that count from zero, bounds of the data (here a trap: their north would prove another
  // convention).
  const test_support::TempDir folder;
  Label l = label("EQUIRECTANGULAR", 9, 7);
  l.file["RECORD_BYTES"] = "36";
  l.image["SAMPLE_TYPE"] = "PC_REAL";
  l.image["SAMPLE_BITS"] = "32";
  l.image["MISSING_CONSTANT"] = "16#FF7FFFFB#";
  for (const char* axis : {"A_AXIS_RADIUS", "B_AXIS_RADIUS", "C_AXIS_RADIUS"}) l.map[axis] = "3394.8396 <KM>";
  const double radius_m = 3394839.6;
  l.map["CENTER_LATITUDE"] = "15.0 <DEG>";
  l.map["CENTER_LONGITUDE"] = "180.0 <DEG>";
  l.map["MAP_SCALE"] = "2.0 <METERS/PIXEL>";
  l.map["MAP_RESOLUTION"] = number(radius_m * kRadian / 2) + " <PIX/DEG>";
  l.map["LINE_PROJECTION_OFFSET"] = "545861.5 <PIXEL>";
  l.map["SAMPLE_PROJECTION_OFFSET"] = "1220000.25 <PIXEL>";
  l.map["MAXIMUM_LATITUDE"] = number(545861.0 * 2 / (radius_m * kRadian));
  l.map["MINIMUM_LATITUDE"] = number(545855.2 * 2 / (radius_m * kRadian));
  const std::string path = pds_files::write(
      folder.path(), "dteec", l,
      [](int column, int row) -> std::int64_t {
        const float value = static_cast<float>(-2000.5 + column + 10 * row);
        std::uint32_t bits = 0;
        std::memcpy(&bits, &value, sizeof bits);
        return column == 4 && row == 2 ? 0xFF7FFFFB : bits;
      },
      false);
  const auto source = mars::open_elevation(path);
  const mars::GdalRaster raster(path);
  const auto place = [&](double column, double row) {
    const double x_m = (column - 1220000.25) * 2;
    return mars::LonLat{180 + x_m / (radius_m * std::cos(15 * kRadian)) / kRadian,
                        (545861.5 - row) * 2 / radius_m / kRadian};
  };
  expect_pixel(raster, place(0, 0), 0, 0);
  expect_pixel(raster, place(8, 6), 8, 6);
  EXPECT_NEAR(source_files::height_at(*source, place(3, 5)), -2000.5 + 3 + 50, 1e-3);
  EXPECT_TRUE(std::isnan(source_files::height_at(*source, place(4, 2))));
  EXPECT_NEAR(source->infos().at(0).resolution_m, 2, 1e-9);
}

TEST(PdsMapErrors, UnsupportedMapsAreRefused) {
  const test_support::TempDir folder;
  const auto error = [&](const std::map<std::string, std::string>& changes, const char* type) {
    Label l = label_of({type, "", 0}, 70, true);
    for (const auto& [key, text] : changes) l.map[key] = text;
    return source_files::elevation_error(pds_files::write(folder.path(), "e", l, [](int, int) { return 1; }));
  };
  EXPECT_NE(error({}, "OBLIQUE CYLINDRICAL").find("counts longitudes to the west in an unsupported projection"),
            std::string::npos);
  EXPECT_NE(error({{"MAP_PROJECTION_ROTATION", "90.0"}}, "SINUSOIDAL").find("MAP_PROJECTION_ROTATION"),
            std::string::npos);
  const std::string vesta = error({{"A_AXIS_RADIUS", "284.5"},
                                   {"B_AXIS_RADIUS", "277.3"},
                                   {"C_AXIS_RADIUS", "226.43"},
                                   {"COORDINATE_SYSTEM_NAME", "PLANETOGRAPHIC"}},
                                  "SINUSOIDAL");
  EXPECT_NE(vesta.find("triaxial body"), std::string::npos) << vesta;
  EXPECT_NE(vesta.find("e.lbl"), std::string::npos) << vesta;
  EXPECT_EQ(error({{"A_AXIS_RADIUS", "284.5"},
                   {"B_AXIS_RADIUS", "277.3"},
                   {"C_AXIS_RADIUS", "226.43"},
                   {"COORDINATE_SYSTEM_NAME", "PLANETOCENTRIC"}},
                  "SINUSOIDAL"),
            "");
  Label unknown = label_of({"AITOFF", "", 0}, 70, false);
  const std::string words =
      source_files::elevation_error(pds_files::write(folder.path(), "u", unknown, [](int, int) { return 1; }));
  EXPECT_NE(words.find("no coordinate system"), std::string::npos) << words;
}

}  // namespace
