// Plans: sizes of the options, and pieces whose pixels show the directions of the map.
#include "panorama/panorama_plan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "mars/geodesy/sphere.h"

namespace panorama {
namespace {

using mars::kPi;
using mars::kRadiansPerDegree;

const Viewpoint kViewpoint = viewpoint_at({137.4, -4.6}, 2000, mars::kMarsRadius_m);

// The map's direction at a place, in the body-fixed frame, without any View.
glm::dvec3 ray_of(const PanoramaMap& map, const Viewpoint& viewpoint, double x, double y) {
  const Direction d = map.to_direction(x, y);
  const mars::LocalFrame frame = mars::local_frame(viewpoint.place);
  const mars::SinCos a = mars::sin_cos_deg(d.azimuth_deg);
  const mars::SinCos e = mars::sin_cos_deg(d.elevation_deg);
  return frame.east * (e.cos * a.sin) + frame.north * (e.cos * a.cos) + frame.up * e.sin;
}

double angle_rad(const glm::dvec3& a, const glm::dvec3& b) { return glm::length(glm::cross(a, b)); }

// Every pixel of the image belongs to one piece, and looks where the map says.
void expect_covered(const PanoramaMap& map, const Viewpoint& viewpoint, int margin_px) {
  std::int64_t pixels = 0;
  std::int64_t next = 0;
  std::mt19937 random(5);
  for (const Strip& strip : strips_of(map)) {
    ASSERT_EQ(strip.x, next);
    next += strip.width;
    std::int64_t in_strip = 0;
    for (const Piece& piece : pieces_of(map, viewpoint, strip, margin_px)) {
      ASSERT_EQ(vpe::core::check(piece.view), "");
      const glm::ivec2 size = vpe::core::drawn_size(piece.view);
      ASSERT_EQ(size.x, piece.width + 2 * piece.margin_px);
      ASSERT_EQ(size.y, piece.height + 2 * piece.margin_px);
      ASSERT_GE(piece.x, strip.x);
      ASSERT_LE(piece.x + piece.width, strip.x + strip.width);
      in_strip += std::int64_t{piece.width} * piece.height;
      std::uniform_int_distribution<int> column(0, piece.width - 1);
      std::uniform_int_distribution<int> row(0, piece.height - 1);
      for (int n = 0; n < 60; ++n) {
        // The corners first: seams are there.
        const int i = n == 0 || n == 2 ? 0 : n == 1 || n == 3 ? piece.width - 1 : column(random);
        const int j = n < 2 ? 0 : n < 4 ? piece.height - 1 : row(random);
        const glm::dvec3 drawn = vpe::core::pixel_ray(piece.view, piece.view.part.x + piece.margin_px + i + 0.5,
                                                      piece.view.part.y + piece.margin_px + j + 0.5);
        const glm::dvec3 wanted = ray_of(map, viewpoint, static_cast<double>(piece.x) + i + 0.5,
                                         static_cast<double>(piece.y) + j + 0.5);
        ASSERT_LT(angle_rad(drawn, wanted), 3e-14) << to_string(map.kind) << " " << piece.x + i;
      }
    }
    EXPECT_EQ(in_strip, strip.width * map.height_px);
    pixels += in_strip;
  }
  EXPECT_EQ(next, map.width_px);
  EXPECT_EQ(pixels, map.width_px * map.height_px);
}

PlanOptions options_of(MapKind kind, std::int64_t width_px) {
  PlanOptions options;
  options.kind = kind;
  options.width_px = width_px;
  return options;
}

TEST(PanoramaPlan, PiecesShowTheDirectionsOfTheMap) {
  for (const MapKind kind : {MapKind::kCylinder, MapKind::kEquirectangular, MapKind::kFacets}) {
    for (const std::int64_t width_px : {37, 1000, 6000, 100000}) {
      PlanOptions options = options_of(kind, width_px);
      options.yaw_deg = 33;
      if (width_px > 10000) options.lowest_deg = -20;
      if (width_px > 10000) options.highest_deg = 30;
      expect_covered(plan_panorama(options).map, kViewpoint, 6);
      options.arc = {{300, 70.5}};
      expect_covered(plan_panorama(options).map, kViewpoint, 0);
    }
  }
}

TEST(PanoramaPlan, AtThePolesNorthIsAlongTheMeridian) {
  for (const double lat_deg : {90.0, -90.0}) {
    const Viewpoint viewpoint = viewpoint_at({137.4, lat_deg}, 2000, mars::kMarsRadius_m);
    expect_covered(plan_panorama(options_of(MapKind::kCylinder, 900)).map, viewpoint, 0);
    expect_covered(plan_panorama(options_of(MapKind::kFacets, 900)).map, viewpoint, 6);
  }
}

TEST(PanoramaPlan, FacetsFollowTheContract) {
  for (const int facets : {3, 8, 64}) {
    PlanOptions options = options_of(MapKind::kFacets, 6000);
    options.facets = facets;
    options.yaw_deg = 10;
    const PanoramaMap map = plan_panorama(options).map;
    EXPECT_EQ(map.width_px % facets, 0);
    EXPECT_EQ(map.crop_left_px, 0);
    EXPECT_DOUBLE_EQ(map.turn_azimuth_deg, 10 - 180.0 / facets);
    const double w = map.facet_px();
    for (int k = 0; k < facets; ++k) {
      const double middle_deg = map.to_direction((k + 0.5) * w, map.horizon_px).azimuth_deg;
      EXPECT_NEAR(std::remainder(middle_deg - (10 + 360.0 * k / facets), 360.0), 0, 1e-12);
    }
    // Seam columns lie as far apart as the tangent says, half a pixel on each side of the seam.
    const double half_deg =
        180.0 / facets - std::atan((0.5 * w - 0.5) / (0.5 * w) * std::tan(kPi / facets)) / kRadiansPerDegree;
    const double left_deg = map.to_direction(w - 0.5, map.horizon_px).azimuth_deg;
    const double right_deg = map.to_direction(w + 0.5, map.horizon_px).azimuth_deg;
    EXPECT_NEAR(std::remainder(right_deg - left_deg, 360.0), 2 * half_deg, 1e-11);
  }
}

TEST(PanoramaPlan, SizesAreThoseOfTheOptions) {
  PlanOptions options = options_of(MapKind::kCylinder, 6000);
  options.lowest_deg = -20;
  options.highest_deg = 40;
  PanoramaPlan plan = plan_panorama(options);
  EXPECT_EQ(plan.map.width_px, 6000);
  EXPECT_TRUE(plan.rounded.empty());
  EXPECT_NEAR(plan.map.to_direction(0, 0).elevation_deg, 40, 0.5 * 360 / 6000);
  EXPECT_NEAR(plan.map.to_direction(0, static_cast<double>(plan.map.height_px)).elevation_deg, -20, 0.03);

  options.kind = MapKind::kEquirectangular;
  options.lowest_deg = options.highest_deg = std::nullopt;
  plan = plan_panorama(options);
  EXPECT_EQ(plan.map.height_px, 3000);
  EXPECT_EQ(plan.map.horizon_px, 1500);

  options.width_px = 6001;  // its quarter turn is no whole number of rows
  plan = plan_panorama(options);
  EXPECT_EQ(plan.map.height_px, 3000);
  EXPECT_EQ(check(plan.map), "");

  options.width_px.reset();
  options.degrees_per_pixel = 0.1;
  options.arc = {{350, 20}};
  plan = plan_panorama(options);
  EXPECT_EQ(plan.map.width_px, 300);
  EXPECT_EQ(plan.map.turn_px, 3600);
  EXPECT_DOUBLE_EQ(plan.map.to_direction(0, 900).azimuth_deg, 350);
  EXPECT_DOUBLE_EQ(plan.map.to_direction(300, 900).azimuth_deg, 20);

  options.arc = {{-180, 180}};
  EXPECT_EQ(plan_panorama(options).map.width_px, 3600);

  options = options_of(MapKind::kFacets, 1001);
  plan = plan_panorama(options);
  EXPECT_EQ(plan.map.width_px, 1000);
  ASSERT_EQ(plan.rounded.size(), 1U);
  EXPECT_EQ(plan.rounded[0], "width 1000 px instead of 1001 px");
  // An arc of facets is cut out of the whole.
  options.arc = {{80, 100}};
  plan = plan_panorama(options);
  EXPECT_EQ(plan.map.width_px, std::llround(plan.map.turn_px / 18));
  EXPECT_NEAR(plan.map.to_direction(0, 0).azimuth_deg, 80, 0.01);
}

TEST(PanoramaPlan, AreaOfWhatIsHeldIsBounded) {
  for (const MapKind kind : {MapKind::kCylinder, MapKind::kFacets}) {
    PlanOptions options = options_of(kind, 100000);
    options.lowest_deg = -33;
    options.highest_deg = 33;
    const PanoramaMap map = plan_panorama(options).map;
    EXPECT_GT(map.height_px, 19000);
    for (const Strip& strip : strips_of(map)) {
      EXPECT_LE(strip.width * map.height_px, 2 * PlanLimits::kStripPixels);
      for (const Piece& piece : pieces_of(map, kViewpoint, strip, 6)) {
        EXPECT_LE(std::int64_t{piece.width} * piece.height, PlanLimits::kPiecePixels);
      }
    }
  }
}

std::string refusal(const PlanOptions& options) {
  try {
    plan_panorama(options);
  } catch (const PlanError& e) {
    return e.what();
  }
  return "";
}

TEST(PanoramaPlan, RefusesWhatCannotBe) {
  for (const int facets : {-1, 0, 2, 65, 1000000}) {
    PlanOptions options = options_of(MapKind::kFacets, 800);
    options.facets = facets;
    EXPECT_EQ(refusal(options), std::to_string(facets) + " facets: must be 3 to 64");
  }
  const double nan = std::nan("");
  PlanOptions options = options_of(MapKind::kCylinder, 800);
  for (const double highest_deg : {90.0, 1e9, nan, -45.0, -60.0}) {
    options.highest_deg = highest_deg;
    EXPECT_NE(refusal(options).find("elevations -45 to "), std::string::npos) << highest_deg;
  }
  options.highest_deg.reset();
  for (const std::int64_t width_px : {std::int64_t{0}, std::int64_t{-5}, std::int64_t{1000001}, INT64_MAX}) {
    options.width_px = width_px;
    EXPECT_NE(refusal(options).find("must be 1 to 1000000"), std::string::npos) << width_px;
  }
  options.width_px = 1000000;
  EXPECT_NE(refusal(options).find("rows high, more than 65536"), std::string::npos);
  options.width_px = 800;
  for (const Arc& arc : {Arc{0, 361}, Arc{0, 0.01}, Arc{nan, 1}, Arc{0, 1e9}}) {
    options.arc = arc;
    EXPECT_NE(refusal(options), "") << arc.to_deg;
  }
  options.arc.reset();
  options.degrees_per_pixel = 0.1;
  EXPECT_NE(refusal(options).find("leave one out"), std::string::npos);
  options.width_px.reset();
  for (const double scale_deg : {0.0, -1.0, nan, 1e-9, 400.0}) {
    options.degrees_per_pixel = scale_deg;
    EXPECT_NE(refusal(options).find("degrees a pixel: must be"), std::string::npos) << scale_deg;
  }
  options.degrees_per_pixel = 1;
  options.yaw_deg = nan;
  EXPECT_NE(refusal(options).find("yaw"), std::string::npos);
}

}  // namespace
}  // namespace panorama
