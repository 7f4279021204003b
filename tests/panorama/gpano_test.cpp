// GPano fields, their XML, and what other programs make of both.
#include "panorama/metadata/gpano.h"

#include <cmath>

#include "panorama/image/xmp_file.h"
#include "tests/panorama/test_images.h"
#include "vpe/base/number.h"

namespace {

using panorama::GPano;
using panorama::MapKind;
using panorama::PanoramaMap;
using panorama_test::message_of;
using panorama_test::output_of;

constexpr char kStart[] =
    "<x:xmpmeta xmlns:x='adobe:ns:meta/'><rdf:RDF xmlns:rdf='http://www.w3.org/1999/02/22-rdf-syntax-ns#'>"
    "<rdf:Description rdf:about='' xmlns:GPano='http://ns.google.com/photos/1.0/panorama/'";
constexpr char kEnd[] = "</rdf:RDF></x:xmpmeta>";

// The fields that are always there: type, size of the file, of the whole, and the crop's corner.
GPano needed_fields(const char* type, std::int64_t width, std::int64_t height, std::int64_t full_width,
                    std::int64_t full_height, std::int64_t left, std::int64_t top) {
  GPano g;
  g.projection_type = type;
  g.cropped_width_px = width;
  g.cropped_height_px = height;
  g.full_width_px = full_width;
  g.full_height_px = full_height;
  g.cropped_left_px = left;
  g.cropped_top_px = top;
  return g;
}

GPano every_field() {
  GPano g = needed_fields("equirectangular", 31, 17, 4000, 2000, 120, 600);
  g.heading_deg = 12.25;
  g.pitch_deg = 0.0;
  g.roll_deg = 0.0;
  g.initial_heading_deg = 90;
  g.initial_pitch_deg = -5;
  g.initial_roll_deg = 0;
  g.initial_horizontal_fov_deg = 75.5;
  g.initial_vertical_fov_deg = 40.0;
  g.initial_camera_dolly = 0.5;
  g.use_viewer = true;
  g.exposure_lock_used = false;
  g.capture_software = "a <b> & 'c' \"d\" \xC3\xA9";
  g.stitching_software = "vpe";
  g.first_photo_date = "2026:11:20 10:11:12Z";
  g.last_photo_date = "2026:11:21 10:11:12Z";
  g.source_photos = 8;
  g.interior_left_px = 1;
  g.interior_top_px = 2;
  g.interior_width_px = 29;
  g.interior_height_px = 13;
  return g;
}

TEST(GPano, FieldsComeBackFromThePacket) {
  EXPECT_EQ(panorama::read_gpano(panorama::to_xmp(every_field())), every_field());
  const GPano least = needed_fields("cylindrical", 10, 20, 30, 20, 5, -7);
  EXPECT_EQ(panorama::read_gpano(panorama::to_xmp(least)), least);
}

TEST(GPano, IsReadFromAttributesElementsAndOtherPrefixes) {
  const std::string attributes =
      std::string(kStart) +
      " GPano:ProjectionType='cylindrical' GPano:CroppedAreaImageWidthPixels='10' "
      "GPano:CroppedAreaImageHeightPixels='20' GPano:FullPanoWidthPixels='30' GPano:FullPanoHeightPixels='20' "
      "GPano:CroppedAreaLeftPixels='5' GPano:CroppedAreaTopPixels='-7'/>" +
      kEnd;
  const GPano least = needed_fields("cylindrical", 10, 20, 30, 20, 5, -7);
  EXPECT_EQ(panorama::read_gpano(attributes), least);
  std::string renamed = attributes;
  for (std::size_t at = 0; (at = renamed.find("GPano", at)) != std::string::npos;) renamed.replace(at, 5, "pp");
  EXPECT_EQ(panorama::read_gpano(renamed), least);
  // Mixed, split over two descriptions, with blanks and reals for integers.
  const std::string mixed =
      std::string(kStart) +
      " GPano:ProjectionType='cylindrical' GPano:CroppedAreaImageWidthPixels='10.0'>"
      "<GPano:CroppedAreaImageHeightPixels> 20\n</GPano:CroppedAreaImageHeightPixels></rdf:Description>"
      "<rdf:Description xmlns:G='http://ns.google.com/photos/1.0/panorama/' G:FullPanoWidthPixels='30' "
      "G:FullPanoHeightPixels='20' G:CroppedAreaLeftPixels='5' G:CroppedAreaTopPixels='-7' "
      "G:UnknownField='x'/>" +
      kEnd;
  EXPECT_EQ(panorama::read_gpano(mixed), least);
  // The prefix alone means nothing.
  std::string other = attributes;
  other.replace(other.find("photos/1.0"), 10, "photos/9.9");
  EXPECT_EQ(panorama::read_gpano(other), std::nullopt);
  EXPECT_EQ(panorama::read_gpano("<a/>"), std::nullopt);
}

TEST(GPano, RefusesWhatCannotBeUnderstood) {
  const auto of = [](const std::string& more) {
    return message_of([&] { panorama::read_gpano(std::string(kStart) + more + kEnd); });
  };
  const std::string six =
      " GPano:CroppedAreaImageHeightPixels='20' GPano:FullPanoWidthPixels='30' GPano:FullPanoHeightPixels='20' "
      "GPano:CroppedAreaLeftPixels='5' GPano:CroppedAreaTopPixels='-7' GPano:ProjectionType='cylindrical'";
  EXPECT_SAYS(of(six + "/>"), "CroppedAreaImageWidthPixels", "exiftool");
  for (const char* bad : {"nan", "1e999", "1.5", "", "12px", "1e300"}) {
    EXPECT_SAYS(of(six + " GPano:CroppedAreaImageWidthPixels='" + bad + "'/>"), "CroppedAreaImageWidthPixels",
                bad);
  }
  EXPECT_SAYS(of(six + " GPano:CroppedAreaImageWidthPixels='10'>"
                       "<GPano:CroppedAreaLeftPixels>6</GPano:CroppedAreaLeftPixels></rdf:Description>"),
              "two values", "'5'", "'6'");
  EXPECT_SAYS(of(" GPano:ProjectionType="), "not well-formed", "byte");
  EXPECT_SAYS(message_of([] {
                std::string deep;
                for (int n = 0; n < 100000; ++n) deep += "<a>";
                for (int n = 0; n < 100000; ++n) deep += "</a>";
                panorama::read_gpano(deep);
              }),
              "nested");
}

// Looking up a prefix must not take time in proportion to the attributes beside it.
TEST(GPano, IsFoundAmongManyAttributes) {
  std::string many;
  for (int n = 0; n < 300'000; ++n) many += " q:a" + std::to_string(n) + "=''";
  const std::string xmp =
      "<x" + many +
      " xmlns:q='other' xmlns:g='http://ns.google.com/photos/1.0/panorama/' g:ProjectionType='cylindrical' "
      "g:CroppedAreaImageWidthPixels='7' g:CroppedAreaImageHeightPixels='5' "
      "g:FullPanoWidthPixels='7' g:FullPanoHeightPixels='5' g:CroppedAreaLeftPixels='0' "
      "g:CroppedAreaTopPixels='-2'/>";
  const auto found = panorama::read_gpano(xmp);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->full_width_px, 7);
}

TEST(GPano, PrefixesStandForWhatTheNearestElementSays) {
  const auto xmp = [](const std::string& inner) {
    return "<x xmlns:g='http://ns.google.com/photos/1.0/panorama/' xmlns:h='other'>" + inner + "</x>";
  };
  EXPECT_FALSE(panorama::read_gpano(xmp("<y xmlns:g='other'><g:ProjectionType>a</g:ProjectionType></y>")));
  EXPECT_FALSE(panorama::read_gpano(xmp("<h:ProjectionType>a</h:ProjectionType>")));
  EXPECT_FALSE(panorama::read_gpano(xmp("<ProjectionType>a</ProjectionType>")));
  EXPECT_SAYS(message_of([&] { panorama::read_gpano(xmp("<g:ProjectionType>a</g:ProjectionType>")); }),
              "GPano without");
  // An element's declarations end with it.
  EXPECT_SAYS(message_of([&] {
                panorama::read_gpano(
                    xmp("<y xmlns:g='other'><z xmlns:h='third'/></y><g:ProjectionType>a"
                        "</g:ProjectionType>"));
              }),
              "GPano without");
  EXPECT_SAYS(message_of([&] {
                panorama::read_gpano(
                    xmp("<y xmlns='http://ns.google.com/photos/1.0/panorama/' ProjectionType='no'>"
                        "<ProjectionType>a</ProjectionType></y>"));
              }),
              "GPano without");
}

TEST(GPano, GivesTheMapOfTheDescribedImage) {
  // 3600 columns to the full circle, heading 90 in its middle, 200 columns cut at the left, top 150 rows above the
  // horizon.
  GPano g = needed_fields("cylindrical", 1000, 400, 3600, 400, 200, -150);
  g.heading_deg = 90.0;
  PanoramaMap map = panorama::map_of(g);
  EXPECT_EQ(map.kind, MapKind::kCylinder);
  EXPECT_NEAR(map.to_direction(0, 150).azimuth_deg, 290.0, 1e-9);  // 90 - 180 + 20
  EXPECT_NEAR(map.to_direction(0, 0).elevation_deg, std::atan(150.0 / (1800.0 / mars::kPi)) * 180 / mars::kPi,
              1e-9);
  // Equirectangular: counted from the zenith.
  g = needed_fields("equirectangular", 4000, 1000, 4000, 2000, 0, 600);
  map = panorama::map_of(g);
  EXPECT_EQ(map.kind, MapKind::kEquirectangular);
  EXPECT_NEAR(map.to_direction(2000, 400).azimuth_deg, 0.0, 1e-9);
  EXPECT_NEAR(map.to_direction(2000, 0).elevation_deg, 36.0, 1e-9);
  EXPECT_NEAR(map.to_direction(2000, 1000).elevation_deg, -54.0, 1e-9);
}

TEST(GPano, RefusesFieldsThatMakeNoMap) {
  const auto of = [](auto change) {
    GPano g = needed_fields("equirectangular", 1000, 400, 3600, 1800, 200, 700);
    change(g);
    return message_of([&] { panorama::map_of(g); });
  };
  EXPECT_EQ(of([](GPano&) {}), "");
  EXPECT_SAYS(of([](GPano& g) { g.projection_type = "fisheye"; }), "fisheye");
  EXPECT_SAYS(of([](GPano& g) { g.pitch_deg = 3.0; }), "PosePitchDegrees", "level");
  EXPECT_SAYS(of([](GPano& g) { g.roll_deg = -0.1; }), "PoseRollDegrees");
  EXPECT_SAYS(of([](GPano& g) { g.cropped_left_px = 2601; }), "inside");
  EXPECT_SAYS(of([](GPano& g) { g.cropped_top_px = -1; }), "inside");
  EXPECT_SAYS(of([](GPano& g) { g.full_width_px = 0; }), "at least 1");
  EXPECT_SAYS(of([](GPano& g) { g.cropped_width_px = 0; }), "size");
  EXPECT_SAYS(of([](GPano& g) { g.cropped_width_px = -1000000000000; }), "size");
  EXPECT_SAYS(of([](GPano& g) { g.full_width_px = 1000000000000000; }), "full circle");
  EXPECT_SAYS(of([](GPano& g) { g.heading_deg = 1e30; }), "azimuth");
}

TEST(GPano, HoldsMapsThatFallOnWholePixels) {
  test_support::Random random(811);
  for (int n = 0; n < 2000; ++n) {
    const int turn = 2 * random.integer(10, 50000);
    const int width = random.integer(1, turn);
    const bool is_cylinder = random.integer(0, 1) == 1;
    const int height = random.integer(1, is_cylinder ? 20000 : turn / 2);
    const double north_deg = random.uniform(-400, 400);
    PanoramaMap map = is_cylinder
                          ? panorama::cylinder_map(width, height, turn, north_deg, random.integer(-1000, 3000))
                          : panorama::equirectangular_map(width, height, turn, north_deg, 0);
    if (!is_cylinder)
      map.horizon_px = turn / 4.0 - random.integer(0, turn / 2 - static_cast<int>(map.height_px));
    map.crop_left_px = random.integer(0, turn - 1);
    ASSERT_EQ(panorama::check(map), "");
    const GPano gpano = panorama::gpano_of(map);
    ASSERT_LT(panorama::largest_difference_px(map, panorama::map_of(gpano)), 1e-7) << n;
    ASSERT_GE(*gpano.heading_deg, 0.0);
    ASSERT_LT(*gpano.heading_deg, 360.0);
  }
  // A true cylinder's top is negative above the horizon.
  EXPECT_EQ(panorama::gpano_of(panorama::cylinder_map(3600, 500, 3600, 0, 200)).cropped_top_px, -200);
}

TEST(GPano, RefusesMapsThatItCannotHold) {
  EXPECT_SAYS(message_of([] { panorama::gpano_of(panorama::faceted_map(8, 100, 100, 0, 50)); }), "faceted");
  EXPECT_SAYS(message_of([] {
                PanoramaMap map = panorama::cylinder_map(3600, 500, 3600, 0, 200);
                map.focal_px *= 1.01;
                panorama::gpano_of(map);
              }),
              "true cylinders");
  const PanoramaMap half_a_row = panorama::cylinder_map(3600, 500, 3600, 0, 200.5);
  EXPECT_NO_THROW(panorama::gpano_of(half_a_row));
  EXPECT_SAYS(message_of([&] { panorama::gpano_of(half_a_row, 0.25); }), "whole pixels", "0.5");
}

TEST(GPanoOracle, ExiftoolAndExiv2ReadWhatWeWrite) {
  const test_support::TempDir folder;
  PanoramaMap map = panorama::cylinder_map(31, 17, 4000, 12.25, 6.0);
  const std::string packet = panorama::to_xmp(panorama::gpano_of(map));
  for (const char* name : {"a.png", "a.jpg"}) {
    const std::filesystem::path file = folder / name;
    vpe::core::write_image(file, panorama_test::pixels(31, 17), 31, 17);
    panorama::write_xmp(file, packet);
    std::vector<std::string> arguments{"-s3", "-n"};
    for (const char* field : {"ProjectionType", "CroppedAreaImageWidthPixels", "CroppedAreaImageHeightPixels",
                              "FullPanoWidthPixels", "FullPanoHeightPixels", "CroppedAreaLeftPixels",
                              "CroppedAreaTopPixels", "PoseHeadingDegrees", "UsePanoramaViewer"}) {
      arguments.push_back(std::string("-XMP-GPano:") + field);
    }
    arguments.push_back(file.string());
    EXPECT_EQ(output_of("exiftool", arguments), "cylindrical\n31\n17\n4000\n17\n0\n-6\n192.25\nTrue\n");
    EXPECT_SAYS(output_of("exiftool", {"-validate", "-warning", "-error", file.string()}), "OK");
    const std::string said = output_of("exiv2", {"-PXkv", file.string()});
    EXPECT_SAYS(said, "Xmp.GPano.ProjectionType", "cylindrical", "Xmp.GPano.CroppedAreaTopPixels", "-6");
  }
}

TEST(GPanoOracle, WhatExiftoolWritesIsRead) {
  const test_support::TempDir folder;
  vpe::core::write_image(folder / "a.png", panorama_test::pixels(31, 17), 31, 17);
  vpe::core::write_image(folder / "a.jpg", panorama_test::pixels(31, 17), 31, 17);
  vpe::core::write_tiff(folder / "a.tif", std::vector<float>(31 * 17, 1.0F), 31, 17);
  for (const char* name : {"a.png", "a.jpg", "a.tif"}) {
    const std::string file = (folder / name).string();
    // Compressed, where the format can be.
    output_of("exiftool", {"-q",
                           "-overwrite_original",
                           "-z",
                           "-XMP-GPano:ProjectionType=equirectangular",
                           "-XMP-GPano:CroppedAreaImageWidthPixels=31",
                           "-XMP-GPano:CroppedAreaImageHeightPixels=17",
                           "-XMP-GPano:FullPanoWidthPixels=4000",
                           "-XMP-GPano:FullPanoHeightPixels=2000",
                           "-XMP-GPano:CroppedAreaLeftPixels=120",
                           "-XMP-GPano:CroppedAreaTopPixels=600",
                           "-XMP-GPano:PoseHeadingDegrees=12.25",
                           "-XMP-GPano:PosePitchDegrees=0",
                           "-XMP-GPano:PoseRollDegrees=0",
                           "-XMP-GPano:InitialViewHeadingDegrees=90",
                           "-XMP-GPano:InitialViewPitchDegrees=-5",
                           "-XMP-GPano:InitialViewRollDegrees=0",
                           "-XMP-GPano:InitialHorizontalFOVDegrees=75.5",
                           "-XMP-GPano:InitialVerticalFOVDegrees=40",
                           "-XMP-GPano:InitialCameraDolly=0.5",
                           "-XMP-GPano:UsePanoramaViewer=true",
                           "-XMP-GPano:ExposureLockUsed=false",
                           "-XMP-GPano:StitchingSoftware=vpe",
                           "-XMP-GPano:SourcePhotosCount=8",
                           "-XMP-GPano:LargestValidInteriorRectLeft=1",
                           "-XMP-GPano:LargestValidInteriorRectTop=2",
                           "-XMP-GPano:LargestValidInteriorRectWidth=29",
                           "-XMP-GPano:LargestValidInteriorRectHeight=13",
                           file});
    const panorama::ImageFileHeader header = panorama::read_image_header(std::filesystem::path(file));
    EXPECT_EQ(header.width_px, 31);
    EXPECT_EQ(header.height_px, 17);
    ASSERT_TRUE(header.xmp) << name;
    GPano expected = every_field();
    expected.capture_software.reset();
    expected.first_photo_date.reset();
    expected.last_photo_date.reset();
    EXPECT_EQ(panorama::read_gpano(*header.xmp), expected) << name << "\n" << *header.xmp;
  }
}

TEST(GPanoOracle, WhatExiv2WritesIsRead) {
  const test_support::TempDir folder;
  const std::string file = (folder / "a.jpg").string();
  vpe::core::write_image(file, panorama_test::pixels(31, 17), 31, 17);
  panorama::write_xmp(file, panorama::to_xmp(every_field()));
  // exiv2 writes the packet again, as attributes.
  output_of("exiv2", {"-M", "set Xmp.GPano.PoseHeadingDegrees 77.5", file});
  const auto header = panorama::read_image_header(std::filesystem::path(file));
  ASSERT_TRUE(header.xmp);
  EXPECT_SAYS(*header.xmp, "GPano:PoseHeadingDegrees=\"77.5\"");
  GPano expected = every_field();
  expected.heading_deg = 77.5;
  EXPECT_EQ(panorama::read_gpano(*header.xmp), expected) << *header.xmp;
}

}  // namespace
