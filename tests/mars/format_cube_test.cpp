// ISIS cubes, VICAR and PDS4: values, special pixels, and places by the equations of their definitions.
#include <gdal_priv.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <limits>
#include <map>
#include <sstream>

#include "mars/geodesy/sphere.h"
#include "mars/raster/gdal_raster.h"
#include "mars/sources/source.h"
#include "tests/mars/pds_files.h"
#include "tests/mars/source_files.h"
#include "tests/support/support.h"

namespace {

using source_files::height_at;

constexpr double kRadian = mars::kRadiansPerDegree;
constexpr double kA = 3396190;
constexpr double kC = 3376200;

double centric(double graphic_deg) {
  return std::atan(std::tan(graphic_deg * kRadian) * kC * kC / kA / kA) / kRadian;
}
double graphic(double centric_deg) {
  return std::atan(std::tan(centric_deg * kRadian) * kA * kA / kC / kC) / kRadian;
}

// An ISIS3 cube of 20 x 20 kilometre-sized pixels whose first pixel's corner is at (-10, 10) km of the map.
constexpr int kSide = 20;
struct Cube {
  std::map<std::string, std::string> mapping{{"TargetName", "Mars"},
                                             {"ProjectionName", "Sinusoidal"},
                                             {"EquatorialRadius", "3396190.0 <meters>"},
                                             {"PolarRadius", "3376200.0 <meters>"},
                                             {"LatitudeType", "Planetocentric"},
                                             {"LongitudeDirection", "PositiveEast"},
                                             {"LongitudeDomain", "360"},
                                             {"CenterLongitude", "40.0"},
                                             {"PixelResolution", "1000.0 <meters/pixel>"},
                                             {"Scale", "59.27 <pixels/degree>"},
                                             {"UpperLeftCornerX", "-10000.0 <meters>"},
                                             {"UpperLeftCornerY", "10000.0 <meters>"}};
  std::string type = "Real";
  std::string order = "Lsb";
  double base = 0;
  double multiplier = 1;
};

// stored[] holds the bytes of each pixel, in memory order.
template <class T>
std::string write_cube(const std::filesystem::path& path, const Cube& cube, const std::vector<T>& stored) {
  std::ostringstream label;
  label << "Object = IsisCube\n  Object = Core\n    StartByte = 8193\n    Format = BandSequential\n"
        << "    Group = Dimensions\n      Samples = " << kSide << "\n      Lines = " << kSide
        << "\n      Bands = 1\n    End_Group\n    Group = Pixels\n      Type = " << cube.type
        << "\n      ByteOrder = " << cube.order << "\n      Base = " << cube.base
        << "\n      Multiplier = " << cube.multiplier << "\n    End_Group\n  End_Object\n  Group = Mapping\n";
  for (const auto& [key, value] : cube.mapping) label << "    " << key << " = " << value << "\n";
  label << "  End_Group\nEnd_Object\nEnd\n";
  std::string text = label.str();
  text.resize(8192, '\0');
  for (T value : stored) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    if (cube.order == "Msb") std::reverse(bytes, bytes + sizeof(T));
    text.append(bytes, sizeof(T));
  }
  source_files::write_text(path, text);
  return path.string();
}

std::string write_flat(const std::filesystem::path& path, const Cube& cube) {
  return write_cube(path, cube, std::vector<float>(kSide * kSide, 5));
}

// Returns the pixel position by ISIS's equations, from the upper left corner in kilometres.
glm::dvec2 isis_pixel(double x_m, double y_m) {
  return {(x_m + 10000) / 1000 - 0.5, (10000 - y_m) / 1000 - 0.5};
}

struct Counted {
  bool west;
  bool planetographic;
};

