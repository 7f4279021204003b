// Labels of photographs that hold the light of their own sun: the rule, and labels in files.
#include "mars/sources/own_light.h"

#include <gdal_priv.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "mars/raster/gdal/label_keywords.h"
#include "mars/raster/gdal_raster.h"
#include "mars/raster/pds_label.h"
#include "mars/sources/source.h"
#include "tests/mars/source_files.h"
#include "tests/support/labelled_image.h"
#include "tests/support/support.h"

namespace {

using mars::LabelKeyword;

bool says(const std::vector<LabelKeyword>& keywords) { return mars::says_own_light(keywords); }

bool pds3_says(const std::string& text) {
  const mars::PdsLabel label = mars::parse_pds_label(text);
  return says({label.values.begin(), label.values.end()});
}

bool opened_says(const std::string& path) { return mars::open_image(path)->infos().at(0).has_own_light; }

TEST(OwnLight, CamerasInSunlightHaveIt) {
  EXPECT_TRUE(pds3_says(
      "INSTRUMENT_HOST_NAME = \"MARS RECONNAISSANCE ORBITER\"\n"
      "INSTRUMENT_NAME = \"HIGH RESOLUTION IMAGING SCIENCE EXPERIMENT\"\nINSTRUMENT_ID = HIRISE\n"
      "GROUP = VIEWING_PARAMETERS\n INCIDENCE_ANGLE = 58.1 <DEG>\nEND_GROUP = VIEWING_PARAMETERS\nEND\n"));
  EXPECT_TRUE(
      pds3_says("INSTRUMENT_NAME = {VISUAL_IMAGING_SUBSYSTEM_CAMERA_A, VISUAL_IMAGING_SUBSYSTEM_CAMERA_B}\n"
                "NOTE = \"MARS DIGITAL IMAGE MAP\"\nEND\n"));
  for (const char* id : {"CTX", "ctx", "HRSC", "MDIS-NAC", "NACL", "LROC", "\"MOC\""})
    EXPECT_TRUE(says({{"INSTRUMENT_ID", id}})) << id;
  EXPECT_TRUE(says({{"IsisCube.Instrument.InstrumentId", "CTX"}}));
  EXPECT_TRUE(says({{"INSTRUMENT_ID", "THEMIS"},
                    {"INSTRUMENT_NAME", "THERMAL EMISSION IMAGING SYSTEM"},
                    {"DETECTOR_ID", "VIS"}}));
}

TEST(OwnLight, AnglesOfTheSunShowIt) {
  for (const char* name : {"INCIDENCE_ANGLE", "VIEWING_PARAMETERS.INCIDENCE_ANGLE", "SUB_SOLAR_AZIMUTH",
                           "SOLAR_INCIDENCE_ANGLE", "solar_incidence_angle"}) {
    for (const char* angle : {"58.1 <DEG>", "0", "-12.5", "+3", "(58.1, 60.2)", "359.9"})
      EXPECT_TRUE(says({{name, angle}})) << name << " " << angle;
    for (const char* angle : {"", "N/A", "\"UNK\"", "-9998", "1e32", "-1.79769313e+308", "NULL", "<DEG>"})
      EXPECT_FALSE(says({{name, angle}})) << name << " " << angle;
  }
  EXPECT_FALSE(says({{"EMISSION_ANGLE", "12"}}));
}

// The season tells of one time only where that is stated too.
TEST(OwnLight, ASeasonWithATimeShowsIt) {
  EXPECT_TRUE(says({{"SOLAR_LONGITUDE", "153.2 <DEG>"}, {"START_TIME", "2007-01-09T12:33:01"}}));
  EXPECT_TRUE(says({{"solar_longitude", "153.2"}, {"start_date_time", "2007-01-09T12:33:01Z"}}));
  EXPECT_FALSE(says({{"SOLAR_LONGITUDE", "153.2 <DEG>"}}));
  EXPECT_FALSE(says({{"SOLAR_LONGITUDE", "153.2 <DEG>"}, {"START_TIME", "\"N/A\""}}));
  EXPECT_FALSE(says({{"SOLAR_LONGITUDE", "N/A"}, {"START_TIME", "2007-01-09T12:33:01"}}));
  EXPECT_FALSE(says({{"START_TIME", "2007-01-09T12:33:01"}}));
}

TEST(OwnLight, InstrumentsWithoutTheSunHaveNone) {
  for (const char* instrument :
       {"MARS ORBITER LASER ALTIMETER", "RADAR SYSTEM", "SYNTHETIC APERTURE RADAR IMAGER",
        "GAMMA RAY SPECTROMETER", "THERMAL EMISSION IMAGING SYSTEM"}) {
    EXPECT_FALSE(says({{"INSTRUMENT_NAME", instrument}, {"INCIDENCE_ANGLE", "45.0"}})) << instrument;
  }
  EXPECT_FALSE(says({{"InstrumentId", "THEMIS_IR"}, {"IncidenceAngle", "70"}}));
  EXPECT_FALSE(says({{"INSTRUMENT_NAME", "SPICAM"}}));
  EXPECT_FALSE(says({}));
}

TEST(OwnLight, NormalisedImagesHaveNone) {
  const LabelKeyword camera{"INSTRUMENT_ID", "HRSC"};
  for (const char* none : {"NONE", "none", "\"N/A\"", "NULL", "UNK", "NO", "false", ""})
    EXPECT_TRUE(says({camera, {"PHOTOMETRIC_CORRECTION_TYPE", none}})) << none;
  for (const char* name : {"PHOTOMETRIC_CORRECTION_TYPE", "IMAGE.PHOTOMETRIC_CORRECTION_TYPE",
                           "photometric_correction_flag", "PhotometricNormalization"}) {
    EXPECT_FALSE(says({camera, {name, "LUNAR-LAMBERT"}})) << name;
    EXPECT_FALSE(says({camera, {name, "true"}})) << name;
  }
  for (const char* name :
       {"IMAGE.NAME", "title", "PRODUCT_TYPE", "DATA_SET_NAME", "IMAGE.DESCRIPTION", "NOTE"}) {
    for (const char* text : {"Bolometric albedo", "Mosaic, brightness-normalised", "NORMALIZED REFLECTANCE",
                             "photometrically corrected frames"})
      EXPECT_FALSE(says({camera, {name, text}})) << name << " " << text;
    EXPECT_TRUE(says({camera, {name, "Calibrated radiance"}})) << name;
  }
  // What a label says about the place does not count.
  EXPECT_TRUE(says({camera, {"RATIONALE_DESC", "Low-albedo dunes on normalized terrain"}}));
}

TEST(OwnLight, HeightsHaveNone) {
  EXPECT_FALSE(
      pds3_says("INSTRUMENT_ID = HRSC\nINCIDENCE_ANGLE = 40\nGROUP = DTM\n DTM_MISSING_DN = -32768\n"
                "END_GROUP = DTM\nEND\n"));
  const LabelKeyword camera{"INSTRUMENT_NAME", "CONTEXT CAMERA"};
  for (const char* name :
       {"DIGITAL_TERRAIN_MODEL", "CTX DTM of Gale", "MEDIAN_TOPOGRAPHY", "Elevation", "PLANETARY_RADIUS"})
    EXPECT_FALSE(says({camera, {"NAME", name}})) << name;
  for (const char* unit : {"m", "METERS", "\"METER\"", "km"})
    EXPECT_FALSE(says({camera, {"IMAGE.UNIT", unit}})) << unit;
  EXPECT_TRUE(says({camera, {"IMAGE.UNIT", "I/F"}}));
  EXPECT_TRUE(says({camera, {"NAME", "DEMONSTRATION"}}));
}

TEST(OwnLight, Pds3ImagesStateIt) {
  const test_support::TempDir folder;
  using test_support::write_labelled_image;
  EXPECT_TRUE(opened_says(write_labelled_image(folder.path(), "photo", test_support::kCameraKeywords)));
  EXPECT_FALSE(opened_says(write_labelled_image(folder.path(), "plain", "")));
  EXPECT_FALSE(opened_says(
      write_labelled_image(folder.path(), "corrected",
                           test_support::kCameraKeywords + "PHOTOMETRIC_CORRECTION_TYPE = MINNAERT\r\n")));
}

// ---- ISIS

std::string write_cube(const std::filesystem::path& path, const std::string& groups) {
  std::string text =
      "Object = IsisCube\n  Object = Core\n    StartByte = 8193\n    Format = BandSequential\n"
      "    Group = Dimensions\n      Samples = 20\n      Lines = 20\n      Bands = 1\n    End_Group\n"
      "    Group = Pixels\n      Type = UnsignedByte\n      ByteOrder = Lsb\n      Base = 0.0\n"
      "      Multiplier = 1.0\n    End_Group\n  End_Object\n" +
      groups +
      "  Group = Mapping\n    TargetName = Mars\n    ProjectionName = Sinusoidal\n"
      "    EquatorialRadius = 3396190.0 <meters>\n    PolarRadius = 3376200.0 <meters>\n"
      "    LatitudeType = Planetocentric\n    LongitudeDirection = PositiveEast\n    LongitudeDomain = 360\n"
      "    CenterLongitude = 40.0\n    PixelResolution = 1000.0 <meters/pixel>\n    Scale = 59.27 <pixels/degree>\n"
      "    UpperLeftCornerX = -10000.0 <meters>\n    UpperLeftCornerY = 10000.0 <meters>\n  End_Group\n"
      "End_Object\nEnd\n";
  text.resize(8192, '\0');
  for (int n = 0; n < 400; ++n) text += static_cast<char>(1 + n % 100);
  source_files::write_text(path, text);
  return path.string();
}

TEST(OwnLight, IsisCubesStateIt) {
  const test_support::TempDir folder;
  const std::string camera =
      write_cube(folder / "camera.cub",
                 "  Group = Instrument\n    SpacecraftName = Mars_Reconnaissance_Orbiter\n"
                 "    InstrumentId = CTX\n    StartTime = 2007-01-09T12:33:01.501\n  End_Group\n");
  EXPECT_TRUE(opened_says(camera));
  const mars::GdalRaster raster(camera);
  const std::vector<LabelKeyword> keywords = mars::label_keywords(*raster.acquire());
  EXPECT_EQ(std::ranges::count(keywords, LabelKeyword("InstrumentId", "CTX")), 1);
  EXPECT_EQ(std::ranges::count(keywords, LabelKeyword("TargetName", "Mars")), 1);
  // A value with its unit.
  EXPECT_TRUE(opened_says(write_cube(
      folder / "angle.cub", "  Group = Photometry\n    IncidenceAngle = 55.25 <degrees>\n  End_Group\n")));
  EXPECT_FALSE(opened_says(write_cube(folder / "mosaic.cub", "")));
  EXPECT_FALSE(opened_says(
      write_cube(folder / "heat.cub",
                 "  Group = Instrument\n    InstrumentId = THEMIS_IR\n    StartTime = 2007-01-09T12:33:01\n"
                 "  End_Group\n")));
}

// ---- PDS4, as GDAL writes it

class Quiet {
 public:
  Quiet() { CPLPushErrorHandler(CPLQuietErrorHandler); }
  ~Quiet() { CPLPopErrorHandler(); }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;
};

std::string write_pds4(const std::filesystem::path& path, const std::string& after_spacecraft) {
  const Quiet quiet;
  source_files::Raster raster;
  raster.width = raster.height = 20;
  raster.type = GDT_Byte;
  raster.driver = "PDS4";
  raster.crs = "+proj=sinu +lon_0=20 +R=3396190";
  raster.options = {"IMAGE_FORMAT=RAW"};
  raster.geotransform = source_files::box(-200000, 2700000, 200000, 2300000, 20, 20);
  raster.value = [](int, int column, int row) { return 5 + 10 * column + row; };
  source_files::write(path, raster);
  std::ifstream in(path, std::ios::binary);
  std::string text((std::istreambuf_iterator<char>(in)), {});
  in.close();
  const std::string end = "</Observing_System_Component>";
  const std::size_t at = text.find(end);
  EXPECT_NE(at, std::string::npos) << text;
  if (at != std::string::npos) text.insert(at + end.size(), after_spacecraft);
  source_files::write_text(path, text);
  return path.string();
}

std::string component(const std::string& name, const std::string& type) {
  return "<Observing_System_Component><name>" + name + "</name><type>" + type +
         "</type></Observing_System_Component>";
}

TEST(OwnLight, Pds4ImagesStateIt) {
  const test_support::TempDir folder;
  const std::string camera = write_pds4(folder / "camera.xml", component("Context Camera (CTX)", "Instrument"));
  EXPECT_TRUE(opened_says(camera));
  const mars::GdalRaster raster(camera);
  const std::vector<LabelKeyword> keywords = mars::label_keywords(*raster.acquire());
  EXPECT_EQ(std::ranges::count(keywords, LabelKeyword("INSTRUMENT_NAME", "Context Camera (CTX)")), 1);
  EXPECT_FALSE(opened_says(write_pds4(folder / "plain.xml", "")));
  EXPECT_FALSE(opened_says(write_pds4(folder / "host.xml", component("Imaging Orbiter", "Host"))));
  EXPECT_FALSE(opened_says(write_pds4(folder / "laser.xml", component("Laser Altimeter", "Instrument"))));
  EXPECT_FALSE(opened_says(write_pds4(folder / "corrected.xml",
                                      component("Context Camera (CTX)", "Instrument") +
                                          "<photometric_correction_flag>true</photometric_correction_flag>")));
}

TEST(OwnLight, RastersWithoutALabelStateNone) {
  const test_support::TempDir folder;
  source_files::Raster raster;
  raster.width = 36;
  raster.height = 18;
  raster.type = GDT_Byte;
  raster.geotransform = source_files::box(-180, 90, 180, -90, 36, 18);
  raster.value = [](int, int column, int row) { return 5 + 4 * column + row; };
  const std::string path = source_files::write(folder / "plain.tif", raster);
  EXPECT_FALSE(opened_says(path));
  const mars::GdalRaster opened(path);
  EXPECT_TRUE(mars::label_keywords(*opened.acquire()).empty());
}

}  // namespace
