// The embedded Mars against published places and heights, against MOLA, and against its own contracts.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>
#include <vector>

#include "mars/embedded/craters.h"
#include "mars/embedded/embedded.h"
#include "mars/embedded/math.h"
#include "mars/geodesy/cube.h"
#include "tests/support/support.h"

namespace mars {
namespace {

using test_support::Random;

std::vector<double> heights(const std::vector<glm::dvec3>& directions, double spacing_m) {
  std::vector<double> out(directions.size());
  embedded_elevation()->sample(directions, spacing_m, out);
  return out;
}

// Places within `radius_km` of one, on a grid.
std::vector<glm::dvec3> disc(LonLat p, double radius_km, double step_km) {
  const LocalFrame f = local_frame(p);
  std::vector<glm::dvec3> directions;
  for (double n = -radius_km; n <= radius_km; n += step_km) {
    for (double e = -radius_km; e <= radius_km; e += step_km) {
      if (e * e + n * n > radius_km * radius_km) continue;
      directions.push_back(glm::normalize(f.up + (e * f.east + n * f.north) * (1000.0 / kMarsRadius_m)));
    }
  }
  return directions;
}

double median(std::vector<double> v) {
  std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
  return v[v.size() / 2];
}
double highest(LonLat p, double radius_km, double step_km) {
  const auto h = heights(disc(p, radius_km, step_km), 500.0);
  return *std::max_element(h.begin(), h.end());
}
double lowest(LonLat p, double radius_km, double step_km) {
  const auto h = heights(disc(p, radius_km, step_km), 500.0);
  return *std::min_element(h.begin(), h.end());
}
double middle(LonLat p, double radius_km, double step_km) {
  return median(heights(disc(p, radius_km, step_km), 500.0));
}

struct Summit {
  const char* name;
  LonLat place;
  double height_m;
  double contour_m;  // the mountain's place is the middle of what is above this
};
constexpr Summit kSummits[] = {
    {"Olympus Mons", {226.20, 18.65}, 21229, 15000}, {"Ascraeus Mons", {255.92, 11.92}, 18200, 13500},
    {"Pavonis Mons", {247.04, 1.48}, 14100, 11500},  {"Arsia Mons", {239.91, -8.26}, 17760, 13500},
    {"Elysium Mons", {147.21, 25.02}, 14100, 5000},
};

TEST(EmbeddedLandforms, SummitsAreAsHighAndWhereTheyAre) {
  for (const Summit& s : kSummits) {
    const auto directions = disc(s.place, 260, 3);
    const auto h = heights(directions, 1000.0);
    EXPECT_NEAR(*std::max_element(h.begin(), h.end()), s.height_m, 0.1 * s.height_m) << s.name;
    // Middle of the contour line, so that the caldera does not count.
    glm::dvec3 sum{0, 0, 0};
    for (std::size_t i = 0; i < h.size(); ++i) {
      if (h[i] > s.contour_m) sum += directions[i];
    }
    ASSERT_GT(glm::length(sum), 10.0) << s.name;
    const double off_deg = angle_between_rad(sum, direction(s.place)) / kRadiansPerDegree;
    EXPECT_LT(off_deg, 0.2) << s.name;
  }
  EXPECT_NEAR(highest({250.40, 40.47}, 200, 4), 6800, 680) << "Alba Mons";
}

TEST(EmbeddedLandforms, OlympusHasAScarpAndANestedCaldera) {
  // From the plain to the top of the scarp within 40 km, at all azimuths where no lava covers it.
  int cliffs = 0;
  for (int bearing = 0; bearing < 360; bearing += 10) {
    std::vector<glm::dvec3> line;
    for (int km = 240; km <= 400; ++km) {
      line.push_back(direction(destination({226.20, 18.65}, bearing, km * 1000.0 / kMarsRadius_m)));
    }
    const auto h = heights(line, 500.0);
    double most = 0.0;
    for (std::size_t i = 0; i + 40 < h.size(); ++i) most = std::max(most, h[i] - h[i + 40]);
    cliffs += most > 3500.0;
  }
  EXPECT_GE(cliffs, 20);
  const double top = highest({226.20, 18.65}, 70, 1);
  const double pit = lowest({226.20, 18.65}, 35, 1);
  EXPECT_NEAR(top - pit, 3000.0, 450.0);
}

TEST(EmbeddedLandforms, BasinsAndPlainsAreAsDeep) {
  EXPECT_NEAR(middle({70.5, -42.43}, 250, 10), -7152, 715) << "Hellas";
  EXPECT_NEAR(lowest({62.2, -32.8}, 900, 10), -8200, 820) << "Hellas, lowest";
  EXPECT_NEAR(middle({316.69, -49.84}, 200, 10), -2750, 500) << "Argyre, published -2500 .. -3000";
  EXPECT_NEAR(middle({88.38, 13.94}, 300, 10), -3900, 390) << "Isidis";
  EXPECT_NEAR(middle({117.52, 46.74}, 300, 10), -4500, 450) << "Utopia";
  EXPECT_NEAR(middle({137.44163, -4.58946}, 3, 0.5), -4501, 450) << "Gale, Bradbury Landing";
  const double floor = middle({137.44163, -4.58946}, 3, 0.5);
  EXPECT_NEAR(highest({137.85, -5.08}, 12, 0.5) - floor, 5500, 550) << "Aeolis Mons";
  EXPECT_NEAR(middle({77.6, 18.38}, 5, 0.5), -2650, 265) << "Jezero";
}

TEST(EmbeddedLandforms, VallesMarinerisIsSevenKilometresDeep) {
  // Floor below the plateaus on both sides of the main chasmata.
  struct Section {
    const char* name;
    LonLat floor, north, south;
    double least_m, most_m;
  };
  const Section sections[] = {{"Ius", {281.0, -8.1}, {281.0, -6.6}, {281.0, -11.5}, 5000, 9500},
                              {"Melas", {287.46, -10.52}, {291.0, -9.3}, {286.0, -14.5}, 6300, 9500},
                              {"Candor", {289.22, -6.2}, {293.0, -4.5}, {291.0, -9.2}, 5500, 9000},
                              {"Coprates", {299.26, -13.37}, {299.3, -11.6}, {297.0, -16.5}, 6300, 9000},
                              {"Ganges", {312.11, -8.3}, {312.1, -5.4}, {311.0, -10.0}, 3200, 7000}};
  for (const Section& s : sections) {
    const double floor = middle(s.floor, 8, 1);
    const double rim = 0.5 * (middle(s.north, 15, 2) + middle(s.south, 15, 2));
    EXPECT_GT(rim - floor, s.least_m) << s.name << " " << floor << " " << rim;
    EXPECT_LT(rim - floor, s.most_m) << s.name << " " << floor << " " << rim;
  }
}

TEST(EmbeddedLandforms, WallsOfVallesMarinerisAreSteepAndItsFloorIsNot) {
  const auto slope_deg = [](LonLat p, double radius_km) {
    // Mean slope over 320 m steps northwards.
    const auto directions = disc(p, radius_km, 0.7);
    std::vector<glm::dvec3> north;
    for (const glm::dvec3& d : directions) {
      const LonLat q = lon_lat(d);
      north.push_back(direction({q.lon_deg, q.lat_deg + 320.0 / kMarsRadius_m / kRadiansPerDegree}));
    }
    const auto a = heights(directions, 160.0);
    const auto b = heights(north, 160.0);
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += std::atan(std::abs(b[i] - a[i]) / 320.0);
    return sum / static_cast<double>(a.size()) / kRadiansPerDegree;
  };
  double steepest = 0.0;
  for (double lat = -12.9; lat < -11.6; lat += 0.1) steepest = std::max(steepest, slope_deg({299.3, lat}, 4));
  EXPECT_GT(steepest, 18.0);
  EXPECT_LT(slope_deg({299.3, -13.4}, 8), 5.0);
}

TEST(EmbeddedLandforms, PolarCapsAreDomesOfThreeKilometres) {
  EXPECT_NEAR(middle({0, 90}, 60, 5) - middle({190, 74}, 200, 20), 3000, 300);
  EXPECT_NEAR(middle({160, -86}, 60, 5) - middle({200, -71}, 150, 20), 3000, 900);
}

TEST(EmbeddedLandforms, AgreesWithMolaAtLarge) {
  VPE_NEED_SHARED(path, "mola4/megt90n000cb.img");
  std::ifstream file(path, std::ios::binary);
  std::vector<unsigned char> raw(1440 * 720 * 2);
  ASSERT_TRUE(file.read(reinterpret_cast<char*>(raw.data()), static_cast<std::streamsize>(raw.size())));
  std::vector<glm::dvec3> directions;
  std::vector<double> mola;
  std::vector<double> weight;
  for (std::size_t row = 3; row < 720; row += 6) {
    for (std::size_t col = 3; col < 1440; col += 6) {
      const std::size_t at = 2 * (1440 * row + col);
      const double lat = 90.0 - (static_cast<double>(row) + 0.5) / 4.0;
      directions.push_back(direction({(static_cast<double>(col) + 0.5) / 4.0, lat}));
      mola.push_back(static_cast<std::int16_t>(raw[at] << 8 | raw[at + 1]));
      weight.push_back(std::cos(lat * kRadiansPerDegree));
    }
  }
  const auto h = heights(directions, 3700.0);
  double w = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0, dd = 0;
  for (std::size_t i = 0; i < h.size(); ++i) {
    w += weight[i];
    x += weight[i] * h[i];
    y += weight[i] * mola[i];
    xx += weight[i] * h[i] * h[i];
    yy += weight[i] * mola[i] * mola[i];
    xy += weight[i] * h[i] * mola[i];
    dd += weight[i] * (h[i] - mola[i]) * (h[i] - mola[i]);
  }
  const double correlation =
      (xy / w - x / w * (y / w)) / std::sqrt((xx / w - x / w * (x / w)) * (yy / w - y / w * (y / w)));
  RecordProperty("correlation", std::to_string(correlation));
  RecordProperty("rms_m", std::to_string(std::sqrt(dd / w)));
  EXPECT_GT(correlation, 0.95);
  EXPECT_LT(std::sqrt(dd / w), 900.0);
  EXPECT_NEAR(x / w, y / w, 200.0);
}

TEST(EmbeddedCraters, HighlandsHaveManyAndPlainsFew) {
  // Every candidate of a level about a place, kept by its ground.
  const auto count = [](LonLat p, double radius_km, int level) {
    std::vector<embedded::Candidate> candidates;
    const glm::dvec3 centre = direction(p);
    embedded::find_candidates(centre, radius_km * 1000.0 / kMarsRadius_m, level, candidates);
    std::vector<embedded::Crater> craters;
    embedded::keep_craters(candidates, embedded::best_simd(), craters);
    return std::count_if(craters.begin(), craters.end(), [&](const embedded::Crater& c) {
      return angle_between_rad(c.centre, centre) * kMarsRadius_m < radius_km * 1000.0;
    });
  };
  double highland = 0;
  double plain = 0;
  for (const LonLat& p : {LonLat{20, -35}, LonLat{150, -50}, LonLat{-170, -60}}) {
    highland += static_cast<double>(count(p, 500, 13));
  }
  for (const LonLat& p : {LonLat{-160, 45}, LonLat{120, 55}, LonLat{-20, 60}}) {
    plain += static_cast<double>(count(p, 500, 13));
  }
  EXPECT_GT(highland, 10.0 * plain);
  // Noachian highlands have some 200 to 500 craters of 8..16 km in a million square kilometres, and some 100 to
  // 200 of 16..32 km.
  EXPECT_NEAR(highland / (3 * kPi * 0.25), 350.0, 150.0);
  double larger = 0;
  for (const LonLat& p : {LonLat{20, -35}, LonLat{150, -50}, LonLat{-170, -60}}) {
    larger += static_cast<double>(count(p, 500, 14));
  }
  EXPECT_NEAR(larger / (3 * kPi * 0.25), 150.0, 60.0);
}

TEST(EmbeddedCraters, EveryCandidateIsFoundFromEveryPlaceItTouches) {
  Random random(81);
  int checked = 0;
  for (int k = 0; k < 100; ++k) {
    const int level = random.integer(1, 17);
    std::vector<embedded::Candidate> around;
    const glm::dvec3 centre = random.direction();
    const double cell = embedded::crater_cell_m(level) / kMarsRadius_m;
    embedded::find_candidates(centre, 3.0 * cell, level, around);
    for (const embedded::Candidate& c : around) {
      const double reach = c.crater.radius_m * embedded::kEjectaReach / kMarsRadius_m;
      const glm::dvec3 rim = glm::normalize(c.crater.centre + random.direction() * reach * 0.999);
      if (glm::length(rim - c.crater.centre) > reach) continue;
      std::vector<embedded::Candidate> here;
      embedded::find_candidates(rim, 0.0, level, here);
      EXPECT_TRUE(std::any_of(here.begin(), here.end(), [&c](const embedded::Candidate& other) {
        return other.crater.centre == c.crater.centre && other.crater.radius_m == c.crater.radius_m;
      })) << level;
      ++checked;
    }
  }
  EXPECT_GT(checked, 200);
}

TEST(EmbeddedRegions, CapsReturnTheFinestSpacingOfTheirPlaces) {
  Random random(82);
  const auto source = embedded_elevation();
  const auto image = embedded_image();
  int fine = 0;
  for (int k = 0; k < 3000; ++k) {
    const LonLat near{random.uniform(-100, -35), random.uniform(-18, 22)};
    const Cap cap{k % 3 == 0 ? random.direction() : direction(near), random.log_uniform(1e-5, 0.3)};
    const double whole = source->spacing_in(cap);
    for (int i = 0; i < 8; ++i) {
      const double bearing_deg = random.uniform(0, 360);
      const LonLat p = destination(lon_lat(cap.centre), bearing_deg, cap.radius_rad * random.uniform(0, 1));
      EXPECT_GE(source->spacing_in({direction(p), 0.0}), whole);
    }
    fine += whole < 3700.0;
    EXPECT_EQ(image->spacing_in(cap) < 2600.0, whole < 3700.0);
  }
  EXPECT_GT(fine, 300);
  EXPECT_EQ(source->spacing_in({direction({226.2, 18.65}), 0.0}), kEmbeddedPosts.landmark_m);
  EXPECT_EQ(source->spacing_in({direction({30, 30}), 0.0}), kEmbeddedPosts.plain_m);
  EXPECT_EQ(source->spacing_in({{0, 0, 1}, kPi}), kEmbeddedPosts.demo_m);
}

TEST(EmbeddedRegions, DemoPathLiesOnTheFloorInsideItsCorridor) {
  const auto path = demo_path();
  ASSERT_GE(path.size(), 3U);
  Random random(83);
  double length_m = 0.0;
  std::vector<glm::dvec3> line;
  for (std::size_t i = 1; i < path.size(); ++i) {
    const glm::dvec3 a = direction(path[i - 1]);
    const glm::dvec3 b = direction(path[i]);
    length_m += angle_between_rad(a, b) * kMarsRadius_m;
    for (int k = 0; k < 60; ++k) {
      const glm::dvec3 p = slerp(a, b, random.uniform(0, 1));
      line.push_back(p);
      const double bearing_deg = random.uniform(0, 360);
      const LonLat beside =
          destination(lon_lat(p), bearing_deg, random.uniform(0, 0.999) * kDemoHalfWidth_m / kMarsRadius_m);
      EXPECT_EQ(embedded_elevation()->spacing_in({direction(beside), 0.0}), kEmbeddedPosts.demo_m);
      EXPECT_EQ(embedded_image()->spacing_in({direction(beside), 0.0}), kEmbeddedTexels.demo_m);
    }
  }
  EXPECT_GT(length_m, 500e3);
  EXPECT_LT(length_m, 700e3);
  for (const double h : heights(line, 60.0)) {
    EXPECT_LT(h, -3500.0);
    EXPECT_GT(h, -6500.0);
  }
}

TEST(EmbeddedSources, StateThatTheyAreAnIllustration) {
  for (const auto& infos : {embedded_elevation()->infos(), embedded_image()->infos()}) {
    ASSERT_EQ(infos.size(), 1U);
    EXPECT_EQ(infos[0].name, "embedded Mars (illustration)");
    EXPECT_TRUE(infos[0].illustration);
    EXPECT_EQ(infos[0].datum, mars::VerticalDatum::areoid());
    EXPECT_FALSE(infos[0].accuracy_m.has_value());
  }
  std::vector<int> index(2, -1);
  embedded_elevation()->origin(std::vector<glm::dvec3>(2, {1, 0, 0}), index);
  EXPECT_EQ(index, (std::vector<int>{0, 0}));
}

TEST(EmbeddedSources, PostsForTheResamplingErrorAreItsOwnValues) {
  const auto source = embedded_elevation();
  std::size_t posts = 0;
  glm::dvec3 mean{0, 0, 0};
  source->visit_posts(2000, [&](std::span<const glm::dvec3> directions, std::span<const double> values) {
    ASSERT_EQ(directions.size(), values.size());
    posts += directions.size();
    for (std::size_t i = 0; i < directions.size(); i += 97) {
      EXPECT_NEAR(glm::length(directions[i]), 1.0, 1e-15);
      const double spacing_m = source->spacing_in({directions[i], 0.0});
      EXPECT_EQ(heights({directions[i]}, spacing_m)[0], values[i]);
    }
    for (const glm::dvec3& d : directions) mean += d;
  });
  EXPECT_EQ(posts, 2000U);
  EXPECT_LT(glm::length(mean) / 2000.0, 0.01);
  source->visit_posts(0, [](auto, auto) { FAIL(); });
}

TEST(EmbeddedImage, HasTheClassicalAlbedoFeatures) {
  const auto brightness = [](LonLat p, double radius_km) {
    const auto directions = disc(p, radius_km, radius_km / 10);
    std::vector<vpe::base::Rgb> colours(directions.size());
    std::vector<std::uint8_t> alpha(directions.size(), 0);
    embedded_image()->sample(directions, 2600.0, colours, alpha);
    double sum = 0.0;
    for (std::size_t i = 0; i < colours.size(); ++i) {
      EXPECT_EQ(alpha[i], 255);
      EXPECT_GE(colours[i].r + 8, colours[i].b);
      sum += (colours[i].r + colours[i].g + colours[i].b) / 3.0;
    }
    return sum / static_cast<double>(colours.size());
  };
  const double bright =
      std::min({brightness({20, 22}, 200), brightness({70, -42}, 200), brightness({226, 18}, 200)});
  const double dark =
      std::max({brightness({68, 9}, 200), brightness({332, 47}, 200), brightness({140, -25}, 200)});
  EXPECT_GT(bright, dark + 25.0);
  EXPECT_GT(brightness({0, 90}, 100), bright + 40.0);
  EXPECT_GT(brightness({0, -88.5}, 50), bright + 30.0);
}

}  // namespace
}  // namespace mars