class IsisPlace : public ::testing::TestWithParam<Counted> {
 protected:
  // Returns the east longitude and the planetocentric latitude of a latitude as the cube counts it.
  mars::LonLat place(double east_lon, double lat) const {
    return {east_lon, GetParam().planetographic ? centric(lat) : lat};
  }
  Cube cube(const std::string& projection) const {
    Cube cube;
    cube.mapping["ProjectionName"] = projection;
    cube.mapping["LatitudeType"] = GetParam().planetographic ? "Planetographic" : "Planetocentric";
    cube.mapping["LongitudeDirection"] = GetParam().west ? "PositiveWest" : "PositiveEast";
    cube.mapping["CenterLongitude"] = GetParam().west ? "320.0" : "40.0";
    return cube;
  }
  void expect(const Cube& cube, const mars::LonLat& place, double x_m, double y_m) {
    const glm::dvec2 pixel = pds_files::pixel_of(mars::GdalRaster(write_flat(folder_ / "c.cub", cube)), place);
    const glm::dvec2 expected = isis_pixel(x_m, y_m);
    EXPECT_NEAR(pixel.x, expected.x, 1e-6) << cube.mapping.at("ProjectionName");
    EXPECT_NEAR(pixel.y, expected.y, 1e-6) << cube.mapping.at("ProjectionName");
  }
  test_support::TempDir folder_;
};

TEST_P(IsisPlace, SphericalEquationsUseLatitudesUnchanged) {
  const double lat = 45.1;
  const double dlon = 0.05 * kRadian;
  Cube sinusoidal = cube("Sinusoidal");
  sinusoidal.mapping["UpperLeftCornerY"] = std::to_string(kA * 45 * kRadian + 10000);
  expect(sinusoidal, place(40.05, lat), kA * dlon * std::cos(lat * kRadian), kA * (lat - 45) * kRadian);
  Cube simple = cube("SimpleCylindrical");
  simple.mapping["UpperLeftCornerY"] = sinusoidal.mapping["UpperLeftCornerY"];
  simple.mapping["CenterLatitude"] = "0.0";
  expect(simple, place(40.05, lat), kA * dlon, kA * (lat - 45) * kRadian);
  Cube equirectangular = cube("Equirectangular");
  const double local = kA * kC / std::hypot(kC * std::cos(40 * kRadian), kA * std::sin(40 * kRadian));
  equirectangular.mapping["CenterLatitude"] = "40.0";
  equirectangular.mapping["UpperLeftCornerY"] = std::to_string(local * 45 * kRadian + 10000);
  expect(equirectangular, place(40.05, lat), local * std::cos(40 * kRadian) * dlon,
         local * (lat - 45) * kRadian);
}

TEST_P(IsisPlace, EllipsoidalEquationsUsePlanetographicLatitudes) {
  for (const bool south : {false, true}) {
    Cube polar = cube("PolarStereographic");
    polar.mapping["CenterLatitude"] = south ? "-90.0" : "90.0";
    polar.mapping["UpperLeftCornerX"] = "0.0 <meters>";
    polar.mapping["UpperLeftCornerY"] = south ? "2000000.0 <meters>" : "-1950000.0 <meters>";
    const double lat = 58.5;
    const double phi = (GetParam().planetographic ? lat : graphic(lat)) * kRadian;
    const double e = std::sqrt(1 - kC * kC / kA / kA);
    const double t =
        std::tan(mars::kPi / 4 - phi / 2) * std::pow((1 + e * std::sin(phi)) / (1 - e * std::sin(phi)), e / 2);
    const double rho = 2 * kA * t / std::sqrt(std::pow(1 + e, 1 + e) * std::pow(1 - e, 1 - e));
    const double dlon = 0.2 * kRadian;
    const double x = rho * std::sin(dlon);
    const double y = (south ? 1 : -1) * rho * std::cos(dlon);
    const double top = south ? 2000000 : -1950000;
    expect(polar, place(40.2, south ? -lat : lat), x - 10000, y - top + 10000);
  }
  Cube mercator = cube("Mercator");
  mercator.mapping["CenterLatitude"] = "0.0";
  const double lat = 30;
  const double phi = (GetParam().planetographic ? lat : graphic(lat)) * kRadian;
  const double e = std::sqrt(1 - kC * kC / kA / kA);
  const double y = kA * std::log(std::tan(mars::kPi / 4 + phi / 2) *
                                 std::pow((1 - e * std::sin(phi)) / (1 + e * std::sin(phi)), e / 2));
  mercator.mapping["UpperLeftCornerY"] = "1860000.0";
  expect(mercator, place(40.1, lat), kA * 0.1 * kRadian, y - 1860000 + 10000);
}

