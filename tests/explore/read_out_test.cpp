#include "vpe/explore/measure/read_out.h"

#include <algorithm>

#include "mars/geodesy/pose.h"
#include "tests/explore/terrain_fixture.h"

namespace vpe::explore {
namespace {

using test_support::Random;

class ReadOuts : public test_support::GroundTest<test_support::BumpyGround> {};

std::string text_of(const ReadOut& r, const std::string& label) {
  const auto lines = read_out_lines(r);
  const auto found =
      std::find_if(lines.begin(), lines.end(), [&](const ReadOutLine& l) { return l.label == label; });
  return found == lines.end() ? "" : found->text;
}

// Takes a point of the reference surface and a camera somewhere above it. The ray back must read that point
// out, unless other ground is nearer.
TEST_F(ReadOuts, AreThoseOfQueryWhereTheRayMeetsTheGround) {
  Random random(3);
  int met = 0;
  for (int n = 0; n < 300; ++n) {
    const mars::LonLat place =
        mars::lon_lat(n % 2 == 0 ? random.direction() : test_support::kPatch + 0.01 * random.direction());
    const glm::dvec3 ground = surface().at(mars::direction(place)).radius_m * mars::direction(place);
    const glm::dvec3 camera = ground + random.log_uniform(10, 1e6) *
                                           glm::normalize(mars::direction(place) + 0.9 * random.direction());
    const double range_m = glm::length(ground - camera);
    const auto r = read_out(surface(), camera, (ground - camera) / range_m);
    ASSERT_TRUE(r.has_value());
    ASSERT_LE(*r->range_m, range_m + 1e-3);
    EXPECT_NEAR(glm::length(r->point_m), surface().at(r->point_m).radius_m, 1e-6);
    const paging::PlaceAnswer there = paging::query(surface(), r->at.place);
    EXPECT_EQ(there.elevation_m, r->at.elevation_m);
    EXPECT_EQ(there.slope_deg, r->at.slope_deg);
    EXPECT_EQ(there.aspect_deg, r->at.aspect_deg);
    if (*r->range_m < range_m - 1) continue;
    ++met;
    EXPECT_LT(mars::distance_rad(place, r->at.place) * mars::kMarsRadius_m, 1e-2);
    EXPECT_NEAR(r->at.elevation_m, paging::query(surface(), place).elevation_m, 1e-2);
  }
  EXPECT_GT(met, 200);
}

TEST_F(ReadOuts, BothLongitudesAndTheirTexts) {
  const ReadOut west = read_out_at(surface(), {-74, -13.5});
  EXPECT_EQ(west.at.place.lon_deg, -74);
  EXPECT_EQ(west.lon_east_deg, 286);
  EXPECT_EQ(text_of(west, "Longitude"), "-74.00000 (286.00000 E)");
  EXPECT_EQ(text_of(west, "Latitude"), "-13.50000");
  const ReadOut east = read_out_at(surface(), {286, -13.5});
  EXPECT_EQ(east.at.place.lon_deg, -74);
  EXPECT_EQ(east.at.elevation_m, west.at.elevation_m);
  EXPECT_EQ(read_out_at(surface(), {-1e-16, 0}).lon_east_deg, 0);
  EXPECT_EQ(read_out_at(surface(), {-180, 0}).lon_east_deg, 180);
  EXPECT_FALSE(west.range_m.has_value());
  EXPECT_EQ(text_of(west, "Range"), "");
}

// Folders are those of the machine that built the planet.
TEST_F(ReadOuts, SourcesAreNamedByTheirFiles) {
  EXPECT_EQ(short_source_name("/home/someone/data/gale ctx.tif"), "gale ctx.tif");
  EXPECT_EQ(short_source_name("https://example.org/mola.tif"), "mola.tif");
  EXPECT_EQ(short_source_name("NETCDF:/data/x.nc:z"), "x.nc:z");
  EXPECT_EQ(short_source_name("embedded-detail"), "embedded-detail");
  EXPECT_EQ(short_source_name("folder/"), "folder/");
}

TEST_F(ReadOuts, NamesTheSourceAndItsError) {
  const ReadOut r = read_out_at(surface(), mars::lon_lat(test_support::kPatch));
  EXPECT_EQ(r.source, "fake");
  EXPECT_EQ(text_of(r, "Source"), "fake, posts 1000 m");
  EXPECT_EQ(r.datum, "sphere:3396190");
  EXPECT_NE(text_of(r, "Elevation").find("m (sphere:3396190)"), std::string::npos);
  EXPECT_LE(r.at.spacing_m, 2000);
  EXPECT_GT(r.at.level, read_out_at(surface(), {90, 0}).at.level);
  EXPECT_EQ(r.at.geometric_error_m, 0);
  EXPECT_GT(r.at.resampling.max_m, 0);
  EXPECT_EQ(text_of(r, "Resampling error"), measured_length_text(r.at.resampling.rms_m) + " rms, " +
                                                measured_length_text(r.at.resampling.max_m) + " most");
}

TEST_F(ReadOuts, TheSkyHasNoneAndUndergroundIsTheCamerasPlace) {
  const glm::dvec3 up = mars::direction({10, 10});
  EXPECT_FALSE(read_out(surface(), up * 4e6, up).has_value());
  const auto below = read_out(surface(), up * 3.38e6, up);
  ASSERT_TRUE(below.has_value());
  EXPECT_EQ(below->range_m, 0);
  EXPECT_NEAR(below->at.place.lon_deg, 10, 1e-9);
}

TEST_F(ReadOuts, AnExaggeratedImageReadsTheSameElevations) {
  const mars::LonLat place = mars::lon_lat(test_support::kPatch);
  const glm::dvec3 up = mars::direction(place);
  const auto plain = read_out(surface(), up * 4e6, -up);
  const auto tall = read_out(surface(), up * 4e6, -up, 20);
  EXPECT_NEAR(plain->at.elevation_m, tall->at.elevation_m, 1e-6);
  EXPECT_NEAR(plain->at.slope_deg, tall->at.slope_deg, 1e-6);
  // Drawn 20 times as high, but for the sag of facets of 2 km.
  EXPECT_NEAR(glm::length(tall->point_m) - mars::kMarsRadius_m, 20 * plain->at.elevation_m, 20);
  EXPECT_NEAR(*tall->range_m, 4e6 - glm::length(tall->point_m), 1e-6);
}

TEST(ReadOutLengths, KeepThreeDigits) {
  EXPECT_EQ(measured_length_text(0), "0.00 m");
  EXPECT_EQ(measured_length_text(-0.0001), "0.00 m");
  EXPECT_EQ(measured_length_text(9.994), "9.99 m");
  EXPECT_EQ(measured_length_text(9.996), "10.0 m");
  EXPECT_EQ(measured_length_text(950.4), "950 m");
  EXPECT_EQ(measured_length_text(12345), "12.35 km");
  EXPECT_EQ(measured_length_text(-234567), "-234.6 km");
  EXPECT_EQ(measured_length_text(3396190), "3396 km");
}

}  // namespace
}  // namespace vpe::explore
