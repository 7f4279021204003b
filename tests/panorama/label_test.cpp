// Labels of rover mosaics.
#include "panorama/metadata/label.h"

#include <cmath>

#include "tests/panorama/test_images.h"

namespace {

using panorama::MapKind;
using panorama::PanoramaMap;
using panorama::RoverLabel;
using panorama_test::message_of;

// A mosaic of 4646 x 1182 at 12.9059 pixels a degree, as its label describes it.
const std::string kParms =
    "GROUP = SURFACE_PROJECTION_PARMS\r\n"
    "  MAP_PROJECTION_TYPE         = CYLINDRICAL\r\n"
    "  MAP_RESOLUTION              = (12.9059 <pix/deg>, 12.9059 <pix/deg>)\r\n"
    "  MAXIMUM_ELEVATION           = 69.9294 <deg>\r\n"
    "  MINIMUM_ELEVATION           = -21.673 <deg>\r\n"
    "  PROJECTION_ORIGIN_VECTOR    = (1.5, -2.5, -1.9)\r\n"
    "  REFERENCE_COORD_SYSTEM_NAME = \"SITE_FRAME\"\r\n"
    "  START_AZIMUTH               = 0.0 <deg>\r\n"
    "  STOP_AZIMUTH                = 360.0 <deg>\r\n"
    "  ZERO_ELEVATION_LINE         = 903.503 <pixel>\r\n"
    "END_GROUP = SURFACE_PROJECTION_PARMS\r\n";
const std::string kPds3 =
    "PDS_VERSION_ID = PDS3\r\nINSTRUMENT_AZIMUTH = 191.0 <deg>\r\n"
    "OBJECT = IMAGE\r\n  LINES = 1182\r\n  LINE_SAMPLES = 4646\r\nEND_OBJECT = IMAGE\r\n" +
    kParms + "END\r\n";
const std::string kVicar =
    "LBLSIZE=2048            FORMAT='BYTE'  TYPE='IMAGE'  NL=1182  NS=4646  NB=3  HOST='X86-''64'  "
    "PROPERTY='IDENTIFICATION'  START_AZIMUTH=77.0  "
    "PROPERTY='SURFACE_PROJECTION_PARMS'  MAP_PROJECTION_TYPE='CYLINDRICAL'  MAP_RESOLUTION=(12.9059, 12.9059) "
    " "
    "MAP_RESOLUTION__UNIT=('PIXEL/DEG', 'PIXEL/DEG')  MAXIMUM_ELEVATION=69.9294  MINIMUM_ELEVATION=-21.673  "
    "START_AZIMUTH=0.0  STOP_AZIMUTH=360.0  START_AZIMUTH__UNIT='deg'  ZERO_ELEVATION_LINE=903.503  "
    "REFERENCE_COORD_SYSTEM_NAME='SITE_FRAME'  TASK='MARSMAP'  USER='x'  START_AZIMUTH=55.0  " +
    std::string(3, '\0') + "junk=1";
const std::string kPds4 =
    "<?xml version='1.0' encoding='UTF-8'?><Product_Observational xmlns='http://pds.nasa.gov/pds4/pds/v1' "
    "xmlns:cart='http://pds.nasa.gov/pds4/cart/v1' xmlns:geom='http://pds.nasa.gov/pds4/geom/v1'>"
    "<cart:Map_Projection_Lander><cart:lander_map_projection_name>Cylindrical</cart:lander_map_projection_name>"
    "<geom:Coordinate_Space_Reference><geom:Coordinate_Space_Indexed>"
    "<geom:coordinate_space_frame_type>SITE_FRAME</geom:coordinate_space_frame_type>"
    "</geom:Coordinate_Space_Indexed></geom:Coordinate_Space_Reference>"
    "<cart:Cylindrical><cart:pixel_scale_x unit='pixel/deg'>12.9059</cart:pixel_scale_x>"
    "<cart:pixel_scale_y unit='pixel/deg'>12.9059</cart:pixel_scale_y>"
    "<cart:maximum_elevation unit='deg'>69.9294</cart:maximum_elevation>"
    "<cart:minimum_elevation unit='deg'>-21.673</cart:minimum_elevation>"
    "<cart:start_azimuth unit='deg'>0.0</cart:start_azimuth><cart:stop_azimuth "
    "unit='deg'>360.0</cart:stop_azimuth>"
    "<cart:zero_elevation_line unit='pixel'>903.503</cart:zero_elevation_line></cart:Cylindrical>"
    "</cart:Map_Projection_Lander><Array_3D_Image>"
    "<Axis_Array><axis_name>Band</axis_name><elements>3</elements></Axis_Array>"
    "<Axis_Array><axis_name>Line</axis_name><elements>1182</elements></Axis_Array>"
    "<Axis_Array><axis_name>Sample</axis_name><elements>4646</elements></Axis_Array>"
    "</Array_3D_Image></Product_Observational>";

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return at == std::string::npos ? text : text.replace(at, what.size(), with);
}