TEST_P(IsisPlace, ConicAndTransverseMapsAgreeWithProj) {
  const std::string body = " +lon_0=40 +a=3396190 +b=3376200";
  const auto own = [&](double lat) { return GetParam().planetographic ? lat : graphic(lat); };
  const auto text = [](double value) {
    std::ostringstream out;
    out << std::setprecision(17) << value;
    return out.str();
  };
  for (const auto& [name, words] :
       {std::pair<std::string, std::string>{"TransverseMercator", "tmerc +lat_0=" + text(own(20))},
        {"LambertConformal",
         "lcc +lat_0=" + text(own(20)) + " +lat_1=" + text(own(10)) + " +lat_2=" + text(own(50))},
        {"LambertAzimuthalEqualArea", "laea +lat_0=" + text(own(20))}}) {
    Cube each = cube(name);
    each.mapping["CenterLatitude"] = "20.0";
    each.mapping["FirstStandardParallel"] = "10.0";
    each.mapping["SecondStandardParallel"] = "50.0";
    const source_files::Proj proj("+proj=" + words + body);
    const glm::dvec2 xy = proj.forward({40.2, own(20.3)});
    expect(each, place(40.2, 20.3), xy.x, xy.y);
  }
}

INSTANTIATE_TEST_SUITE_P(Labels, IsisPlace,
                         ::testing::Values(Counted{false, false}, Counted{false, true}, Counted{true, false},
                                           Counted{true, true}));

TEST(IsisCube, WestPositivePerspectiveIsShiftedAndObliqueRefused) {
  const test_support::TempDir folder;
  Cube cube;
  cube.mapping["ProjectionName"] = "PointPerspective";
  cube.mapping["Distance"] = "20000.0 <kilometers>";
  cube.mapping["CenterLatitude"] = "10.0";
  cube.mapping["PolarRadius"] = "3396190.0 <meters>";
  const std::string east = write_flat(folder / "e.cub", cube);
  cube.mapping["LongitudeDirection"] = "PositiveWest";
  cube.mapping["CenterLongitude"] = "320.0";
  const std::string west = write_flat(folder / "w.cub", cube);
  const glm::dvec2 a = pds_files::pixel_of(mars::GdalRaster(east), {40.05, 10.08});
  const glm::dvec2 b = pds_files::pixel_of(mars::GdalRaster(west), {40.05, 10.08});
  EXPECT_NEAR(a.x, b.x, 1e-6);
  EXPECT_NEAR(a.y, b.y, 1e-6);
  EXPECT_NEAR(a.x, 9.5 + 0.05 * 59.27 * std::cos(10 * kRadian), 0.1);
  cube.mapping["ProjectionName"] = "ObliqueCylindrical";
  const std::string message = source_files::elevation_error(write_flat(folder / "o.cub", cube));
  EXPECT_NE(message.find("counts longitudes to the west"), std::string::npos) << message;
}

// ---- Values

