// Named places seen over a sphere, and past it.
#include "panorama/horizon/landmarks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "panorama/horizon/stellarium.h"

namespace {

using panorama::Landmark;
using panorama::Viewpoint;
using vpe::base::ThreadPool;
using vpe::core::Place;

constexpr double kR = mars::kMarsRadius_m;

double sphere_range(const glm::dvec3& camera_m, const glm::dvec3& ray) {
  const double along = -glm::dot(camera_m, ray);
  const double half2 = kR * kR - glm::dot(camera_m, camera_m) + along * along;
  if (along < 0 || half2 < 0) return std::numeric_limits<double>::infinity();
  return along - std::sqrt(half2);
}

std::vector<Landmark> seen(const Viewpoint& camera, const std::vector<Place>& features, double within_m,
                           panorama::Extent extent = panorama::Extent::kCentre) {
  ThreadPool pool(2);
  return panorama::landmarks(
      camera, features, within_m, [](const glm::dvec3&) { return kR; },
      [&](const glm::dvec3& ray) { return sphere_range(camera.position_m, ray); }, pool, extent);
}

TEST(Landmarks, OfWhichAnotherPointIsVisible) {
  const mars::LonLat at{40, -20};
  constexpr double kAlt = 5000;
  const Viewpoint camera = panorama::viewpoint_at(at, kAlt, kR);
  const double dip = mars::horizon_dip_rad(kAlt, kR);
  const mars::LonLat p = mars::destination(at, 50, 1.5 * dip);  // half of the horizon's distance behind it
  const double to_horizon_m = 0.5 * dip * kR;
  const auto one = [&](double diameter_m, double within_m, panorama::Extent extent) {
    return seen(camera, {{"it", p.lon_deg, p.lat_deg, diameter_m}}, within_m, extent);
  };
  const double far_m = 1e6;
  EXPECT_FALSE(one(3 * to_horizon_m, far_m, panorama::Extent::kCentre).at(0).seen_at);
  EXPECT_FALSE(one(1.9 * to_horizon_m, far_m, panorama::Extent::kPoints).at(0).seen_at);
  const Landmark reaches = one(3 * to_horizon_m, far_m, panorama::Extent::kPoints).at(0);
  ASSERT_TRUE(reaches.seen_at);
  EXPECT_TRUE(reaches.hidden_by);
  EXPECT_LE(reaches.seen_at->range_m, mars::horizon_distance_m(kAlt, kR) + 1);
  EXPECT_LE(mars::distance_rad(reaches.seen_at->place, p) * kR, 1.5 * to_horizon_m);
  EXPECT_GE(reaches.seen_at->direction.elevation_deg, -dip / mars::kRadiansPerDegree - 0.3);
  // Its centre is beyond the limit, and another point is not.
  const double limit_m = mars::horizon_distance_m(kAlt, kR) + 100;
  EXPECT_TRUE(one(3 * to_horizon_m, limit_m, panorama::Extent::kCentre).empty());
  EXPECT_TRUE(one(3 * to_horizon_m, limit_m, panorama::Extent::kPoints).at(0).seen_at);
  EXPECT_TRUE(one(1.9 * to_horizon_m, limit_m, panorama::Extent::kPoints).empty());
}

TEST(Landmarks, VisibleUpToTheHorizonAndHiddenByTheGroundBefore) {
  const mars::LonLat at{170, 30};
  constexpr double kAlt = 5000;
  const Viewpoint camera = panorama::viewpoint_at(at, kAlt, kR);
  const double dip = mars::horizon_dip_rad(kAlt, kR);
  std::vector<Place> features;
  for (int n = 40; n >= 1; --n) {
    const mars::LonLat p = mars::destination(at, 9.0 * n, 0.05 * n * dip);
    features.push_back({"f" + std::to_string(n), p.lon_deg, p.lat_deg, 1000});
  }
  const auto list = seen(camera, features, 1e6);
  ASSERT_EQ(list.size(), features.size());
  for (std::size_t n = 0; n < list.size(); ++n) {
    const Landmark& l = list[n];
    const auto number = static_cast<double>(n + 1);
    EXPECT_EQ(l.feature.name, "f" + std::to_string(n + 1));  // nearest first
    const double angle = 0.05 * number * dip;
    EXPECT_NEAR(std::remainder(l.centre.direction.azimuth_deg - 9 * number, 360), 0, 1e-6);
    EXPECT_GE(l.centre.direction.azimuth_deg, 0);
    EXPECT_LT(l.centre.direction.azimuth_deg, 360);
    const double height = kR * std::cos(angle) - (kR + kAlt);
    EXPECT_NEAR(l.centre.range_m, std::hypot(kR * std::sin(angle), height), 1e-3);
    EXPECT_NEAR(l.centre.direction.elevation_deg,
                std::atan2(height, kR * std::sin(angle)) / mars::kRadiansPerDegree, 1e-7);
    if (n == 19) continue;  // just on the horizon
    EXPECT_EQ(l.hidden_by.has_value(), n > 19) << n;
    if (!l.hidden_by) continue;
    EXPECT_LT(l.hidden_by->range_m, mars::horizon_distance_m(kAlt, kR));
    EXPECT_NEAR(l.hidden_by->elevation_m, 0, 1e-3);
    EXPECT_NEAR(std::remainder(mars::initial_bearing_deg(at, l.hidden_by->place) - 9 * number, 360), 0, 1e-5);
  }
}

TEST(Landmarks, TheDistanceLimitIsStraightAndNamesWhatHides) {
  const mars::LonLat at{0, 0};
  const Viewpoint camera = panorama::viewpoint_at(at, 100, kR);  // horizon at 26 km
  const std::vector<Place> features{{"planet", 0, 0, 3e7},
                                    {"plain", 0.3, 0, 100000},
                                    {"hill", 0.43, 0, 6000},
                                    {"far", 2, 0, 0},
                                    {"behind", 180, 0, 0}};
  auto list = seen(camera, features, 200000);
  ASSERT_EQ(list.size(), 4U);
  EXPECT_EQ(list[3].feature.name, "far");
  ASSERT_TRUE(list[3].hidden_by);
  EXPECT_NEAR(list[3].hidden_by->place.lat_deg, 0, 1e-9);
  // The line to it goes into the ground before the horizon.
  EXPECT_EQ(list[3].hidden_by_name, "plain");
  EXPECT_EQ(seen(camera, features, 118000).size(), 3U);
  EXPECT_EQ(seen(camera, features, 1e9).size(), 5U);
  EXPECT_EQ(panorama::smallest_feature_around(features, {0.44, 0}, kR)->name, "hill");
  EXPECT_EQ(panorama::smallest_feature_around(std::span(features).subspan(3), {2, 0}, kR), nullptr);
}

TEST(Landmarks, FarthestSight) {
  // Both of one height: twice the way to the horizon; a camera at the bottom sees the top alone.
  EXPECT_NEAR(panorama::farthest_sight_m(kR + 2000, kR, kR + 2000), 2 * mars::horizon_distance_m(2000, kR),
              1e-6);
  EXPECT_NEAR(panorama::farthest_sight_m(kR, kR, kR + 2000), mars::horizon_distance_m(2000, kR), 1e-6);
}

std::vector<panorama::GroundPoint> horizon_at(double elevation_deg) {
  std::vector<panorama::GroundPoint> out(4);
  for (std::size_t n = 0; n < out.size(); ++n)
    out[n].direction = {90.0 * static_cast<double>(n), elevation_deg};
  return out;
}

TEST(Stellarium, ListAndPlace) {
  EXPECT_EQ(panorama::stellarium_list(horizon_at(1.25)),
            "# azimuth (clockwise from north) and elevation, degrees\n0.000000 1.250000\n90.000000 1.250000\n"
            "180.000000 1.250000\n270.000000 1.250000\n");
  const std::string ini =
      panorama::stellarium_ini({"two\nlines", "Mars", {137.5, -4.25}, -4444.6}, horizon_at(1));
  for (const char* line :
       {"[landscape]\nname = two lines\ntype = polygonal\n", "\npolygonal_horizon_list = horizon.txt\n",
        "\npolygonal_horizon_list_mode = azDeg_altDeg\n", "\nminimal_altitude = -2\n",
        "\n[location]\nplanet = Mars\n",
        "\nlatitude = -4.25000000\nlongitude = 137.50000000\naltitude = -4445\n"})
    EXPECT_NE(ini.find(line), std::string::npos) << line << ini;
  // From orbit the ground begins far down.
  EXPECT_NE(panorama::stellarium_ini({}, horizon_at(-60.5)).find("\nminimal_altitude = -61\n"),
            std::string::npos);
}

}  // namespace
