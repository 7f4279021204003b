// The embedded Mars as a function: equal bits for every batch and thread, finite, continuous, the same planet
// at every spacing.
#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <thread>
#include <vector>

#include "mars/embedded/embedded.h"
#include "mars/embedded/math.h"
#include "mars/embedded/noise.h"
#include "mars/embedded/surface.h"
#include "mars/geodesy/cube.h"
#include "tests/mars/patch.h"
#include "tests/support/support.h"

namespace mars {
namespace {

using test_support::Random;

std::vector<double> heights(const std::vector<glm::dvec3>& directions, double spacing_m) {
  std::vector<double> out(directions.size(), std::numeric_limits<double>::quiet_NaN());
  embedded_elevation()->sample(directions, spacing_m, out);
  return out;
}

std::vector<double> heights(const std::vector<glm::dvec3>& directions, double spacing_m, embedded::Simd simd) {
  std::vector<double> out(directions.size());
  embedded::evaluate_all(
      embedded::MeasuredMars::get(), directions, spacing_m, simd, embedded::Wanted::kHeights,
      [&out](const embedded::Block&, std::span<const std::uint32_t> index, const embedded::Surface& s) {
        for (std::size_t i = 0; i < index.size(); ++i) out[index[i]] = s.height_m[i];
      });
  return out;
}

// Places of every kind: walls, floors, scarps, calderas, caps, plains, highlands, channels; rocks, ripples, a
// delta, a polar canyon, chaos, islands, dunes, polygons.
const LonLat kPlaces[] = {
    {-74, -10.5}, {-63, -12.2}, {-74, -6.3},   {-42, -9}, {-133.8, 18.65}, {-138.5, 18.6},     {-101, -7},
    {30, -30},    {150, 45},    {0, 90},       {0, -90},  {62, -33},       {-71, 20.5},        {137.8, -5.2},
    {-120, -8.3}, {147.2, 25},  {179.99, -20}, {88, 13},  {-33.25, 19.1},  {-66.2333, -12.56}, {77.2, 18.58},
    {-48, 83},    {-35.5, 1},   {-62, 25.5},   {178, 81}, {134.3, 47.7}};

TEST(EmbeddedValue, EqualBitsForEveryBatch) {
  Random random(71);
  for (const double spacing_m : {2600.0, 160.0, 40.0, 2.0, 0.125}) {
    for (const LonLat& p : kPlaces) {
      const auto directions = patch(p, 24, spacing_m);
      const auto whole = heights(directions, spacing_m);
      // Alone.
      for (int k = 0; k < 6; ++k) {
        const auto i = static_cast<std::size_t>(random.integer(0, static_cast<int>(directions.size()) - 1));
        EXPECT_EQ(heights({directions[i]}, spacing_m)[0], whole[i]) << p.lon_deg << "," << p.lat_deg;
      }
      // Shuffled, among strangers from all over the planet.
      std::vector<std::size_t> order(directions.size());
      std::iota(order.begin(), order.end(), std::size_t{0});
      std::shuffle(order.begin(), order.end(), random.engine());
      order.resize(60);
      std::vector<glm::dvec3> mixed;
      for (const std::size_t i : order) {
        mixed.push_back(directions[i]);
        mixed.push_back(random.direction());
      }
      const auto among = heights(mixed, spacing_m);
      for (std::size_t k = 0; k < order.size(); ++k) EXPECT_EQ(among[2 * k], whole[order[k]]);
    }
  }
}

TEST(EmbeddedValue, EqualBitsInBatchesOfTheWholePlanet) {
  // At spacings without craters a block may span the globe: nothing may leak to the far side.
  Random random(72);
  for (const double spacing_m : {1e6, 100e3, 20e3}) {
    std::vector<glm::dvec3> directions;
    for (const LonLat& p : kPlaces) {
      directions.push_back(direction(p));
      directions.push_back(-direction(p));
    }
    for (int i = 0; i < 500; ++i) directions.push_back(random.direction());
    const auto together = heights(directions, spacing_m);
    for (std::size_t i = 0; i < directions.size(); ++i) {
      EXPECT_EQ(heights({directions[i]}, spacing_m)[0], together[i]) << spacing_m << " " << i;
    }
  }
}

TEST(EmbeddedValue, VectorAndScalarPathsGiveEqualBits) {
  using embedded::Simd;
  if (embedded::best_simd() == Simd::kPlain) GTEST_SKIP() << "skipped: no AVX2 here";
  for (const double spacing_m : {2600.0, 650.0, 160.0, 40.0, 1.0, 0.125}) {
    for (const LonLat& p : kPlaces) {
      const auto directions = patch(p, 20, spacing_m);
      const auto expected = heights(directions, spacing_m, Simd::kPlain);
      for (const Simd simd : {Simd::kAvx2, Simd::kAvx512}) {
        if (!embedded::has_simd(simd)) continue;
        EXPECT_EQ(heights(directions, spacing_m, simd), expected);
      }
    }
  }
}

// Skipping work for whole blocks must not change values: posts of walls, floors and rims, together and alone.
TEST(EmbeddedValue, EqualBitsAloneAndTogetherWhereLandformsEnd) {
  for (const LonLat& p : {LonLat{-72.5, -9.0}, LonLat{-66.0, -11.9}, LonLat{-44.0, -9.5}, LonLat{-133.8, 13.6},
                          LonLat{-138.5, 18.6}, LonLat{-74.4, -6.4}, LonLat{-100.0, -6.0}}) {
    for (const double spacing_m : {650.0, 163.0}) {
      const auto directions = patch(p, 48, 1200.0);
      const auto together = heights(directions, spacing_m);
      for (std::size_t i = 0; i < directions.size(); i += 23) {
        EXPECT_EQ(heights({directions[i]}, spacing_m)[0], together[i]) << p.lon_deg << " " << i;
      }
    }
  }
}

TEST(EmbeddedValue, EqualBitsFromEveryThread) {
  const auto directions = patch({-70, -11}, 60, 160.0);
  const auto expected = heights(directions, 160.0);
  std::vector<std::vector<double>> found(4);
  {
    std::vector<std::jthread> threads;
    for (auto& f : found) threads.emplace_back([&f, &directions] { f = heights(directions, 160.0); });
  }
  for (const auto& f : found) EXPECT_EQ(f, expected);
}

// The hash is the same for every compiler and machine. If it changes, the planet has changed, and planet files
// of older builds do not fit the new one.
TEST(EmbeddedValue, GoldenHash) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  std::uint64_t state = 1;
  for (const double spacing_m : {3700.0, 250.0, 60.0, 1.0, 0.25}) {
    std::vector<glm::dvec3> directions;
    for (const LonLat& p : kPlaces) {
      // Rounded to 2^-30, so that libm's last bits play no part.
      const glm::dvec3 middle = embedded::place(p.lon_deg, p.lat_deg);
      for (int i = 0; i < 140; ++i) {
        state = embedded::mix_bits(state + 0x9e3779b97f4a7c15ULL);
        const glm::dvec3 v =
            middle + 40.0 * spacing_m / kMarsRadius_m *
                         glm::dvec3(embedded::fraction16(state, 0) - 0.5, embedded::fraction16(state, 16) - 0.5,
                                    embedded::fraction16(state, 32) - 0.5);
        const double length = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
        directions.emplace_back(v.x / length, v.y / length, v.z / length);
      }
    }
    for (const double h : heights(directions, spacing_m)) {
      hash = (hash ^ std::bit_cast<std::uint64_t>(h)) * 0x100000001b3ULL;
    }
  }
  RecordProperty("hash", std::to_string(hash));
  EXPECT_EQ(hash, 0x53ca324bccc67622ULL) << std::hex << hash;
}

TEST(EmbeddedValue, FiniteEverywhereAtEverySpacing) {
  Random random(73);
  std::vector<glm::dvec3> directions{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-1.0, 1.0}) {
      for (const double z : {-1.0, 1.0}) directions.push_back(glm::normalize(glm::dvec3(x, y, z)));
    }
  }
  for (int i = 0; i < 300; ++i) directions.push_back(random.direction());
  for (const double spacing_m : {0.01, 1.0, 3.0, 10.0, 100.0, 1e3, 1e4, 1e5, 1e6, 1e9}) {
    for (const double h : heights(directions, spacing_m)) {
      ASSERT_TRUE(std::isfinite(h)) << spacing_m;
      ASSERT_GT(h, -9000.0);
      ASSERT_LT(h, 22000.0);
    }
  }
  EXPECT_TRUE(heights({}, 100.0).empty());
}