void expect_the_mosaic(const std::optional<RoverLabel>& label) {
  ASSERT_TRUE(label);
  EXPECT_EQ(label->lines, 1182);
  EXPECT_EQ(label->samples, 4646);
  EXPECT_EQ(label->frame, "SITE_FRAME");
  EXPECT_EQ(label->stop_azimuth_deg, 360.0);
  const PanoramaMap map = panorama::map_of(*label, 4646, 1182);
  EXPECT_EQ(map.kind, MapKind::kEquirectangular);
  EXPECT_TRUE(map.is_full_turn());
  // The centre of the first pixel.
  EXPECT_NEAR(map.to_direction(0.5, 0.5).azimuth_deg, 0.0, 1e-9);
  EXPECT_NEAR(map.to_direction(0.5, 0.5).elevation_deg, 69.9294, 0.001);
  // azimuth = sample / resolution + start, sample 1161; elevation = (zero - line) / resolution, line 1000.
  EXPECT_NEAR(map.to_direction(1161.5, 999.5).azimuth_deg, 1161 / 12.9059, 1e-9);
  EXPECT_NEAR(map.to_direction(1161.5, 999.5).elevation_deg, (903.503 - 1000) / 12.9059, 1e-9);
}

TEST(RoverLabel, OfThreeKindsGiveTheSameMap) {
  expect_the_mosaic(panorama::read_text_label(kPds3));
  expect_the_mosaic(panorama::read_text_label(kVicar));
  expect_the_mosaic(panorama::read_pds4_label(kPds4));
  // The group's other spelling.
  std::string other = kPds3;
  for (std::size_t at = 0; (at = other.find("_PARMS", at)) != std::string::npos; at += 7)
    other.replace(at, 6, "_PARAMS");
  expect_the_mosaic(panorama::read_text_label(other));
  EXPECT_TRUE(panorama::is_label_start(kPds3));
  EXPECT_TRUE(panorama::is_label_start(kVicar));
  EXPECT_FALSE(panorama::is_label_start(kPds4));
  EXPECT_FALSE(panorama::is_label_start("\x89PNG"));
}

