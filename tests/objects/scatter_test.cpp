#include "objects/scene/scatter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <numbers>

#include "mars/geodesy/pose.h"
#include "objects/scene/polygon_points.h"
#include "objects/scene/rock_sizes.h"
#include "objects/scene/scatter_chance.h"
#include "tests/support/support.h"

namespace objects {
namespace {

using mars::LonLat;

constexpr double kRadius_m = mars::kMarsRadius_m;
const std::vector<RockModel> kModels(2);

ScatterEntry entry_of(std::vector<LonLat> polygon, double density_per_m2) {
  ScatterEntry entry;
  entry.models = {0};
  entry.polygon = std::move(polygon);
  entry.distribution = PowerLaw{density_per_m2, 2};
  entry.least_diameter_m = 0.5;
  entry.most_diameter_m = 4;
  entry.where = "a.scene.toml:7";
  return entry;
}

// Returns corners around a place, `size_m` to the east and north of it each.
std::vector<LonLat> around(LonLat place, const std::vector<std::pair<double, double>>& size_m) {
  std::vector<LonLat> corners;
  for (const auto& [east_m, north_m] : size_m) {
    corners.push_back(mars::destination(place, std::atan2(east_m, north_m) / mars::kRadiansPerDegree,
                                        std::hypot(east_m, north_m) / kRadius_m));
  }
  return corners;
}

std::string error_of(const ScatterEntry& entry) {
  try {
    scatter(entry, kModels, kRadius_m);
  } catch (const std::runtime_error& e) {
    return e.what();
  }
  return "";
}

// Returns true if the outline winds about the place, by the angles under which edges are seen.
bool is_inside(LonLat place, const std::vector<LonLat>& polygon) {
  const mars::LocalFrame frame = mars::local_frame(place);
  double sum_rad = 0;
  const auto azimuth = [&frame](LonLat corner) {
    const glm::dvec3 d = mars::direction(corner);
    return std::atan2(glm::dot(d, frame.east), glm::dot(d, frame.north));
  };
  for (std::size_t n = 0; n < polygon.size(); ++n) {
    sum_rad +=
        std::remainder(azimuth(polygon[(n + 1) % polygon.size()]) - azimuth(polygon[n]), 2 * std::numbers::pi);
  }
  return std::abs(sum_rad) > std::numbers::pi;
}

double chi_square(const std::map<int, int>& counts, std::size_t cells, std::size_t all) {
  const double expected = static_cast<double>(all) / static_cast<double>(cells);
  double sum = static_cast<double>(cells - counts.size()) * expected;
  for (const auto& [cell, count] : counts) sum += (count - expected) * (count - expected) / expected;
  return sum;
}

// Five standard deviations above the mean of chi square.
double chi_limit(std::size_t cells) {
  const auto freedom = static_cast<double>(cells - 1);
  return freedom + 5 * std::sqrt(2 * freedom);
}

TEST(Scatter, CountIsAreaTimesDensity) {
  struct Case {
    std::vector<LonLat> polygon;
    double area_m2;
  };
  const double sphere_m2 = 4 * std::numbers::pi * kRadius_m * kRadius_m;
  const double cap_edge = std::sqrt(2.0);
  const Case cases[] = {
      {{{0, 0}, {90, 0}, {0, 90}}, sphere_m2 / 8},
      {{{0, 90}, {90, 0}, {0, 0}}, sphere_m2 / 8},  // clockwise
      {{{170, -90}, {170, 0}, {-100, 0}}, sphere_m2 / 8},
      {around({12, 60}, {{0, 0}, {100, 0}, {100, 100}, {0, 100}}), 1e4},
      {around({180, -30}, {{-50, -50}, {50, -50}, {50, 50}, {-50, 50}}), 1e4},
      {around({0, 90}, {{-50, -50}, {50, -50}, {50, 50}, {-50, 50}}), 1e4},
      {around({77, 18}, {{0, 0}, {100, 0}, {100, 30}, {30, 30}, {30, 100}, {0, 100}}), 5100},
      // A cube's face on the sphere.
      {{{45, std::atan(1 / cap_edge) / mars::kRadiansPerDegree},
        {135, std::atan(1 / cap_edge) / mars::kRadiansPerDegree},
        {-135, std::atan(1 / cap_edge) / mars::kRadiansPerDegree},
        {-45, std::atan(1 / cap_edge) / mars::kRadiansPerDegree}},
       sphere_m2 / 6},
  };
  for (const Case& one : cases) {
    const double density = 20000 / one.area_m2;
    const ScatterEntry entry = entry_of(one.polygon, density);
    const double expected = expected_rocks(entry, kRadius_m);
    EXPECT_NEAR(expected, 20000, one.area_m2 < 1e5 ? 0.1 : 1e-5);
    const auto count = static_cast<double>(scatter(entry, kModels, kRadius_m).size());
    EXPECT_LE(std::abs(count - expected), 1);
    EXPECT_LT(std::abs(count - 20000), 5 * std::sqrt(20000.0));
  }
}

TEST(Scatter, RocksAreRoundedUpOrDownByChance) {
  ScatterEntry entry = entry_of(around({0, 0}, {{0, 0}, {100, 0}, {100, 100}, {0, 100}}), 0.3e-4);
  int rocks = 0;
  for (entry.seed = 0; entry.seed < 4000; ++entry.seed)
    rocks += static_cast<int>(scatter(entry, kModels, kRadius_m).size());
  EXPECT_NEAR(rocks, 1200, 5 * std::sqrt(4000 * 0.3 * 0.7));
}

TEST(Scatter, LiesUniformlyByAreaInAnOctant) {
  const std::vector<LonLat> polygon{{0, 0}, {90, 0}, {0, 90}};
  const auto rocks =
      scatter(entry_of(polygon, 100000 / (0.5 * std::numbers::pi * kRadius_m * kRadius_m)), kModels, kRadius_m);
  std::map<int, int> counts;
  for (const Scattered& rock : rocks) {
    const LonLat p = rock.placing.place;
    ASSERT_TRUE(is_inside(p, polygon));
    const int column = std::min(19, static_cast<int>(p.lon_deg / 4.5));
    const int row = std::min(19, static_cast<int>(20 * mars::sin_cos_deg(p.lat_deg).sin));
    ++counts[20 * row + column];
  }
  EXPECT_LT(chi_square(counts, 400, rocks.size()), chi_limit(400));
}

TEST(Scatter, LiesUniformlyInASmallConcavePolygonAcrossTheDateLine) {
  const LonLat place{180, -62};
  const std::vector<LonLat> polygon =
      around(place, {{-50, -50}, {50, -50}, {50, 0}, {0, 0}, {0, 50}, {-50, 50}});
  const auto rocks = scatter(entry_of(polygon, 10), kModels, kRadius_m);
  const mars::LocalFrame frame = mars::local_frame(place);
  std::map<int, int> counts;
  bool is_east = false;
  bool is_west = false;
  for (const Scattered& rock : rocks) {
    ASSERT_TRUE(is_inside(rock.placing.place, polygon));
    (rock.placing.place.lon_deg > 0 ? is_east : is_west) = true;
    const glm::dvec3 d = mars::direction(rock.placing.place) * kRadius_m;
    const auto x = static_cast<int>(std::floor(glm::dot(d, frame.east) / 10));
    const auto y = static_cast<int>(std::floor(glm::dot(d, frame.north) / 10));
    ++counts[100 * y + x];
  }
  EXPECT_TRUE(is_east && is_west);
  ASSERT_EQ(counts.size(), 75U);
  EXPECT_LT(chi_square(counts, 75, rocks.size()), chi_limit(75));
}

TEST(Scatter, LiesUniformlyAroundThePole) {
  std::vector<LonLat> polygon;
  for (int n = 0; n < 12; ++n) polygon.push_back({30.0 * n, -80});
  const ScatterEntry entry = entry_of(polygon, 5e-8);
  const auto rocks = scatter(entry, kModels, kRadius_m);
  EXPECT_GT(rocks.size(), 50000U);
  std::map<int, int> sectors;
  double mean = 0;  // of the area between the pole and the rock, in that of the cap within 80 degrees south
  for (const Scattered& rock : rocks) {
    const LonLat p = rock.placing.place;
    ASSERT_TRUE(is_inside(p, polygon));
    ++sectors[static_cast<int>((p.lon_deg + 180) / 30.0000001)];
    mean += (1 + mars::sin_cos_deg(p.lat_deg).sin) / (1 + mars::sin_cos_deg(-80).sin);
  }
  EXPECT_LT(chi_square(sectors, 12, rocks.size()), chi_limit(12));
  // A regular polygon of n corners in a circle of radius 1 has the mean square distance (2 + cos(2 pi / n)) / 6.
  const double flat = (2 + std::cos(std::numbers::pi / 6)) / 6;
  EXPECT_NEAR(mean / static_cast<double>(rocks.size()), flat, 0.01);
}

TEST(Scatter, EveryRockIsInAStar) {
  test_support::Random random(20261127);
  for (int n = 0; n < 40; ++n) {
    const LonLat place = mars::lon_lat(random.direction());
    const double size_rad = random.log_uniform(1e-6, 1);
    std::vector<LonLat> polygon;
    const int corners = random.integer(3, 40);
    for (int k = 0; k < corners; ++k)
      polygon.push_back(
          mars::destination(place, 360.0 * k / corners, size_rad * (k == 0 ? 1 : random.uniform(0.2, 1))));
    if (corners == 3)
      polygon = {polygon[0], mars::destination(place, 120, size_rad), mars::destination(place, 240, size_rad)};
    ScatterEntry entry = entry_of(polygon, 1);
    entry.distribution = PowerLaw{2000 / expected_rocks(entry, kRadius_m), 1};
    const auto rocks = scatter(entry, kModels, kRadius_m);
    EXPECT_NEAR(static_cast<double>(rocks.size()), 2000, 1);
    int outside = 0;
    for (const Scattered& rock : rocks) outside += is_inside(rock.placing.place, polygon) ? 0 : 1;
    EXPECT_EQ(outside, 0) << "polygon " << n << " of " << corners << " corners, " << size_rad << " rad";
  }
}

// Rocks of at least D on a square metre: the integral of -dF/dD / (pi D^2 / 4), by the exponential integral.
double golombek_rapp_per_m2(double k, double diameter_m) {
  const double q = 1.79 + 0.152 / k;
  return 4 * k * q / std::numbers::pi *
         (std::exp(-q * diameter_m) / diameter_m + q * std::expint(-q * diameter_m));
}

TEST(RockSizes, FollowGolombekAndRapp) {
  for (const double k : {0.001, 0.02, 0.05, 0.2, 1.0}) {
    ScatterEntry entry;
    entry.distribution = RockAbundance{k};
    entry.least_diameter_m = 0.02;
    entry.most_diameter_m = 6;
    const RockSizes sizes(entry);
    const double all = golombek_rapp_per_m2(k, 0.02) - golombek_rapp_per_m2(k, 6);
    EXPECT_NEAR(sizes.rocks_per_m2() / all, 1, 1e-9);
    for (double share = 0; share < 1; share += 0.001) {
      const double diameter_m = sizes.diameter_m(share);
      EXPECT_NEAR(1 - (golombek_rapp_per_m2(k, diameter_m) - golombek_rapp_per_m2(k, 6)) / all, share, 1e-5);
    }
    EXPECT_NEAR(sizes.diameter_m(0), 0.02, 1e-12);
    EXPECT_LE(sizes.diameter_m(1 - 0x1p-53), 6 + 1e-12);
  }
}

TEST(RockSizes, FollowAPowerLaw) {
  for (const double exponent : {0.0, 1e-12, 0.5, 2.0, 3.0, 20.0}) {
    ScatterEntry entry = entry_of({}, 0.7);
    entry.distribution = PowerLaw{0.7, exponent};
    const RockSizes sizes(entry);
    EXPECT_EQ(sizes.rocks_per_m2(), 0.7);
    for (double share = 0; share < 1; share += 0.01) {
      const double d = sizes.diameter_m(share);
      const double is = exponent < 1e-6 ? std::log(d / 0.5) / std::log(8)
                                        : (std::pow(0.5, -exponent) - std::pow(d, -exponent)) /
                                              (std::pow(0.5, -exponent) - std::pow(4, -exponent));
      EXPECT_NEAR(is, share, 1e-9) << exponent;
    }
    EXPECT_NEAR(sizes.diameter_m(1), 4, 1e-6);
    entry.most_diameter_m = entry.least_diameter_m;
    EXPECT_NEAR(RockSizes(entry).diameter_m(0.5), 0.5, 1e-12);
  }
}

TEST(Scatter, SizesFollowTheCurve) {
  for (const double k : {0.05, 0.2}) {
    ScatterEntry entry = entry_of(around({0, 0}, {{0, 0}, {400, 0}, {400, 400}, {0, 400}}), 1);
    entry.distribution = RockAbundance{k};
    entry.least_diameter_m = 0.15;
    const auto rocks = scatter(entry, kModels, kRadius_m);
    const double area_m2 = 160000;
    double covered_m2 = 0;
    for (const Scattered& rock : rocks) covered_m2 += std::numbers::pi / 4 * rock.diameter_m * rock.diameter_m;
    const double q = 1.79 + 0.152 / k;
    EXPECT_NEAR(covered_m2 / area_m2 / (k * (std::exp(-q * 0.15) - std::exp(-q * 4))), 1, 0.05) << k;
    for (const double d : {0.15, 0.2, 0.3, 0.5, 0.7, 1.0}) {
      const auto count = static_cast<double>(
          std::ranges::count_if(rocks, [d](const Scattered& rock) { return rock.diameter_m >= d; }));
      const double expected = (golombek_rapp_per_m2(k, d) - golombek_rapp_per_m2(k, 4)) * area_m2;
      EXPECT_NEAR(count, expected, std::max(0.05 * expected, 5 * std::sqrt(expected))) << k << " " << d;
    }
  }
}

TEST(Scatter, RockNumberNDependsOnSeedAndNAlone) {
  ScatterEntry entry = entry_of(around({5, 5}, {{0, 0}, {100, 0}, {100, 100}, {0, 100}}), 0.1);
  entry.tumbles = true;
  const auto all = scatter(entry, kModels, kRadius_m);
  entry.most = 100;
  const auto few = scatter(entry, kModels, kRadius_m);
  ASSERT_EQ(few.size(), 100U);
  for (std::size_t n = 0; n < few.size(); ++n) {
    EXPECT_EQ(few[n].placing.place.lon_deg, all[n].placing.place.lon_deg);
    EXPECT_EQ(few[n].diameter_m, all[n].diameter_m);
    EXPECT_EQ(few[n].placing.roll_deg, all[n].placing.roll_deg);
  }
  entry.seed = 2;
  EXPECT_NE(scatter(entry, kModels, kRadius_m)[0].diameter_m, all[0].diameter_m);
}

// Returns a hash of all rocks, of angles and lengths to 1e-6.
std::uint64_t hash_of(const ScatterEntry& entry) {
  std::uint64_t hash = 0;
  const auto add = [&hash](double value) {
    hash = scatter_mix((hash ^ static_cast<std::uint64_t>(std::llround(1e6 * value))) + 0x9e3779b97f4a7c15ULL);
  };
  const auto rocks = scatter(entry, kModels, kRadius_m);
  add(static_cast<double>(rocks.size()));
  for (const Scattered& rock : rocks) {
    const Placing& p = rock.placing;
    for (const double value : {static_cast<double>(rock.model), p.place.lon_deg, p.place.lat_deg, p.heading_deg,
                               p.pitch_deg, p.roll_deg, p.height_m, p.scale, rock.diameter_m})
      add(value);
  }
  return hash;
}

TEST(Scatter, IsTheSameOnEveryMachine) {
  ScatterEntry entry = entry_of(around({77.4, 18.4}, {{0, 0}, {70, 10}, {30, 30}, {10, 90}}), 1);
  entry.models = {0, 1};
  entry.distribution = RockAbundance{0.1};
  entry.least_diameter_m = 0.1;
  entry.tumbles = true;
  entry.seed = 42;
  EXPECT_EQ(scatter(entry, kModels, kRadius_m).size(), 3913U);
  EXPECT_EQ(hash_of(entry), 11693992839045943981U);
  // Equal edges and corners of equal height, which rounding could swap.
  entry.polygon = {{0, 60}, {90, 60}, {180, 60}, {-90, 60}};
  entry.distribution = PowerLaw{1e-9, 2};
  EXPECT_EQ(hash_of(entry), 10317618507095034121U);
  entry.polygon = {{0, 0}, {90, 0}, {0, 90}};
  EXPECT_EQ(hash_of(entry), 3353859232962503699U);
}

TEST(Scatter, RocksLieAsDeepAsAskedFor) {
  ScatterEntry entry = entry_of(around({5, 5}, {{0, 0}, {100, 0}, {100, 100}, {0, 100}}), 0.1);
  entry.buried = 0.2;
  entry.follows_slope = true;
  entry.models = {1, 0};
  const std::vector<RockModel> models{{2, {0.1, 0.2, 0.3}}, {0.5, {0, 0, 0}}};
  for (const bool tumbles : {false, true}) {
    entry.tumbles = tumbles;
    int first = 0;
    double up_z = 0;
    const auto rocks = scatter(entry, models, kRadius_m);
    for (const Scattered& rock : rocks) {
      const Placing& p = rock.placing;
      first += rock.model == 0 ? 1 : 0;
      EXPECT_GE(rock.diameter_m, 0.5);
      EXPECT_LE(rock.diameter_m, 4);
      EXPECT_NEAR(p.scale * models[rock.model].diameter_m, rock.diameter_m, 1e-12);
      EXPECT_EQ(p.height_kind, HeightKind::kAboveGround);
      EXPECT_TRUE(p.follows_slope);
      const mars::LocalFrame frame = mars::local_frame(p.place);
      const mars::Axes axes = mars::oriented_axes(frame, p.heading_deg, p.pitch_deg, p.roll_deg);
      const glm::dvec3 c = models[rock.model].centre_m;
      const double centre_m =
          p.height_m + p.scale * glm::dot(frame.up, axes.right * c.x + axes.forward * c.y + axes.up * c.z);
      EXPECT_NEAR(centre_m, 0.3 * rock.diameter_m, 1e-9);
      EXPECT_TRUE(tumbles || (p.pitch_deg == 0 && p.roll_deg == 0));
      up_z += glm::dot(axes.up, frame.up);
    }
    const auto count = static_cast<double>(rocks.size());
    EXPECT_NEAR(first, 0.5 * count, 2.5 * std::sqrt(count));
    EXPECT_NEAR(up_z / count, tumbles ? 0 : 1, 5 / std::sqrt(3 * count));
  }
}

TEST(Scatter, TumblingIsUniform) {
  ScatterEntry entry = entry_of(around({5, 5}, {{0, 0}, {100, 0}, {100, 100}, {0, 100}}), 4);
  entry.tumbles = true;
  std::map<int, int> counts[3];
  const auto rocks = scatter(entry, kModels, kRadius_m);
  const mars::LocalFrame frame{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (const Scattered& rock : rocks) {
    const Placing& p = rock.placing;
    const mars::Axes axes = mars::oriented_axes(frame, p.heading_deg, p.pitch_deg, p.roll_deg);
    int n = 0;
    for (const glm::dvec3& axis : {axes.right, axes.forward, axes.up}) {
      const int row = std::min(9, static_cast<int>(5 * (axis.z + 1)));
      const int column =
          std::min(9, static_cast<int>(10 * (std::atan2(axis.y, axis.x) / (2 * std::numbers::pi) + 0.5)));
      ++counts[n++][10 * row + column];
    }
  }
  for (const auto& axis : counts) EXPECT_LT(chi_square(axis, 100, rocks.size()), chi_limit(100));
}

TEST(Scatter, RefusesWhatHasNoRocksOrTooMany) {
  ScatterEntry entry = entry_of({{0, 0}, {1, 0}, {0, 1}}, 1);
  EXPECT_EQ(error_of(entry),
            "a.scene.toml:7: expected at most 1000000 rocks, found 1757000000; make the polygon smaller or the "
            "rocks larger, or set most");
  entry.most = 50;
  EXPECT_EQ(scatter(entry, kModels, kRadius_m).size(), 50U);
  entry.polygon = {{0, 0}, {120, 0}, {-120, 0}};
  EXPECT_EQ(error_of(entry), "a.scene.toml:7: polygon: expected corners within 75 degrees of their middle");
  entry.polygon = {{0, 0}, {180, 0}, {90, 10}};
  EXPECT_EQ(error_of(entry), "a.scene.toml:7: polygon: expected corners within 75 degrees of their middle");
  for (const std::vector<LonLat>& flat :
       std::vector<std::vector<LonLat>>{{{3, 3}, {3, 3}, {3, 3}}, {{0, 0}, {0, 10}, {0, 0}}}) {
    entry.polygon = flat;
    EXPECT_EQ(error_of(entry), "a.scene.toml:7: polygon: expected corners that enclose an area");
  }
  entry.polygon = {{0, 0}, {1, 1}};
  EXPECT_EQ(error_of(entry), "a.scene.toml:7: polygon: expected 3 corners or more");
}

TEST(PolygonPoints, CornersMayCrowdOnOneSide) {
  std::vector<LonLat> corners;  // 100 near one corner, two 100 degrees away
  for (int n = 0; n < 100; ++n) corners.push_back({-50, 0.01 * n});
  corners.push_back({50, 1});
  corners.push_back({50, 0});
  EXPECT_GT(PolygonPoints(corners).area_sr(), 0.01);
}

TEST(PolygonPoints, ManyCornersAreQuick) {
  std::vector<LonLat> comb;  // 500 teeth
  for (int n = 0; n < 500; ++n) {
    comb.push_back({0.01 * n, 1 + 1e-5 * n});
    comb.push_back({0.01 * n + 0.005, 2e-6 * n});
  }
  comb.push_back({5, -1});
  comb.push_back({0, -1});
  const PolygonPoints points(comb);
  const double sr = mars::kRadiansPerDegree * mars::kRadiansPerDegree * (5 + 2.5);
  EXPECT_NEAR(points.area_sr() / sr, 1, 0.02);
}

TEST(ScatterChance, IsUniformAndWithoutCorrelation) {
  static_assert(scatter_chance(1, 2, 3) == scatter_chance(1, 2, 3));
  std::map<int, int> counts;
  double product = 0;
  constexpr int kCount = 200000;
  for (int n = 0; n < kCount; ++n) {
    const double a = scatter_chance(7, static_cast<std::uint64_t>(n), 0);
    const double b = scatter_chance(7, static_cast<std::uint64_t>(n), 1);
    const double c = scatter_chance(7, static_cast<std::uint64_t>(n) + 1, 0);
    ASSERT_TRUE(a >= 0 && a < 1);
    ++counts[static_cast<int>(a * 10) * 100 + static_cast<int>(b * 10) * 10 + static_cast<int>(c * 10)];
    product += (a - 0.5) * (b - 0.5);
  }
  EXPECT_LT(chi_square(counts, 1000, kCount), chi_limit(1000));
  EXPECT_LT(std::abs(product / kCount), 5 / 12.0 / std::sqrt(kCount));
}

}  // namespace
}  // namespace objects
