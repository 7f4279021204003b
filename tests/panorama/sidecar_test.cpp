// JSON beside images.
#include "panorama/metadata/sidecar.h"

#include <cmath>

#include "tests/panorama/test_images.h"

namespace {

using panorama::MapKind;
using panorama::PanoramaMap;
using panorama::Sidecar;
using panorama_test::message_of;

std::string with(const std::string& keys) { return "{\"width\": 3600, \"height\": 500, " + keys + "}"; }

PanoramaMap map_of(const std::string& keys) { return panorama::read_sidecar(with(keys)).map; }

TEST(Sidecar, ComesBackFromItsText) {
  test_support::Random random(841);
  for (int n = 0; n < 300; ++n) {
    Sidecar sidecar;
    sidecar.image = n % 2 == 0 ? "a \"b\"\n.png" : "";
    const double azimuth_deg = random.uniform(-360, 720);
    const double horizon_px = random.uniform(0, 500);
    switch (n % 3) {
      case 0: sidecar.map = panorama::cylinder_map(3000, 500, 3600.123, azimuth_deg, horizon_px); break;
      case 1: sidecar.map = panorama::equirectangular_map(3600, 500, 3600, azimuth_deg, horizon_px); break;
      default:
        sidecar.map = panorama::faceted_map(8, 450, 500, azimuth_deg, horizon_px);
        sidecar.map.width_px = 1000;
    }
    if (n % 3 != 2) sidecar.map.focal_px *= random.uniform(0.9, 1.1);
    sidecar.map.crop_left_px = random.uniform(0, 3500);
    if (n % 5 != 0)
      sidecar.viewpoint = {random.uniform(-180, 180), -4.6, 1.5, 2.0, -4446.5, mars::VerticalDatum::areoid()};
    ASSERT_EQ(panorama::check(sidecar.map), "");
    const Sidecar back = panorama::read_sidecar(panorama::to_text(sidecar));
    EXPECT_EQ(back.image, sidecar.image);
    EXPECT_EQ(back.map.kind, sidecar.map.kind);
    EXPECT_EQ(back.viewpoint, sidecar.viewpoint);
    EXPECT_LT(panorama::largest_difference_px(sidecar.map, back.map), panorama::kRoundTrip_px);
  }
}

TEST(Sidecar, TakesScalesAndLimits) {
  const PanoramaMap even = panorama::equirectangular_map(3600, 500, 3600, 20.0, 200.0);
  const std::string left = "\"projection\": \"equirectangular\", \"azimuth_deg_at_left\": 20, ";
  for (const char* keys :
       {"\"degrees_per_pixel\": 0.1, \"horizon_row\": 200",
        "\"columns_per_turn\": 3600, \"elevation_deg_at_top\": 20",
        "\"azimuth_deg_at_right\": 20, \"elevation_deg_at_top\": 20, \"elevation_deg_at_bottom\": -30",
        "\"azimuth_deg_at_right\": 380, \"degrees_per_row\": 0.1, \"horizon_row\": 200"}) {
    EXPECT_LT(panorama::largest_difference_px(even, map_of(left + keys)), 1e-9) << keys;
  }
  const double f = 3600.0 / (2 * mars::kPi);
  const double top_deg = std::atan(200 / f) * 180 / mars::kPi;
  const double bottom_deg = std::atan(-300 / f) * 180 / mars::kPi;
  EXPECT_LT(
      panorama::largest_difference_px(
          panorama::cylinder_map(3600, 500, 3600, 20.0, 200.0),
          map_of("\"projection\": \"cylinder\", \"azimuth_deg_at_left\": 20, \"degrees_per_pixel\": 0.1, "
                 "\"elevation_deg_at_top\": " +
                 std::to_string(top_deg) + ", \"elevation_deg_at_bottom\": " + std::to_string(bottom_deg))),
      0.001);
  const PanoramaMap facets = map_of(
      "\"projection\": \"facets\", \"facets\": 8, \"start_yaw_deg\": 30, "
      "\"columns_per_turn\": 3600, \"horizon_row\": 250");
  EXPECT_EQ(facets.kind, MapKind::kFacets);
  EXPECT_NEAR(facets.to_direction(225, 250).azimuth_deg, 30.0, 1e-9);
}

TEST(Sidecar, RefusesWhatIsMissingOrContradictory) {
  const std::string left = "\"projection\": \"equirectangular\", \"azimuth_deg_at_left\": 20, ";
  const std::string good = left + "\"degrees_per_pixel\": 0.1, \"horizon_row\": 200";
  const auto said = [](const std::string& keys) { return message_of([&] { map_of(keys); }); };
  const auto text_said = [](const std::string& text) {
    return message_of([&] { panorama::read_sidecar(text); });
  };
  EXPECT_EQ(said(good), "");
  EXPECT_SAYS(text_said(""), "JSON");
  EXPECT_SAYS(text_said("[1]"), "object");
  EXPECT_SAYS(text_said("{\"width\": 1e999}"), "JSON");
  EXPECT_SAYS(text_said("{}"), "projection");
  EXPECT_SAYS(text_said("{\"projection\": \"cylinder\"}"), "width");
  EXPECT_SAYS(text_said("{\"projection\": \"cylinder\", \"width\": \"9\"}"), "width", "not a number");
  EXPECT_SAYS(text_said("{\"projection\": \"cylinder\", \"width\": 9.5, \"height\": 3}"), "9.5");
  EXPECT_SAYS(text_said("{\"projection\": 5}"), "projection");
  EXPECT_SAYS(said("\"projection\": \"polar\""), "polar", "equirectangular");
  EXPECT_SAYS(said("\"projection\": \"cylindrical\", \"degrees_per_pixel\": 0.1"), "two meanings", "tangent");
  EXPECT_SAYS(said("\"projection\": \"cylinder\", \"degrees_per_pixel\": 0.1"), "azimuth_deg_at_left");
  EXPECT_SAYS(said(left + "\"horizon_row\": 5"), "columns_per_turn");
  EXPECT_SAYS(said(left + "\"degrees_per_pixel\": 0.1"), "horizon_row");
  EXPECT_SAYS(said(left + "\"degrees_per_pixel\": 0, \"horizon_row\": 5"), "degrees_per_pixel");
  EXPECT_SAYS(said(left + "\"degrees_per_pixel\": 1e-300, \"horizon_row\": 5"), "full circle");
  EXPECT_SAYS(said(good + ", \"azimuth_deg_at_right\": 200"), "azimuth_deg_at_right", "200", "20");
  EXPECT_SAYS(said(good + ", \"columns_per_turn\": 3700"), "degrees_per_pixel");
  EXPECT_SAYS(said(good + ", \"elevation_deg_at_top\": 21"), "elevation_deg_at_top");
  EXPECT_SAYS(said(good + ", \"elevation_deg_at_bottom\": -32"), "elevation_deg_at_bottom");
  EXPECT_SAYS(said(good + ", \"azimuth_increases\": \"counterclockwise\""), "counterclockwise");
  for (const char* facets : {"0", "2", "65", "1000000", "-8", "1e18", "2.5"}) {
    EXPECT_SAYS(
        said(std::string("\"projection\": \"facets\", \"start_yaw_deg\": 0, \"columns_per_turn\": 3600, "
                         "\"horizon_row\": 5, \"facets\": ") +
             facets),
        "facets");
  }
  EXPECT_SAYS(
      said("\"projection\": \"facets\", \"facets\": 7, \"start_yaw_deg\": 0, \"columns_per_turn\": 3600, "
           "\"horizon_row\": 5"),
      "whole columns");
  const auto pose = [&](const char* keys) { return said(good + ", \"pose\": {" + keys + "}"); };
  EXPECT_SAYS(pose("\"lat_deg\": 3"), "lon_deg");
  EXPECT_SAYS(pose("\"lat_deg\": 91, \"lon_deg\": 0"), "latitudes");
  EXPECT_SAYS(pose("\"lat_deg\": 9, \"lon_deg\": 0, \"datum\": \"moon\""), "moon");
  EXPECT_SAYS(pose("\"lat_deg\": 9, \"lon_deg\": 0, \"pitch_deg\": 4"), "pitch_deg", "level");
  EXPECT_SAYS(said(good + ", \"pose\": 7"), "pose");
}

// What a file says is quoted, but not a megabyte of it.
TEST(Sidecar, MessagesAreShort) {
  const std::string word(1'000'000, 'w');
  for (
      const std::string& json :
      {"{\"image\": \"" + word, "{\"projection\": \"" + word + "\"}",
       R"({"projection": "cylinder", "width": 9, "height": 9, "azimuth_increases": "anti)" + word + "\"}",
       R"({"projection": "cylinder", "width": 9, "height": 9, "azimuth_deg_at_left": 0, "columns_per_turn": 9,)"
       R"( "horizon_row": 4, "pose": {"lon_deg": 1, "lat_deg": 2, "datum": ")" +
           word + "\"}}"}) {
    const std::string message = message_of([&] { panorama::read_sidecar(json); });
    EXPECT_FALSE(message.empty());
    EXPECT_LT(message.size(), 1000U);
  }
}

TEST(Sidecar, DeepNestingIsNoDanger) {
  const std::string deep = "{\"a\":" + std::string(200000, '[') + std::string(200000, ']') + "}";
  EXPECT_SAYS(message_of([&] { panorama::read_sidecar(deep); }), "projection");
}

}  // namespace