TEST(EmbeddedValue, ContinuousEverywhere) {
  // Neighbours 1 mm apart, on steep ground too.
  Random random(74);
  std::vector<glm::dvec3> a;
  std::vector<glm::dvec3> b;
  const auto add = [&](const glm::dvec3& d) {
    a.push_back(d);
    b.push_back(glm::normalize(d + random.direction() * (1e-3 / kMarsRadius_m)));
  };
  for (const LonLat& p : kPlaces) {
    for (int i = 0; i < 700; ++i) {
      const glm::dvec3 away = random.direction();
      add(glm::normalize(direction(p) + away * random.log_uniform(1e-7, 0.06)));
    }
  }
  for (int i = 0; i < 200; ++i) {
    add(direction({180.0, random.uniform(-90, 90)}));
    add(direction({random.uniform(-180, 180), random.integer(0, 1) == 0 ? 90.0 : -90.0}));
    add(glm::normalize(glm::dvec3{1.0, random.integer(0, 1) == 0 ? 1.0 : -1.0, random.uniform(-1, 1)}));
    add(glm::normalize(glm::dvec3(1.0, random.uniform(-1, 1), 1.0)));
  }
  const auto ha = heights(a, 32.0);
  const auto hb = heights(b, 32.0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    const LonLat p = lon_lat(a[i]);
    EXPECT_NEAR(ha[i], hb[i], kEmbeddedStep_m) << p.lon_deg << "," << p.lat_deg;
  }
}

