// The embedded Mars against published places, heights and crater counts, against MOLA, and against its own contracts.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>
#include <vector>

#include "mars/embedded/craters.h"
#include "mars/embedded/embedded.h"
#include "mars/embedded/ground.h"
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
    // Mountains are not round, and names stand in their middles roughly.
    EXPECT_LT(off_deg, 0.9) << s.name;
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
  EXPECT_NEAR(top - pit, 3200.0, 450.0);
}

TEST(EmbeddedLandforms, BasinsAndPlainsAreAsDeep) {
  EXPECT_NEAR(middle({70.5, -42.43}, 250, 10), -7152, 715) << "Hellas";
  EXPECT_NEAR(lowest({62.2, -32.8}, 900, 10), -8200, 820) << "Hellas, lowest";
  EXPECT_NEAR(middle({316.69, -49.84}, 200, 10), -2750, 500) << "Argyre, published -2500 .. -3000";
  EXPECT_NEAR(middle({88.38, 13.94}, 300, 10), -3900, 390) << "Isidis";
  EXPECT_NEAR(middle({117.52, 46.74}, 300, 10), -4500, 450) << "Utopia";
  EXPECT_NEAR(middle({137.44163, -4.58946}, 3, 0.5), -4501, 450) << "Gale, Bradbury Landing";
  const double floor = middle({137.44163, -4.58946}, 3, 0.5);
  EXPECT_NEAR(highest({137.85, -5.08}, 12, 0.5) - floor, 5000, 500) << "Aeolis Mons, in posts of 7.4 km";
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
  EXPECT_LT(slope_deg({298.0, -12.8}, 8), 6.0);
}

TEST(EmbeddedLandforms, PolarCapsAreDomes) {
  EXPECT_NEAR(middle({0, 90}, 60, 5) - middle({190, 74}, 200, 20), 3000, 300);
  EXPECT_NEAR(middle({160, -86}, 60, 5) - middle({200, -71}, 150, 20), 2050, 200);
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
  const auto h = heights(directions, 5300.0);
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
  EXPECT_GT(correlation, 0.9995);
  EXPECT_LT(std::sqrt(dd / w), 90.0);
  EXPECT_NEAR(x / w, y / w, 5.0);
}

// Craters of a level or larger about a place, kept by their ground.
std::vector<embedded::Crater> craters_about(LonLat p, double radius_m, int level) {
  std::vector<embedded::Candidate> candidates;
  const glm::dvec3 centre = direction(p);
  for (int k = level; k <= embedded::kLargestCraterLevel; ++k)
    embedded::find_candidates(centre, radius_m / kMarsRadius_m, k, candidates);
  std::vector<embedded::Crater> craters;
  embedded::keep_craters(candidates, embedded::MeasuredMars::get(), embedded::best_simd(), craters);
  std::erase_if(craters, [&](const embedded::Crater& c) {
    return angle_between_rad(c.centre, centre) * kMarsRadius_m > radius_m;
  });
  return craters;
}

// The polynomial of Ivanov (2001): craters of a kilometre D and more in a square kilometre after 1 Ga.
double ivanov_2001(double diameter_km) {
  constexpr double kA[] = {-3.384, -3.197,  1.257,    0.7915,    -0.4861,  -0.3630,
                           0.1016, 0.06756, -0.01181, -0.004753, 6.233e-4, 5.805e-5};
  const double x = std::log10(diameter_km);
  double sum = 0.0;
  for (int k = 11; k >= 0; --k) sum = sum * x + kA[k];
  return std::pow(10.0, sum);
}

TEST(EmbeddedCraters, TheTableIsThePublishedFunction) {
  for (double d_m = 8.0; d_m <= 8192.0; d_m *= 1.3) {
    const double young = 0.15e-6 * ivanov_2001(d_m / 1000.0);
    EXPECT_NEAR(embedded::crater_density(d_m, 0.0) / std::min(young, 0.0616 / (d_m * d_m)), 1.0, 0.1) << d_m;
    EXPECT_LE(embedded::crater_density(d_m, 1.3), 0.0616 / (d_m * d_m) * 1.0001);
  }
}