template <class T>
void expect_values(const char* type, const char* order, const std::vector<T>& special, T low, T step) {
  const test_support::TempDir folder;
  Cube cube;
  cube.type = type;
  cube.order = order;
  cube.base = -250;
  cube.multiplier = 0.5;
  std::vector<T> stored(kSide * kSide);
  for (std::size_t i = 0; i < stored.size(); ++i)
    stored[i] = static_cast<T>(low + static_cast<T>(i % 100) * step);
  for (std::size_t i = 0; i < special.size(); ++i) stored[3 * i + 1] = special[i];
  const std::string path = write_cube(folder / "v.cub", cube, stored);
  const auto source = mars::open_elevation(path);
  const auto image = mars::open_image(path);
  const mars::GdalRaster raster(path);
  for (std::size_t i = 0; i < stored.size(); ++i) {
    const glm::dvec2 pixel(static_cast<double>(i % kSide), static_cast<double>(i / kSide));
    glm::dvec3 direction;
    raster.georeference().to_directions({&pixel, 1}, {&direction, 1});
    const double height_m = height_at(*source, mars::lon_lat(direction));
    const bool nodata = std::find(special.begin(), special.end(), stored[i]) != special.end();
    ASSERT_EQ(std::isnan(height_m), nodata) << type << " " << i << " " << +stored[i];
    if (!nodata) {
      EXPECT_NEAR(height_m, -250 + 0.5 * static_cast<double>(stored[i]), 2e-3);
    }
    if (sizeof(T) > 1) {
      vpe::base::Rgb colour;
      std::uint8_t alpha = 0;
      image->sample({&direction, 1}, 1000, {&colour, 1}, {&alpha, 1});
      EXPECT_EQ(alpha > 128, !nodata) << type << " " << i << " " << +stored[i];
    }
  }
}