TEST(RoverLabel, UnitsAreRead) {
  const RoverLabel degrees = *panorama::read_text_label(kPds3);
  const auto same = [&](const std::string& text) {
    const std::optional<RoverLabel> label =
        text.starts_with("<") ? panorama::read_pds4_label(text) : panorama::read_text_label(text);
    ASSERT_TRUE(label);
    EXPECT_LT(panorama::largest_difference_px(panorama::map_of(degrees, 4646, 1182),
                                              panorama::map_of(*label, 4646, 1182)),
              0.01);
  };
  const std::string both = "(12.9059 <pix/deg>, 12.9059 <pix/deg>)";
  same(replaced(kPds3, both, "(12.9059, 12.9059)"));
  same(replaced(kPds3, both, "12.9059 <PIXELS/DEGREE>"));
  same(replaced(kPds3, both, "(739.453601 <pixel/rad>, 12.9059 <pix/deg>)"));
  same(replaced(kPds3, both, "(0.0774839415 <deg/pixel>, 0.00135234990 <rad/pixel>)"));
  same(replaced(kPds3, "360.0 <deg>", "6.28318531 <rad>"));
  same(replaced(kPds3, "69.9294 <deg>", "1.22049826 <rad>"));
  same(replaced(kPds4, "'deg'>69.9294", "'arcmin'>4195.764"));
  same(replaced(kPds4, "'deg'>69.9294", "'mrad'>1220.49826"));
  same(replaced(kPds4, "'deg'>360.0", "'hr'>24"));
  const auto refused = [](const std::string& text) {
    return message_of(
        [&] { text.starts_with("<") ? panorama::read_pds4_label(text) : panorama::read_text_label(text); });
  };
  EXPECT_SAYS(refused(replaced(kPds4, "'pixel/deg'", "'m/pixel'")), "MAP_RESOLUTION", "m/pixel");
  EXPECT_SAYS(refused(replaced(kPds3, "0.0 <deg>", "0.0 <furlong>")), "START_AZIMUTH", "furlong");
  EXPECT_SAYS(refused(replaced(kPds3, "903.503 <pixel>", "903.503 <m>")), "ZERO_ELEVATION_LINE");
}

TEST(RoverLabel, LinesCountFromWhereTheMaximumElevationSays) {
  const auto first_row_deg = [](const std::string& text) {
    return panorama::map_of(*panorama::read_text_label(text), 4646, 1182).to_direction(0.5, 0.5).elevation_deg;
  };
  EXPECT_NEAR(first_row_deg(kPds3), 902.503 / 12.9059, 1e-9);
  EXPECT_NEAR(first_row_deg(replaced(kPds3, "903.503", "902.503")), 902.503 / 12.9059, 1e-9);
  const std::string silent = replaced(kPds3, "MAXIMUM_ELEVATION", "OTHER");
  EXPECT_NEAR(first_row_deg(silent), 902.503 / 12.9059, 1e-9);
}

TEST(RoverLabel, OtherProjectionsAreRefusedByName) {
  for (const std::string name : {"CYLINDRICAL-PERSPECTIVE", "CYLINDRICAL_PERSPECTIVE", "POLAR", "VERTICAL",
                                 "ORTHOGRAPHIC", "PERSPECTIVE", "POINT_PERSPECTIVE"}) {
    EXPECT_SAYS(message_of([&] { panorama::read_text_label(replaced(kPds3, "= CYLINDRICAL", "= " + name)); }),
                name, "not read", "project");
    EXPECT_SAYS(
        message_of([&] { panorama::read_text_label(replaced(kVicar, "'CYLINDRICAL'", "'" + name + "'")); }),
        name);
  }
  for (const std::string name : {"Cylindrical_Perspective", "Polar", "Vertical", "Orthographic"}) {
    std::string xml = replaced(kPds4, ">Cylindrical<", ">" + name + "<");
    xml = replaced(replaced(xml, "<cart:Cylindrical>", "<cart:" + name + ">"), "</cart:Cylindrical>",
                   "</cart:" + name + ">");
    EXPECT_SAYS(message_of([&] { panorama::read_pds4_label(xml); }), name, "not read");
  }
}

TEST(RoverLabel, FramesThatTurnWithTheRoverAreRefused) {
  for (const std::string frame : {"ROVER_FRAME", "ROVER_NAV_FRAME", "RSM_FRAME", "MAST_FRAME"}) {
    EXPECT_SAYS(message_of([&] { panorama::read_text_label(replaced(kPds3, "SITE_FRAME", frame)); }), frame,
                "SITE_FRAME");
  }
  EXPECT_EQ(panorama::read_text_label(replaced(kPds3, "SITE_FRAME", "LOCAL_LEVEL_FRAME"))->frame,
            "LOCAL_LEVEL_FRAME");
}

