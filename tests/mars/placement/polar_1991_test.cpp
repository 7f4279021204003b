// Polar maps with labels of 1991, with PROJ and the equations of the catalogues as oracles.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <iomanip>
#include <optional>
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
using source_files::Proj;

constexpr double kRadian = mars::kRadiansPerDegree;
constexpr double kA_m = 3393400;
constexpr double kC_m = 3375730;
constexpr int kSide = 300;
constexpr double kPixel_m = kA_m * kRadian / 4;  // 4 pixels a degree
constexpr double kCentreWest_deg = 30;

struct Case {
  bool south = false;
  bool west = true;
  double edge = 0;      // coordinate of the outer edge of the first pixel
  double off_line = 0;  // pixels from the middle of the image to the pole
  double off_sample = 0;
  bool sphere = false;
};

std::string number(double value) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(6) << value;
  return out.str();
}

// tan(planetocentric latitude) / tan(latitude of the label).
double centric_scale(const Case& c) { return c.west && !c.sphere ? kC_m / kA_m * (kC_m / kA_m) : 1.0; }

std::string proj_words(const Case& c) {
  const char* pole = c.south ? "-90" : "90";
  const double lon_0 = c.west ? -kCentreWest_deg : kCentreWest_deg;
  const std::string figure = c.sphere ? " +R=3393400" : c.west ? " +a=3393400 +b=3375730" : " +R=3375730";
  return std::string("+proj=stere +lat_0=") + pole + " +lat_ts=" + pole + " +lon_0=" + number(lon_0) + figure;
}

Label polar_label(const Case& c) {
  Label label;
  label.first = "CCSD3ZF0000100000001NJPL3IF0PDS200000001 = SFDU_LABEL";
  label.file = {{"RECORD_TYPE", "FIXED_LENGTH"},
                {"RECORD_BYTES", std::to_string(2 * kSide)},
                {"DATA_SET_ID", c.edge == 1 ? "\"VO1/VO2-M-VIS-5-DIM-V2.0\"" : "\"VO1/VO2-M-VIS-5-DIM-V1.0\""},
                {"TARGET_NAME", "MARS"}};
  label.image = {{"LINES", std::to_string(kSide)},
                 {"LINE_SAMPLES", std::to_string(kSide)},
                 {"SAMPLE_TYPE", "INTEGER"},
                 {"SAMPLE_BITS", "16"}};
  label.map_object = "IMAGE_MAP_PROJECTION_CATALOG";
  label.map = {{"MAP_PROJECTION_TYPE", "'POLAR_STEREOGRAPHIC'"},
               {"MAP_RESOLUTION", "4<PIXEL/DEG>"},
               {"MAP_SCALE", "14.806501<KM/PIXEL>"},
               {"MAXIMUM_LATITUDE", c.south ? "-55.0" : "90.0"},
               {"MINIMUM_LATITUDE", c.south ? "-90.0" : "55.0"},
               {"X_AXIS_PROJECTION_OFFSET", number(kSide / 2.0 + c.off_line + c.edge)},
               {"Y_AXIS_PROJECTION_OFFSET", number(kSide / 2.0 + c.off_sample + c.edge)},
               {"A_AXIS_RADIUS", "3393.40"},
               {"B_AXIS_RADIUS", "3393.40"},
               {"C_AXIS_RADIUS", c.sphere ? "3393.40" : "3375.73"},
               {"POSITIVE_LONGITUDE_DIRECTION", c.west ? "WEST" : "EAST"},
               {"CENTER_LATITUDE", c.south ? "-90.0" : "90.0"},
               {"CENTER_LONGITUDE", number(kCentreWest_deg)},
               {"MAP_PROJECTION_ROTATION", "\"N/A\""}};
  return label;
}

// Where the equations of the catalogues put a place of the label, counted from 0 at the centre of the first pixel.
// They hold for spheres.
glm::dvec2 by_catalogue(const Case& c, double lat_deg, double lon_deg) {
  const double turn = (c.west ? -1 : 1) * (lon_deg - kCentreWest_deg) * kRadian;
  const double away = 2 * kA_m / kPixel_m * std::tan(mars::kPi / 4 - std::abs(lat_deg) * kRadian / 2);
  const double sample = kSide / 2.0 + c.off_sample + away * std::sin(turn) + 0.5;
  const double line = kSide / 2.0 + c.off_line + (c.south ? -1 : 1) * away * std::cos(turn) + 0.5;
  return {sample - 1, line - 1};
}

// Smooth, without symmetry that could hide a mirrored planet.
double ground_m(const glm::dvec3& d) { return 3000 * d.x + 2000 * d.y - 900 * d.x * d.y + 500 * d.z; }

glm::dvec3 direction_of(const Case& c, double lat_deg, double lon_deg) {
  const glm::dvec3 d = mars::direction({c.west ? -lon_deg : lon_deg, lat_deg});
  return glm::normalize(glm::dvec3(d.x, d.y, d.z * centric_scale(c)));
}