TEST(EmbeddedValue, SpacingOnlyRemovesDetail) {
  EXPECT_EQ(embedded::detail_spacing_m(250.0), 128.0);
  EXPECT_EQ(embedded::detail_spacing_m(128.0), 128.0);
  EXPECT_EQ(embedded::detail_spacing_m(127.9), 64.0);
  EXPECT_EQ(embedded::detail_spacing_m(0.1), 0.0625);
  for (const LonLat& p : kPlaces) {
    const auto directions = patch(p, 40, 900.0);
    EXPECT_EQ(heights(directions, 130.0), heights(directions, 255.0));
    for (const double fine_m : {0.25, 16.0, 128.0, 1024.0}) {
      const auto fine = heights(directions, fine_m);
      const auto coarse = heights(directions, 2.0 * fine_m);
      double mean = 0.0;
      double square = 0.0;
      for (std::size_t i = 0; i < fine.size(); ++i) {
        mean += (fine[i] - coarse[i]) / static_cast<double>(fine.size());
        square += (fine[i] - coarse[i]) * (fine[i] - coarse[i]) / static_cast<double>(fine.size());
      }
      // What lies between two spacings is smaller than they are, and does not lift the ground.
      EXPECT_LT(std::sqrt(square), 0.25 * fine_m + 4.0) << p.lon_deg << "," << p.lat_deg << " " << fine_m;
      EXPECT_LT(std::abs(mean), 0.05 * fine_m + 1.0) << p.lon_deg << "," << p.lat_deg << " " << fine_m;
    }
  }
}

TEST(EmbeddedValue, GroundHasDetailAtEverySpacingAndIsNoCliff) {
  // Floor of Coprates, highlands, plains, lava: slopes between neighbouring posts, away from walls.
  for (const LonLat& p : {LonLat{-66.5, -12.3}, LonLat{30, -30}, LonLat{-160, 30}, LonLat{-114, 20}}) {
    for (const double spacing_m : {0.25, 1.0, 4.0, 16.0, 64.0}) {
      const auto h = heights(patch(p, 96, spacing_m), spacing_m);
      std::vector<double> slopes;
      double rough_m = 0.0;
      for (std::size_t i = 1; i + 1 < h.size(); ++i) {
        if (i % 96 == 0 || i % 96 == 95) continue;
        slopes.push_back(std::abs(h[i + 1] - h[i]) / spacing_m);
        rough_m += std::abs(h[i - 1] - 2.0 * h[i] + h[i + 1]);
      }
      std::sort(slopes.begin(), slopes.end());
      EXPECT_GT(rough_m / static_cast<double>(slopes.size()), 0.003 * spacing_m)
          << p.lon_deg << " " << spacing_m;
      EXPECT_LT(slopes[slopes.size() / 2], 0.2) << p.lon_deg << " " << spacing_m;
      EXPECT_LT(slopes[slopes.size() * 99 / 100], 1.0) << p.lon_deg << " " << spacing_m;
      EXPECT_LT(slopes.back(), 3.0) << p.lon_deg << " " << spacing_m;
    }
  }
}

TEST(EmbeddedNoise, MeanDeviationAndBound) {
  Random random(75);
  double sum = 0.0;
  double square = 0.0;
  double largest = 0.0;
  int n = 0;
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    embedded::Block block;
    block.count = embedded::kBlock;
    for (std::size_t i = 0; i < block.count; ++i) {
      const glm::dvec3 d = random.direction();
      block.x[i] = d.x;
      block.y[i] = d.y;
      block.z[i] = d.z;
    }
    block.finish();
    embedded::Lane<float> out;
    embedded::noise(block, random.log_uniform(2.0, 600e3), seed * 7, out);
    for (const float v : out) {
      sum += static_cast<double>(v);
      square += static_cast<double>(v) * static_cast<double>(v);
      largest = std::max(largest, std::abs(static_cast<double>(v)));
      ++n;
    }
  }
  EXPECT_NEAR(sum / n, 0.0, 0.03);
  EXPECT_NEAR(std::sqrt(square / n), 1.0, 0.03);
  EXPECT_LT(largest, 8.0);
  EXPECT_GT(largest, 2.0);
}

TEST(EmbeddedMath, SineAndCosineAgreeWithTheLibrary) {
  Random random(76);
  for (int i = 0; i < 20000; ++i) {
    const double angle = random.uniform(-720, 720);
    const SinCos s = embedded::exact_sin_cos_deg(angle);
    const SinCos expected = sin_cos_deg(angle);
    EXPECT_NEAR(s.sin, expected.sin, 2e-15);
    EXPECT_NEAR(s.cos, expected.cos, 2e-15);
  }
}

}  // namespace
}  // namespace mars