TEST(RoverLabel, BadOnesAreMessages) {
  EXPECT_EQ(panorama::read_text_label("PDS_VERSION_ID = PDS3\nOBJECT = IMAGE\nEND_OBJECT\nEND"), std::nullopt);
  EXPECT_EQ(panorama::read_text_label("LBLSIZE=100 NL=5"), std::nullopt);
  EXPECT_EQ(panorama::read_text_label(""), std::nullopt);
  EXPECT_EQ(panorama::read_pds4_label("<a/>"), std::nullopt);
  EXPECT_SAYS(message_of([] { panorama::read_pds4_label("<a>"); }), "well-formed");
  const auto refused = [](const std::string& what, const std::string& with) {
    return message_of(
        [&] { panorama::map_of(*panorama::read_text_label(replaced(kPds3, what, with)), 4646, 1182); });
  };
  EXPECT_SAYS(refused("START_AZIMUTH ", "OTHER "), "no START_AZIMUTH");
  EXPECT_SAYS(refused("ZERO_ELEVATION_LINE ", "OTHER "), "no ZERO_ELEVATION_LINE");
  EXPECT_SAYS(refused("MAP_RESOLUTION ", "OTHER "), "no MAP_RESOLUTION");
  EXPECT_SAYS(refused("12.9059 <pix/deg>, ", "0.0, "), "MAP_RESOLUTION", "more than 0");
  EXPECT_SAYS(refused("12.9059 <pix/deg>, ", "nan, "), "MAP_RESOLUTION", "not a number");
  EXPECT_SAYS(refused("(12.9059 <pix/deg>, 12.9059 <pix/deg>)", "(12.9059"), "MAP_RESOLUTION");
  EXPECT_SAYS(refused("903.503", "N/A"), "ZERO_ELEVATION_LINE", "N/A");
  EXPECT_SAYS(refused("LINES = 1182", "LINES = 11.5"), "LINES");
  // Contradictions: label and image, and within.
  EXPECT_SAYS(refused("LINES = 1182", "LINES = 1183"), "4646x1183", "4646x1182");
  EXPECT_SAYS(refused("360.0 <deg>", "180.0 <deg>"), "STOP_AZIMUTH", "2323", "4646");
  EXPECT_SAYS(refused("-21.673", "-41.673"), "MINIMUM_ELEVATION", "1182");
  EXPECT_SAYS(refused("69.9294", "60.0"), "ZERO_ELEVATION_LINE");
}

// A name that is repeated in front of every key must not multiply the label's size.
TEST(RoverLabel, LongNamesTakeNoMoreMemoryThanTheLabel) {
  const std::string name(1'000'000, 'P');
  std::string vicar = "LBLSIZE=2048 PROPERTY='" + name + "' ";
  std::string pds3 = "PDS_VERSION_ID = PDS3\nGROUP = " + name + "\n";
  for (int n = 0; n < 30'000; ++n) {
    vicar += "K" + std::to_string(n) + "=1 ";
    pds3 += "K" + std::to_string(n) + " = 1\n";
  }
  EXPECT_EQ(panorama::read_text_label(vicar), std::nullopt);
  EXPECT_EQ(panorama::read_text_label(pds3), std::nullopt);
  EXPECT_TRUE(panorama::read_text_label(vicar + kVicar.substr(kVicar.find("PROPERTY='SURFACE"))));
}

TEST(RoverLabel, AnythingIsAMessageOrALabel) {
  test_support::Random random(831);
  for (const std::string* text : {&kPds3, &kVicar, &kPds4}) {
    for (int n = 0; n < 4000; ++n) {
      std::string damaged = *text;
      for (int k = random.integer(1, 4); k > 0; --k) {
        const auto at = static_cast<std::size_t>(random.integer(0, static_cast<int>(damaged.size()) - 1));
        if (random.integer(0, 1) == 0) {
          damaged[at] = static_cast<char>(random.integer(-128, 127));
        } else {
          damaged.resize(at + 1);
        }
      }
      message_of([&] {
        const auto label =
            text == &kPds4 ? panorama::read_pds4_label(damaged) : panorama::read_text_label(damaged);
        if (label) {
          EXPECT_EQ(panorama::check(panorama::map_of(*label, 4646, 1182)), "");
        }
      });
    }
  }
}

}  // namespace
