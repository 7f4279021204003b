// Coordinates of maps against PROJ itself.
#include "mars/raster/output/map_crs.h"

#include <gtest/gtest.h>
#include <proj.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "mars/geodesy/sphere.h"
#include "mars/sources/source.h"

namespace {

constexpr double kMars_m = 3396190;
// Of the same body as a system: PROJ compares their names.
std::string degrees_of(const std::string& crs) {
  return crs.starts_with("IAU") ? "IAU_2015:49900" : "+proj=longlat +R=3396190 +no_defs +type=crs";
}

// Converts degrees by PROJ, from longitudes and latitudes on the sphere.
class Oracle {
 public:
  explicit Oracle(const std::string& crs) {
    context_ = proj_context_create();
    PJ* raw = proj_create_crs_to_crs(context_, degrees_of(crs).c_str(), crs.c_str(), nullptr);
    transform_ = proj_normalize_for_visualization(context_, raw);
    proj_destroy(raw);
  }
  ~Oracle() {
    proj_destroy(transform_);
    proj_context_destroy(context_);
  }
  Oracle(const Oracle&) = delete;
  Oracle& operator=(const Oracle&) = delete;

  glm::dvec2 to_map(glm::dvec2 p) const {
    const PJ_COORD out = proj_trans(transform_, PJ_FWD, proj_coord(p.x, p.y, 0, 0));
    return {out.xy.x, out.xy.y};
  }

 private:
  PJ_CONTEXT* context_ = nullptr;
  PJ* transform_ = nullptr;
};

const std::vector<std::string> kSystems{"IAU_2015:49900",
                                        "IAU_2015:49910",
                                        "IAU_2015:49915",
                                        "IAU_2015:49930",
                                        "IAU_2015:49935",
                                        "IAU_2015:49960",
                                        "+proj=sinu +lon_0=120 +R=3396190 +type=crs",
                                        "+proj=laea +lat_0=-4.5 +lon_0=137 +R=3396190 +type=crs",
                                        "+proj=lcc +lat_1=20 +lat_2=50 +lon_0=30 +R=3396190 +type=crs",
                                        "+proj=merc +R=3396190 +type=crs",
                                        "+proj=aeqd +lat_0=10 +lon_0=-75 +R=3396190 +type=crs",
                                        "+proj=eqc +lat_ts=30 +lon_0=180 +R=3396190 +type=crs"};

TEST(MapCrs, AgreesWithProj) {
  for (const std::string& system : kSystems) {
    const mars::MapCrs crs(system, kMars_m);
    const Oracle oracle(system);
    // Within 60 degrees of the middle of all of them, or of a pole.
    const bool south = system.ends_with("49935");
    const bool transverse = system.ends_with("49960");
    const double middle =
        system.find("lon_0=120") != std::string::npos || system.find("lon_0=137") != std::string::npos ? 120
        : system.find("lon_0=-75") != std::string::npos                                                ? -60
        : system.find("180") != std::string::npos || system.ends_with("49915")                         ? 170
                                                                                                       : 10;
    std::vector<glm::dvec2> places;
    for (int i = -5; i <= 5; ++i) {
      for (int j = 0; j <= 8; ++j)
        places.emplace_back(middle + 7.3 * i, south ? -30 - 6.9 * j : -25 + 10.7 * j);
    }
    std::vector<glm::dvec2> mapped = places;
    crs.to_map(mapped);
    double worst = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const glm::dvec2 expected = oracle.to_map(places[i]);
      worst = std::max({worst, std::abs(mapped[i].x - expected.x), std::abs(mapped[i].y - expected.y)});
    }
    EXPECT_LE(worst, crs.geographic() ? 1e-12 : 1e-5) << system;
    crs.to_place(mapped);
    double back = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      ASSERT_TRUE(std::isfinite(mapped[i].x)) << system << ' ' << places[i].x << ' ' << places[i].y;
      back = std::max(back, mars::angle_between_rad(mars::direction({places[i].x, places[i].y}),
                                                    mars::direction({mapped[i].x, mapped[i].y})) *
                                kMars_m);
    }
    EXPECT_LE(back, transverse ? 1e-3 : 1e-5) << system;
  }
}

TEST(MapCrs, PolesAndTheAntimeridianArePlaces) {
  const mars::MapCrs polar("IAU_2015:49930", kMars_m);
  std::vector<glm::dvec2> pole{{0, 0}};
  polar.to_place(pole);
  EXPECT_NEAR(pole[0].y, 90, 1e-9);
  const mars::MapCrs plain("IAU_2015:49910", kMars_m);
  // 1000 km east of the antimeridian, and of the next one.
  const double half_m = mars::kRadiansPerDegree * 180 * kMars_m;
  EXPECT_NEAR(plain.period(), 2 * half_m, 1e-6);
  std::vector<glm::dvec2> beyond{{half_m + 1e6, 0}, {-half_m - 1e6, 5e5}};
  plain.to_place(beyond);
  EXPECT_NEAR(mars::normalize_lon_deg(beyond[0].x), -180 + 1e6 / kMars_m / mars::kRadiansPerDegree, 1e-9);
  EXPECT_NEAR(mars::normalize_lon_deg(beyond[1].x), 180 - 1e6 / kMars_m / mars::kRadiansPerDegree, 1e-9);
  // Beyond the poles there is nothing.
  std::vector<glm::dvec2> above{{0, half_m / 2 + 10}};
  plain.to_place(above);
  EXPECT_TRUE(std::isnan(above[0].x));
}