// Writes a map of ground_m(), placed by PROJ.
std::string write_map(const std::filesystem::path& folder, const Case& c, const Label& label) {
  const Proj proj(proj_words(c));
  return pds_files::write(folder, "polar", label, [&](int column, int row) {
    const mars::LonLat place = proj.inverse({(column + 0.5 - kSide / 2.0 - c.off_sample) * kPixel_m,
                                             -(row + 0.5 - kSide / 2.0 - c.off_line) * kPixel_m});
    return std::lround(ground_m(direction_of(c, place.lat_deg, c.west ? -place.lon_deg : place.lon_deg)));
  });
}

class Polar1991 : public ::testing::TestWithParam<Case> {};

TEST_P(Polar1991, PlacesLieWhereProjAndTheCataloguePutThem) {
  const Case c = GetParam();
  const test_support::TempDir folder;
  const std::string path = write_map(folder.path(), c, polar_label(c));
  const mars::GdalRaster raster(path);
  const auto source = mars::open_elevation(path);
  const Proj proj(proj_words(c));
  EXPECT_NEAR(source->infos().at(0).resolution_m, kPixel_m, 1e-3);
  const double sign = c.south ? -1 : 1;
  for (const auto& [lat, lon] :
       {std::pair{72.8, 195.5}, {81.0, 45.0}, {87.0, 300.0}, {66.0, 120.0}, {62.5, 17.0}}) {
    const double lat_deg = sign * lat;
    const glm::dvec3 d = direction_of(c, lat_deg, lon);
    const glm::dvec2 pixel = pds_files::pixel_of(raster, mars::lon_lat(d));
    const glm::dvec2 map = proj.forward({c.west ? -lon : lon, lat_deg});
    EXPECT_NEAR(pixel.x, map.x / kPixel_m + kSide / 2.0 + c.off_sample - 0.5, 1e-4) << lat << " " << lon;
    EXPECT_NEAR(pixel.y, -map.y / kPixel_m + kSide / 2.0 + c.off_line - 0.5, 1e-4) << lat << " " << lon;
    if (c.sphere) {
      const glm::dvec2 expected = by_catalogue(c, lat_deg, lon);
      EXPECT_NEAR(pixel.x, expected.x, 1e-4) << lat << " " << lon;
      EXPECT_NEAR(pixel.y, expected.y, 1e-4) << lat << " " << lon;
    }
    // A pixel is worth some 22 m.
    EXPECT_NEAR(source_files::height_at(*source, mars::lon_lat(d)), ground_m(d), 1.0) << lat << " " << lon;
  }
  // East of the meridian that runs down from the north pole or up from the south pole lies to the right.
  const double centre_east = c.west ? -kCentreWest_deg : kCentreWest_deg;
  const glm::dvec2 on = pds_files::pixel_of(raster, {centre_east, sign * 80});
  const glm::dvec2 east = pds_files::pixel_of(raster, {centre_east + 10, sign * 80});
  const glm::dvec2 pole = pds_files::pixel_of(raster, {centre_east, sign * 90});
  EXPECT_NEAR(on.x, pole.x, 1e-6);
  EXPECT_GT(on.y * sign, pole.y * sign);
  EXPECT_GT(east.x, on.x + 5);
}

INSTANTIATE_TEST_SUITE_P(Maps, Polar1991,
                         ::testing::Values(Case{false, true, 0}, Case{true, true, 0},
                                           Case{false, true, 0, 0, 0, true}, Case{true, true, 0, 0, 0, true},
                                           Case{false, true, 1}, Case{true, true, 0.5}, Case{false, false, 0},
                                           Case{true, false, 0, 0, 0, true},
                                           // The pole out of the middle: the version tells the edge.
                                           Case{false, true, 0, 20, -35}, Case{true, true, 1, -10, 5, true}));

TEST(Polar1991Label, OffsetsOfLaterYearsAreTheSame) {
  const Case c;
  Label label = polar_label(c);
  const mars::LabelGeoreference expected = mars::pds_catalog_map("x", mars::parse_pds_label(label.text()));
  label.map["LINE_PROJECTION_OFFSET"] = label.map["X_AXIS_PROJECTION_OFFSET"];
  label.map["SAMPLE_PROJECTION_OFFSET"] = label.map["Y_AXIS_PROJECTION_OFFSET"];
  label.map["MAP_PROJECTION_TYPE"] = "STEREOGRAPHIC";
  label.map.erase("X_AXIS_PROJECTION_OFFSET");
  label.map.erase("Y_AXIS_PROJECTION_OFFSET");
  const mars::LabelGeoreference later = mars::pds_catalog_map("x", mars::parse_pds_label(label.text()));
  EXPECT_EQ(later.crs, expected.crs);
  EXPECT_EQ(later.to_map, expected.to_map);
}