TEST(EmbeddedCraters, NumbersFollowThePublishedFunction) {
  // Counted against the function for the density of pits that the data have there, from 10 m to 5 km. Larger craters are
  // in the data.
  struct Count {
    double diameter_m, radius_m;
  };
  for (const LonLat& p :
       {LonLat{20, -35}, LonLat{150, -50}, LonLat{-160, 45}, LonLat{120, 55}, LonLat{-70, -20}}) {
    for (const Count& c : {Count{10, 900}, Count{40, 3500}, Count{150, 12e3}, Count{600, 50e3},
                           Count{2500, 300e3}, Count{5000, 700e3}}) {
      int level = embedded::kSmallestCraterLevel;
      while (static_cast<double>(2 << level) <= c.diameter_m) ++level;
      const auto craters = craters_about(p, c.radius_m, level);
      const auto counted = static_cast<double>(std::count_if(
          craters.begin(), craters.end(), [&](const auto& k) { return 2.0 * k.radius_m >= c.diameter_m; }));
      // The function, averaged over the ground there.
      double expected = 0.0;
      const auto places = disc(p, c.radius_m / 1000.0, c.radius_m / 6000.0);
      embedded::Block block;
      static embedded::Ground ground;
      for (std::size_t first = 0; first < places.size(); first += embedded::kBlock) {
        block.count = std::min(embedded::kBlock, places.size() - first);
        for (std::size_t i = 0; i < block.count; ++i) {
          block.x[i] = places[first + i].x;
          block.y[i] = places[first + i].y;
          block.z[i] = places[first + i].z;
        }
        block.finish();
        embedded::lay_ground(block, embedded::MeasuredMars::get(), ground);
        for (std::size_t i = 0; i < block.count; ++i)
          expected += (embedded::crater_density(c.diameter_m, static_cast<double>(ground.cratered[i])) -
                       embedded::crater_density(8192, static_cast<double>(ground.cratered[i]))) *
                      (1.0 - 0.9 * static_cast<double>(ground.wall[i]));
      }
      expected *= kPi * c.radius_m * c.radius_m / static_cast<double>(places.size());
      if (expected < 12.0) continue;  // too few to tell a factor of two
      EXPECT_GT(counted, 0.5 * expected) << p.lon_deg << "," << p.lat_deg << " " << c.diameter_m << " m";
      EXPECT_LT(counted, 2.0 * expected) << p.lon_deg << "," << p.lat_deg << " " << c.diameter_m << " m";
    }
  }
}

TEST(EmbeddedCraters, HighlandsHaveManyAndPlainsFew) {
  std::size_t highland = 0, plain = 0;
  for (const LonLat& p : {LonLat{20, -35}, LonLat{150, -50}, LonLat{-170, -60}})
    highland += craters_about(p, 300e3, 10).size();
  for (const LonLat& p : {LonLat{-160, 45}, LonLat{120, 55}, LonLat{-20, 60}})
    plain += craters_about(p, 300e3, 10).size();
  EXPECT_GT(highland, 5 * plain);
}

TEST(EmbeddedCraters, LeavePostsOfTheDataFree) {
  for (const LonLat& p : {LonLat{20, -35}, LonLat{150, -50}, LonLat{-40, 75}}) {
    for (const embedded::Crater& c : craters_about(p, 80e3, 9)) {
      const LonLat q = lon_lat(c.centre);
      const double column = (q.lon_deg < 0.0 ? q.lon_deg + 360.0 : q.lon_deg) * 8.0 - 0.5;
      const double row = (90.0 - q.lat_deg) * 8.0 - 0.5;
      const LonLat post{(std::round(column) + 0.5) / 8.0, 90.0 - (std::round(row) + 0.5) / 8.0};
      EXPECT_GT(angle_between_rad(direction(post), c.centre) * kMarsRadius_m, 1.2 * c.radius_m);
    }
  }
}

TEST(EmbeddedCraters, LargerOnesWouldCoverPosts) {
  // Posts are an eighth of a degree apart: half the diagonal between them is 5.24 km on the equator.
  Random random(83);
  double largest_m = 0;
  for (int k = 0; k < 100'000; ++k) {
    const LonLat p = lon_lat(random.direction());
    const double lon_deg = (std::floor(p.lon_deg * 8) + 0.5) / 8;
    const double lat_deg = std::min((std::floor(p.lat_deg * 8) + 0.5) / 8, 90.0 - 0.0625);
    largest_m =
        std::max(largest_m, angle_between_rad(direction({lon_deg, lat_deg}), direction(p)) * kMarsRadius_m);
  }
  EXPECT_LT(largest_m, 5250);
  EXPECT_GT(largest_m, 4800);
}

TEST(EmbeddedCraters, EveryCandidateIsFoundFromEveryPlaceItTouches) {
  Random random(81);
  int checked = 0;
  for (int k = 0; k < 100; ++k) {
    const int level = random.integer(embedded::kSmallestCraterLevel, embedded::kLargestCraterLevel);
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
    fine += whole < kEmbeddedPosts.plain_m;
    EXPECT_EQ(image->spacing_in(cap) < kEmbeddedTexels.plain_m, whole < kEmbeddedPosts.plain_m);
  }
  EXPECT_GT(fine, 300);
  EXPECT_EQ(source->spacing_in({direction({226.2, 18.65}), 0.0}), kEmbeddedPosts.broad_m);
  EXPECT_EQ(source->spacing_in({direction({137.6, -5.3}), 0.0}), kEmbeddedPosts.landmark_m);
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
    // Plateaus are at 3000 m and more; ridges and slides rise from the floor.
    EXPECT_LT(h, -2300.0);
    EXPECT_GT(h, -6500.0);
  }
}