TEST(MapCrs, BeyondTheRimOfTheMapThereIsNoPlanet) {
  struct Rim {
    std::string crs;
    glm::dvec2 inside;
    glm::dvec2 outside;
  };
  const double radius_m = kMars_m;
  const double half_m = std::numbers::pi * kMars_m;
  for (const Rim& rim :
       {Rim{"+proj=ortho +lat_0=20 +lon_0=40 +R=3396190",
            {0.9 * radius_m, 0},
            {0.99 * radius_m, 0.2 * radius_m}},
        Rim{"+proj=sinu +R=3396190", {0.4 * half_m, 0.33 * half_m}, {0.6 * half_m, 0.33 * half_m}},
        Rim{"+proj=laea +lat_0=90 +R=3396190", {1.9 * radius_m, 0}, {1.9 * radius_m, radius_m}},
        Rim{"+proj=moll +R=3396190", {0, 0.9 * std::sqrt(2) * radius_m}, {1.5 * radius_m, 1.35 * radius_m}}}) {
    const mars::MapCrs crs(rim.crs, kMars_m);
    EXPECT_EQ(crs.period(), 0) << rim.crs;
    std::vector<glm::dvec2> points{rim.inside, rim.outside};
    crs.to_place(points);
    EXPECT_TRUE(std::isfinite(points[0].x)) << rim.crs;
    EXPECT_TRUE(std::isnan(points[1].x)) << rim.crs << ' ' << points[1].x << ' ' << points[1].y;
  }
}

TEST(MapCrs, LatitudesOfAnEllipsoidAreThoseOfTheCrs) {
  // Planetographic latitudes of the IAU's ellipsoid; the places are planetocentric.
  const mars::MapCrs crs("IAU_2015:49912", kMars_m);
  std::vector<glm::dvec2> places{{0, 45}, {0, -60}, {0, 90}};
  crs.to_map(places);
  const double k = (3396190.0 / 3376200.0) * (3396190.0 / 3376200.0);
  for (const auto& [row, centric_deg] : {std::pair(0, 45.0), std::pair(1, -60.0)}) {
    const double graphic = std::atan(k * std::tan(centric_deg * mars::kRadiansPerDegree));
    EXPECT_NEAR(places[static_cast<std::size_t>(row)].y, graphic * kMars_m, 1e-4);
  }
  crs.to_place(places);
  EXPECT_NEAR(places[0].y, 45, 1e-9);
  EXPECT_NEAR(places[1].y, -60, 1e-9);
  EXPECT_NEAR(places[2].y, 90, 1e-6);
}

std::string message_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const mars::SourceError& e) {
    return e.what();
  }
  return "";
}

TEST(MapCrs, WhatIsNoMapOfThisPlanetIsRefused) {
  const auto refusal = [](const std::string& text, double radius_m = kMars_m) {
    return message_of([&] { mars::MapCrs(text, radius_m); });
  };
  EXPECT_NE(refusal("nonsense").find("PROJ does not know it"), std::string::npos) << refusal("nonsense");
  EXPECT_NE(refusal("").find("PROJ does not know it"), std::string::npos);
  EXPECT_NE(refusal("EPSG:4326").find("6378137"), std::string::npos) << refusal("EPSG:4326");
  EXPECT_NE(refusal("EPSG:4978").find("neither geographic nor projected"), std::string::npos);
  EXPECT_NE(refusal("IAU_2015:49901").find("to the west"), std::string::npos);
  EXPECT_NE(refusal("http://127.0.0.1:1/crs.wkt"), "");
  EXPECT_NE(refusal("IAU_2015:30110").find("1737400"), std::string::npos);
  EXPECT_EQ(refusal("IAU_2015:30110", 1737400), "");
  EXPECT_EQ(refusal("EPSG:3857", 6371000), "") << "within 1 %";
}

TEST(MapCrs, UnitsAndText) {
  const mars::MapCrs degrees("IAU_2015:49900", kMars_m);
  EXPECT_TRUE(degrees.geographic());
  EXPECT_NEAR(degrees.unit_m(), kMars_m * mars::kRadiansPerDegree, 1e-6);
  EXPECT_NEAR(degrees.period(), 360, 1e-9);
  const mars::MapCrs kilometres("+proj=eqc +R=3396190 +units=km", kMars_m);
  EXPECT_FALSE(kilometres.geographic());
  EXPECT_EQ(kilometres.unit_m(), 1000);
  EXPECT_NE(degrees.wkt().find("GEOGCRS"), std::string::npos) << degrees.wkt();
  // A file that says the WKT is the same system again.
  EXPECT_EQ(mars::MapCrs(degrees.wkt(), kMars_m).wkt(), degrees.wkt());
}

RC_GTEST_PROP(MapCrsProperty, PlacesComeBackFromPolarMaps, ()) {
  static const mars::MapCrs kNorth("IAU_2015:49930", kMars_m);
  const double lon_deg = *rc::gen::inRange(-1'800'000, 1'800'000) / 1e4;
  const double lat_deg = *rc::gen::inRange(-400'000, 900'001) / 1e4;
  std::vector<glm::dvec2> point{{lon_deg, lat_deg}};
  kNorth.to_map(point);
  kNorth.to_place(point);
  const double apart =
      mars::angle_between_rad(mars::direction({lon_deg, lat_deg}), mars::direction({point[0].x, point[0].y}));
  RC_ASSERT(apart < 1e-12);
}

}  // namespace