TEST(Polar1991Label, TheScaleIsTheResolutionThatItRounds) {
  const auto pixel_m = [](const char* scale, const char* resolution) {
    Label label = polar_label({});
    label.map["MAP_SCALE"] = scale;
    label.map["MAP_RESOLUTION"] = resolution;
    label.map.erase("MINIMUM_LATITUDE");
    if (resolution[0] == '\0') label.map.erase("MAP_RESOLUTION");
    return (*mars::pds_catalog_map("x", mars::parse_pds_label(label.text())).to_map)[1];
  };
  EXPECT_NEAR(pixel_m("14.81 <KM/PIXEL>", "4"), kPixel_m, 1e-9);
  EXPECT_NEAR(pixel_m("14.7294", "4"), kC_m * kRadian / 4, 1e-9);
  EXPECT_NEAR(pixel_m("14.8841", "4"), kA_m * kA_m / kC_m * kRadian / 4, 1e-9);
  EXPECT_NEAR(pixel_m("14.7800", "4"), 14780, 1e-9);
  EXPECT_NEAR(pixel_m("14.5", ""), 14500, 1e-9);
}

TEST(Polar1991Label, LastDigit) {
  mars::PdsLabel label;
  label.values = {{"A", "0.463 <KM/PIXEL>"}, {"B", "12 <M/PIX>"}, {"C", "\"N/A\""}, {"D", "0.0"}};
  EXPECT_NEAR(mars::pds_last_digit_m(label, "A"), 1, 1e-9);
  EXPECT_NEAR(mars::pds_last_digit_m(label, "B"), 1, 1e-9);
  EXPECT_EQ(mars::pds_last_digit_m(label, "C"), 0);
  EXPECT_TRUE(std::isfinite(mars::pds_last_digit_m(label, "D")));
}

TEST(Polar1991Label, WhatCannotBePlacedIsRefused) {
  const test_support::TempDir folder;
  const auto error = [&](const std::string& key, const std::optional<std::string>& text) {
    Label label = polar_label({});
    if (text) {
      label.map[key] = *text;
    } else {
      label.map.erase(key);
    }
    return source_files::elevation_error(
        pds_files::write(folder.path(), "e", label, [](int, int) { return 5; }));
  };
  EXPECT_EQ(error("B_AXIS_RADIUS", "3393.40"), "");
  using Text = std::optional<std::string>;
  const std::string object = "IMAGE_MAP_PROJECTION_CATALOG.";
  const std::tuple<const char*, Text, std::string> kCases[] = {
      {"CENTER_LATITUDE", std::nullopt, "no usable " + object + "CENTER_LATITUDE"},
      {"CENTER_LATITUDE", "0.0", object + "CENTER_LATITUDE is no pole: 0.0; set it to 90 or -90"},
      {"CENTER_LATITUDE", "-90.0", "offsets and " + object + "MINIMUM_LATITUDE disagree"},
      {"CENTER_LONGITUDE", "\"N/A\"", "no usable " + object + "CENTER_LONGITUDE: N/A"},
      {"POSITIVE_LONGITUDE_DIRECTION", std::nullopt, "no usable " + object + "POSITIVE_LONGITUDE_DIRECTION"},
      {"X_AXIS_PROJECTION_OFFSET", std::nullopt, "no usable " + object + "X_AXIS_PROJECTION_OFFSET"},
      {"SAMPLE_PROJECTION_OFFSET", "12.0",
       object + "Y_AXIS_PROJECTION_OFFSET and SAMPLE_PROJECTION_OFFSET disagree"},
      {"A_AXIS_RADIUS", std::nullopt, "no usable " + object + "A_AXIS_RADIUS"},
      {"C_AXIS_RADIUS", "0", "no usable " + object + "C_AXIS_RADIUS: 0"},
      {"MAP_SCALE", std::nullopt, "no usable " + object + "MAP_SCALE"},
      {"MAP_SCALE", "7.4", object + "MAP_SCALE and MAP_RESOLUTION disagree: 7.4 and 4<PIXEL/DEG>"},
      {"MAP_RESOLUTION", "-4", "no usable " + object + "MAP_RESOLUTION"},
      {"MAP_PROJECTION_ROTATION", "90.0", object + "MAP_PROJECTION_ROTATION: 90.0"},
      {"MAXIMUM_LATITUDE", "85.0", "offsets and " + object + "MAXIMUM_LATITUDE disagree"},
      {"MINIMUM_LATITUDE", "10.0", "offsets and " + object + "MINIMUM_LATITUDE disagree"},
      // A framelet with the offsets of the whole.
      {"X_AXIS_PROJECTION_OFFSET", "5120.0", "disagree"},
  };
  for (const auto& [key, text, words] : kCases) {
    const std::string message = error(key, text);
    EXPECT_NE(message.find(words), std::string::npos) << words << "\n" << message;
    EXPECT_NE(message.find("e.lbl"), std::string::npos) << message;
    EXPECT_NE(message.find("; "), std::string::npos) << message;
  }
}

}  // namespace