TEST(EmbeddedSources, NameDataAndDetail) {
  for (const auto& infos : {embedded_elevation()->infos(), embedded_image()->infos()}) {
    ASSERT_EQ(infos.size(), 2U);
    EXPECT_EQ(infos[0].name.find("in place of"), std::string::npos);
    EXPECT_FALSE(infos[0].illustration);
    EXPECT_TRUE(infos[0].notes.empty()) << infos[0].notes[0];
    EXPECT_NEAR(infos[0].resolution_m, 7409.0, 1.0);
    EXPECT_EQ(infos[1].name, kEmbeddedDetail);
    EXPECT_TRUE(infos[1].illustration);
    for (const SourceInfo& info : infos) EXPECT_EQ(info.datum, mars::VerticalDatum::areoid());
  }
  for (const auto& infos :
       {embedded_elevation({.detail = false})->infos(), embedded_image({.detail = false})->infos()}) {
    ASSERT_EQ(infos.size(), 1U);
    EXPECT_FALSE(infos[0].illustration);
  }
  const std::vector<glm::dvec3> directions(2, {1, 0, 0});
  std::vector<double> h(2);
  std::vector<int> index(2, -1);
  embedded_elevation()->sample_with_origin(directions, 5000.0, h, index);
  EXPECT_EQ(index, (std::vector<int>{0, 0}));
  embedded_elevation()->sample_with_origin(directions, 500.0, h, index);
  EXPECT_EQ(index, (std::vector<int>{1, 1}));
  embedded_elevation({.detail = false})->sample_with_origin(directions, 500.0, h, index);
  EXPECT_EQ(index, (std::vector<int>{0, 0}));
}

TEST(EmbeddedSources, PostsForTheResamplingErrorAreItsOwnValues) {
  const auto source = embedded_elevation();
  std::size_t posts = 0;
  glm::dvec3 mean{0, 0, 0};
  source->visit_posts(20000, [&](std::span<const glm::dvec3> directions, std::span<const double> values) {
    ASSERT_EQ(directions.size(), values.size());
    posts += directions.size();
    for (std::size_t i = 0; i < directions.size(); i += 97) {
      EXPECT_NEAR(glm::length(directions[i]), 1.0, 1e-15);
      EXPECT_EQ(heights({directions[i]}, 5000.0)[0], values[i]);
    }
    for (const glm::dvec3& d : directions) mean += d;
  });
  EXPECT_NEAR(static_cast<double>(posts), 20000.0, 6000.0);
  EXPECT_LT(glm::length(mean) / static_cast<double>(posts), 0.01);
  source->visit_posts(0, [](auto, auto) { FAIL(); });
}

TEST(EmbeddedImage, HasTheClassicalAlbedoFeatures) {
  const auto brightness = [](LonLat p, double radius_km, bool is_red = false) {
    const auto directions = disc(p, radius_km, radius_km / 10);
    std::vector<vpe::base::Rgb> colours(directions.size());
    std::vector<std::uint8_t> alpha(directions.size(), 0);
    embedded_image()->sample(directions, 5300.0, colours, alpha);
    double sum = 0.0;
    for (std::size_t i = 0; i < colours.size(); ++i) {
      EXPECT_EQ(alpha[i], 255);
      // Dark ground, haze over Hellas and frost are bluish in the mosaic.
      if (is_red) {
        EXPECT_GE(colours[i].r + 8, colours[i].b);
      }
      sum += (colours[i].r + colours[i].g + colours[i].b) / 3.0;
    }
    return sum / static_cast<double>(colours.size());
  };
  const double bright =
      std::min({brightness({20, 22}, 200, true), brightness({70, -42}, 200), brightness({226, 18}, 200, true)});
  // Tyrrhena, at 140 E 25 S, is no darker than Amazonis in the mosaic.
  const double dark = std::max(brightness({68, 9}, 200), brightness({332, 47}, 200));
  EXPECT_GT(bright, dark + 25.0);
  EXPECT_GT(brightness({0, 90}, 100), bright + 40.0);
  EXPECT_GT(brightness({0, -88.5}, 50), bright + 30.0);
}

}  // namespace
}  // namespace mars