float special_real(std::uint32_t bits) {
  float value = 0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

TEST(IsisCube, BaseMultiplierAndEverySpecialPixelOfEachType) {
  for (const char* order : {"Lsb", "Msb"}) {
    expect_values<std::uint8_t>("UnsignedByte", order, {0, 255}, 1, 2);
    expect_values<std::int16_t>("SignedWord", order, {-32768, -32767, -32766, -32765, -32764}, -32752, 655);
    expect_values<std::uint16_t>("UnsignedWord", order, {0, 1, 2, 65534, 65535}, 3, 655);
    expect_values<float>("Real", order,
                         {special_real(0xFF7FFFFB), special_real(0xFF7FFFFC), special_real(0xFF7FFFFD),
                          special_real(0xFF7FFFFE), special_real(0xFF7FFFFF)},
                         -4500.0F, 37.25F);
  }
}

// ---- ISIS2

// Offsets of ISIS2 labels have the other sign, as GDAL reads them: the place of the first pixel from the
// origin.
std::string isis2(const std::string& more) {
  std::string text =
      "CCSD3ZF0000100000001NJPL3IF0PDS200000001 = SFDU_LABEL\r\nRECORD_TYPE = FIXED_LENGTH\r\n"
      "RECORD_BYTES = 512\r\nLABEL_RECORDS = 8\r\n^QUBE = 9\r\nOBJECT = QUBE\r\n AXES = 3\r\n"
      " AXIS_NAME = (SAMPLE,LINE,BAND)\r\n CORE_ITEMS = (20,20,1)\r\n CORE_ITEM_BYTES = 2\r\n"
      " CORE_ITEM_TYPE = SUN_INTEGER\r\n CORE_BASE = 100.0\r\n CORE_MULTIPLIER = 0.5\r\n"
      " SUFFIX_ITEMS = (0,0,0)\r\n GROUP = IMAGE_MAP_PROJECTION\r\n"
      "  MAP_PROJECTION_TYPE = SINUSOIDAL\r\n  A_AXIS_RADIUS = 3396.19\r\n"
      "  B_AXIS_RADIUS = 3396.19\r\n  C_AXIS_RADIUS = 3376.20\r\n  MAP_SCALE = 20.0\r\n"
      "  MAP_RESOLUTION = 2.9637\r\n  LINE_PROJECTION_OFFSET = -134.5\r\n"
      "  SAMPLE_PROJECTION_OFFSET = -9.5\r\n" +
      more + " END_GROUP\r\nEND_OBJECT\r\nEND\r\n";
  text.resize(4096, ' ');
  for (int i = 0; i < kSide * kSide; ++i) {
    const int stored = i == 45 ? -32767 : 7 * i;
    text += static_cast<char>(stored >> 8);
    text += static_cast<char>(stored);
  }
  return text;
}

TEST(Isis2, WestPlanetographicLabelBaseMultiplierAndSpecialPixels) {
  const test_support::TempDir folder;
  source_files::write_text(folder / "e.cub",
                           isis2("  CENTER_LONGITUDE = 40.0\r\n  POSITIVE_LONGITUDE_DIRECTION = EAST\r\n"
                                 "  PROJECTION_LATITUDE_TYPE = PLANETOCENTRIC\r\n"));
  source_files::write_text(folder / "w.cub",
                           isis2("  CENTER_LONGITUDE = 320.0\r\n  POSITIVE_LONGITUDE_DIRECTION = WEST\r\n"
                                 "  PROJECTION_LATITUDE_TYPE = PLANETOGRAPHIC\r\n"));
  const mars::GdalRaster east((folder / "e.cub").string());
  const mars::GdalRaster west((folder / "w.cub").string());
  const glm::dvec2 a = pds_files::pixel_of(east, {41.25, 43.5});
  const glm::dvec2 b = pds_files::pixel_of(west, {41.25, centric(43.5)});
  EXPECT_NEAR(a.x, b.x, 1e-6);
  EXPECT_NEAR(a.y, b.y, 1e-6);
  EXPECT_NEAR(a.x, 9.5 + kA * 1.25 * kRadian * std::cos(43.5 * kRadian) / 20000, 1e-6);
  EXPECT_NEAR(a.y, 134.5 - kA * 43.5 * kRadian / 20000, 1e-6);
  const auto source = mars::open_elevation((folder / "w.cub").string());
  const auto value = [&](int column, int row) {
    const glm::dvec2 at(column, row);
    glm::dvec3 direction;
    west.georeference().to_directions({&at, 1}, {&direction, 1});
    return height_at(*source, mars::lon_lat(direction));
  };
  EXPECT_NEAR(value(12, 9), 100 + 0.5 * 7 * (9 * 20 + 12), 1e-3);
  EXPECT_TRUE(std::isnan(value(5, 2)));
}

// ---- VICAR and PDS4, as GDAL writes them

// GDAL's writers warn about templates.
class Quiet {
 public:
  Quiet() { CPLPushErrorHandler(CPLQuietErrorHandler); }
  ~Quiet() { CPLPopErrorHandler(); }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;
};

source_files::Raster made(const std::string& driver, const std::string& crs, std::vector<std::string> options) {
  source_files::Raster raster;
  raster.width = raster.height = 20;
  raster.type = GDT_Float32;
  raster.driver = driver;
  raster.crs = crs;
  raster.options = std::move(options);
  raster.geotransform = source_files::box(-200000, 2700000, 200000, 2300000, 20, 20);
  raster.value = [](int, int column, int row) { return 100 * column - 7 * row; };
  return raster;
}

TEST(Vicar, WestAndPlanetographicLabels) {
  const test_support::TempDir folder;
  const std::string sphere = "+proj=sinu +lon_0=20 +R=3396190";
  const std::string plain = source_files::write(folder / "p.vic", made("VICAR", sphere, {}));
  const mars::LonLat place{21.5, 44};
  const glm::dvec2 east = pds_files::pixel_of(mars::GdalRaster(plain), place);
  EXPECT_NEAR(east.x, (kA * 1.5 * kRadian * std::cos(44 * kRadian) + 200000) / 20000 - 0.5, 1e-6);
  EXPECT_NEAR(east.y, (2700000 - kA * 44 * kRadian) / 20000 - 0.5, 1e-6);
  // GDAL writes CENTER_LONGITUDE as it is: this label says 20 degrees west.
  const std::string west =
      source_files::write(folder / "w.vic", made("VICAR", sphere, {"POSITIVE_LONGITUDE_DIRECTION=WEST"}));
  const glm::dvec2 turned = pds_files::pixel_of(mars::GdalRaster(west), {-20 + 1.5, 44});
  EXPECT_NEAR(turned.x, east.x, 1e-6);
  EXPECT_NEAR(turned.y, east.y, 1e-6);
  // The same with planetographic latitudes, on a body whose radii in the label are edited to be flattened.
  std::string text;
  {
    const std::string graphic_path =
        source_files::write(folder / "g.vic", made("VICAR", sphere, {"COORDINATE_SYSTEM_NAME=PLANETOGRAPHIC"}));
    std::ifstream in(graphic_path, std::ios::binary);
    text.assign((std::istreambuf_iterator<char>(in)), {});
  }
  const std::size_t at = text.find("C_AXIS_RADIUS=3396.19");
  ASSERT_NE(at, std::string::npos);
  text.replace(at, 21, "C_AXIS_RADIUS=3376.20");
  source_files::write_text(folder / "g.vic", text);
  const glm::dvec2 flat =
      pds_files::pixel_of(mars::GdalRaster((folder / "g.vic").string()), {21.5, centric(44)});
  EXPECT_NEAR(flat.x, east.x, 1e-6);
  EXPECT_NEAR(flat.y, east.y, 1e-6);
}

TEST(Pds4, RawAndTiffInEitherDirectionWithNodataAndScale) {
  const Quiet quiet;
  const test_support::TempDir folder;
  const std::string sphere = "+proj=sinu +lon_0=20 +R=3396190";
  int number = 0;
  for (const char* format : {"IMAGE_FORMAT=RAW", "IMAGE_FORMAT=GEOTIFF"}) {
    for (const char* way : {"LONGITUDE_DIRECTION=Positive East", "LONGITUDE_DIRECTION=Positive West"}) {
      for (const char* kind : {"LATITUDE_TYPE=Planetocentric", "LATITUDE_TYPE=Planetographic"}) {
        // RADII flattens the body in the label; centric latitudes then stay as they are.
        source_files::Raster raster = made("PDS4", sphere, {format, way, kind, "RADII=3396190,3376200"});
        raster.type = GDT_Int16;
        raster.nodata = -32768;
        raster.scale = 0.25;
        raster.offset = -100;
        raster.value = [](int, int column, int row) {
          return column == 7 && row == 3 ? -32768 : 100 * column - 7 * row;
        };
        const std::string path = source_files::write(folder / (std::to_string(number++) + ".xml"), raster);
        const mars::GdalRaster opened(path);
        const bool planetographic = std::strstr(kind, "graphic") != nullptr;
        const glm::dvec2 pixel = pds_files::pixel_of(opened, {21.5, planetographic ? centric(44) : 44});
        EXPECT_NEAR(pixel.x, (kA * 1.5 * kRadian * std::cos(44 * kRadian) + 200000) / 20000 - 0.5, 1e-6)
            << way << kind;
        EXPECT_NEAR(pixel.y, (2700000 - kA * 44 * kRadian) / 20000 - 0.5, 1e-6) << way << kind;
        const auto source = mars::open_elevation(path);
        const auto value = [&](double column, double row) {
          const glm::dvec2 at(column, row);
          glm::dvec3 direction;
          opened.georeference().to_directions({&at, 1}, {&direction, 1});
          return height_at(*source, mars::lon_lat(direction));
        };
        EXPECT_NEAR(value(4, 9), 0.25 * (400 - 63) - 100, 1e-6) << format;
        EXPECT_TRUE(std::isnan(value(7, 3))) << format;
      }
    }
  }
}

TEST(TriaxialBody, PlanetographicLatitudesAreRefused) {
  const test_support::TempDir folder;
  const std::string path = source_files::write(
      folder / "v.vic",
      made("VICAR", "+proj=sinu +lon_0=20 +R=3396190", {"COORDINATE_SYSTEM_NAME=PLANETOGRAPHIC"}));
  std::ifstream in(path, std::ios::binary);
  std::string text((std::istreambuf_iterator<char>(in)), {});
  in.close();
  text.replace(text.find("B_AXIS_RADIUS=3396.19"), 21, "B_AXIS_RADIUS=3390.00");
  source_files::write_text(folder / "v.vic", text);
  const std::string message = source_files::elevation_error(path);
  EXPECT_NE(message.find("triaxial body"), std::string::npos) << message;
}

}  // namespace
