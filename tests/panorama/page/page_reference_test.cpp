// tests/web/reference_directions.json, with which the viewer is tested, holds what the program computes.
#include "tests/panorama/page/page_fixture.h"

#include "panorama/viewer/viewer.h"

namespace {

using panorama::Direction;
using panorama::PanoramaMap;

PanoramaMap map_of_json(const nlohmann::json& json) {
  PanoramaMap map;
  for (const auto kind :
       {panorama::MapKind::kCylinder, panorama::MapKind::kEquirectangular, panorama::MapKind::kFacets}) {
    if (json.at("kind") == panorama::to_string(kind)) map.kind = kind;
  }
  map.width_px = json.at("width_px");
  map.height_px = json.at("height_px");
  map.turn_px = json.at("turn_px");
  map.turn_azimuth_deg = json.at("turn_azimuth_deg");
  map.crop_left_px = json.at("crop_left_px");
  map.horizon_px = json.at("horizon_px");
  map.focal_px = json.at("focal_px");
  map.facets = json.at("facets");
  return map;
}

double apart_deg(double a, double b) { return std::abs(std::remainder(a - b, 360.0)); }

void expect_view(const panorama::Viewer& viewer, const nlohmann::json& expected) {
  EXPECT_NEAR(viewer.yaw_deg(), expected.at(0).get<double>(), 1e-9);
  EXPECT_NEAR(viewer.pitch_deg(), expected.at(1).get<double>(), 1e-9);
  EXPECT_NEAR(viewer.fov_deg(), expected.at(2).get<double>(), 1e-9);
}

TEST(PageReference, DirectionsAndPixels) {
  const auto all =
      nlohmann::json::parse(page_test::text_of(VPE_SOURCE_DIR "/tests/web/reference_directions.json"));
  ASSERT_GE(all.size(), 7U);
  for (const auto& one : all) {
    const PanoramaMap map = map_of_json(one.at("map"));
    ASSERT_EQ(panorama::check(map), "");
    for (const auto& pixel : one.at("pixels")) {
      const Direction direction = map.to_direction(pixel.at("x"), pixel.at("y"));
      EXPECT_LT(apart_deg(direction.azimuth_deg, pixel.at("azimuth")), 1e-10);
      EXPECT_NEAR(direction.elevation_deg, pixel.at("elevation").get<double>(), 1e-10);
    }
    for (const auto& direction : one.at("directions")) {
      const auto at = map.to_pixel({direction.at("azimuth"), direction.at("elevation")});
      ASSERT_EQ(at.has_value(), !direction.at("pixel").is_null());
      if (!at) continue;
      EXPECT_NEAR(at->x, direction.at("pixel").at(0).get<double>(), 1e-7);
      EXPECT_NEAR(at->y, direction.at("pixel").at(1).get<double>(), 1e-7);
    }
  }
}

TEST(PageReference, Views) {
  const auto all =
      nlohmann::json::parse(page_test::text_of(VPE_SOURCE_DIR "/tests/web/reference_directions.json"));
  for (const auto& one : all) {
    for (const auto& view : one.at("views")) {
      const double yaw_deg = view.at("yaw");
      const double pitch_deg = view.at("pitch");
      const int width = view.at("width");
      const int height = view.at("height");
      panorama::Viewer viewer(map_of_json(one.at("map")), width, height);
      viewer.set_fov(view.at("fov"));
      viewer.look_at(yaw_deg, pitch_deg);
      expect_view(viewer, view.at("is"));
      const Direction direction = viewer.direction(0.25 * width, 0.7 * height);
      EXPECT_LT(apart_deg(direction.azimuth_deg, view.at("direction").at(0)), 1e-9);
      EXPECT_NEAR(direction.elevation_deg, view.at("direction").at(1).get<double>(), 1e-9);
      viewer.zoom(1.7, 0.8 * width, 0.3 * height);
      expect_view(viewer, view.at("zoomed"));
      viewer.hold({yaw_deg + 5, pitch_deg + 2}, 0.1 * width, 0.9 * height);
      expect_view(viewer, view.at("held"));
    }
  }
}

}  // namespace
