// Reliefs over a source of elevation.
#include "relief/relief_source.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "mars/sources/stack.h"
#include "relief/files/relief_file.h"
#include "relief/spec_line.h"
#include "tests/support/fake_source.h"
#include "tests/support/support.h"

namespace relief {
namespace {

using mars::kMarsRadius_m;
using test_support::FakeElevation;
using test_support::Random;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// Nodata south of the equator; posts of 200 m.
double half_a_planet(const glm::dvec3& d) { return d.z < 0 ? kNan : test_support::bumpy_height(d); }

std::shared_ptr<const mars::ElevationSource> below() {
  return std::make_shared<FakeElevation>(
      half_a_planet, [](const mars::Cap& cap) { return cap.centre.z < -0.5 ? kInfinity : 200.0; });
}

std::shared_ptr<const mars::ElevationSource> changed(
    std::initializer_list<const char*> lines,
    const std::shared_ptr<const mars::ElevationSource>& source = below()) {
  std::vector<ReliefSpec> specs;
  for (const char* line : lines) specs.push_back(parse_relief_line(line));
  const std::size_t count = specs.size();
  return with_relief(source, place(std::move(specs), kMarsRadius_m, ground_of(source)),
                     relief_info("made.relief.toml", count));
}

constexpr const char* kCrater = "kind=crater lon=10 lat=0.5 radius=9000";
constexpr const char* kPad = "kind=pad lon=40 lat=10 radius=5000 falloff=1000";

std::vector<glm::dvec3> some_directions(Random& random) {
  std::vector<glm::dvec3> all;
  for (int n = 0; n < 300; ++n) {
    all.push_back(mars::direction({10 + random.uniform(-1, 1), 0.5 + random.uniform(-1, 1)}));
    all.push_back(mars::direction({40 + random.uniform(-0.1, 0.1), 10 + random.uniform(-0.1, 0.1)}));
    all.push_back(random.direction());
  }
  return all;
}

TEST(ReliefSource, ChangesTheHeightsOfTheSourceBelow) {
  const auto source = changed({kCrater, kPad});
  Random random(1);
  const std::vector<glm::dvec3> directions = some_directions(random);
  std::vector<double> heights_m(directions.size());
  source->sample(directions, 100, heights_m);
  const Relief relief =
      place({parse_relief_line(kCrater), parse_relief_line(kPad)}, kMarsRadius_m, ground_of(below()));
  std::size_t differ = 0;
  for (std::size_t n = 0; n < directions.size(); ++n) {
    const double ground_m = half_a_planet(directions[n]);
    if (std::isnan(ground_m)) {
      EXPECT_TRUE(std::isnan(heights_m[n]));
      continue;
    }
    EXPECT_EQ(heights_m[n], relief.height_m(directions[n], ground_m));
    if (heights_m[n] != ground_m) ++differ;
  }
  EXPECT_GT(differ, 100U);
  EXPECT_LT(differ, 500U);
}

TEST(ReliefSource, TheValueDoesNotDependOnTheBatch) {
  const auto source = changed({kCrater, kPad});
  Random random(2);
  const std::vector<glm::dvec3> directions = some_directions(random);
  std::vector<double> together_m(directions.size());
  std::vector<double> again_m(directions.size());
  std::vector<int> origin(directions.size());
  source->sample(directions, 100, together_m);
  source->sample_with_origin(directions, 100, again_m, origin);
  std::vector<int> apart(directions.size());
  source->origin(directions, apart);
  EXPECT_EQ(origin, apart);
  for (std::size_t n = 0; n < directions.size(); ++n) {
    double one_m = 0;
    source->sample({&directions[n], 1}, 100, {&one_m, 1});
    if (std::isnan(one_m)) {
      EXPECT_TRUE(std::isnan(together_m[n]) && std::isnan(again_m[n]));
      EXPECT_EQ(origin[n], -1);
      continue;
    }
    EXPECT_EQ(one_m, together_m[n]);
    EXPECT_EQ(one_m, again_m[n]);
  }
}

TEST(ReliefSource, TheOriginIsTheReliefWhereItDecides) {
  const auto source = changed({kPad});
  const auto origin_at = [&](double east_m) {
    const glm::dvec3 d = mars::direction(mars::destination({40, 10}, 90, east_m / kMarsRadius_m));
    double height_m = 0;
    int origin = -2;
    source->sample_with_origin({&d, 1}, 100, {&height_m, 1}, {&origin, 1});
    return origin;
  };
  EXPECT_EQ(origin_at(100), 1);
  EXPECT_EQ(origin_at(5400), 1);
  EXPECT_EQ(origin_at(5600), 0);
  EXPECT_EQ(origin_at(7000), 0);
}

TEST(ReliefSource, TheSpacingIsThatOfTheFinest) {
  const auto source = changed({kPad, "kind=pad lon=40 lat=-80 radius=50 level=0"});
  EXPECT_EQ(source->spacing_in({mars::direction({40, 10}), 0}), 200);  // a quarter of the falloff is 250
  EXPECT_EQ(changed({"kind=pad lon=40 lat=10 radius=50 falloff=8"})->spacing_in({mars::direction({40, 10}), 0}),
            2);
  EXPECT_EQ(changed({"kind=pad lon=40 lat=10 radius=50 falloff=8"})->spacing_in({mars::direction({41, 10}), 0}),
            200);
  EXPECT_EQ(source->spacing_in({mars::direction({40, -80}), 0}), kInfinity);
}

TEST(ReliefSource, PostsThatAreChangedAreLeftOut) {
  const auto source = changed({"kind=pad lon=40 lat=10 radius=1000000"});
  std::size_t visited = 0;
  source->visit_posts(5000, [&](std::span<const glm::dvec3> directions, std::span<const double> heights_m) {
    for (std::size_t n = 0; n < directions.size(); ++n) {
      double height_m = 0;
      source->sample({&directions[n], 1}, 0, {&height_m, 1});
      if (std::isnan(height_m)) continue;
      EXPECT_EQ(height_m, heights_m[n]);
      EXPECT_GT(mars::angle_between_rad(directions[n], mars::direction({40, 10})), 0.3);
      ++visited;
    }
  });
  EXPECT_GT(visited, 1000U);
  std::size_t means = 0;
  source->visit_means(5000, [&](std::span<const glm::dvec3> directions, std::span<const double> heights_m) {
    for (std::size_t n = 0; n < directions.size(); ++n) {
      double height_m = 0;
      source->sample({&directions[n], 1}, 0, {&height_m, 1});
      EXPECT_TRUE(height_m == heights_m[n] || (std::isnan(height_m) && std::isnan(heights_m[n])));
      ++means;
    }
  });
  EXPECT_EQ(means, 5000U);
}

TEST(ReliefSource, PostsOfUnwantedCapsNeedNotCome) {
  const auto source = changed({kPad});
  std::size_t visited = 0;
  source->visit_posts_in(
      500, [](const mars::Cap&) { return true; },
      [&](std::span<const glm::dvec3> directions, std::span<const double>) { visited += directions.size(); });
  EXPECT_GT(visited, 400U);
}

TEST(ReliefSource, InfosEndWithTheFile) {
  const test_support::TempDir folder;
  const std::vector<ReliefSpec> specs{parse_relief_line(kPad), parse_relief_line(kCrater)};
  const std::filesystem::path path = folder / "made.relief.toml";
  write_relief_file(specs, path);
  const auto source =
      with_relief(below(), place(specs, kMarsRadius_m, ground_of(below())), relief_info(path, specs.size()));
  const std::vector<mars::SourceInfo> infos = source->infos();
  ASSERT_EQ(infos.size(), 2U);
  EXPECT_EQ(infos[0].name, "fake");
  EXPECT_EQ(infos[1].name, path.string());
  EXPECT_EQ(infos[1].size_bytes, static_cast<std::int64_t>(std::filesystem::file_size(path)));
  EXPECT_GT(infos[1].mtime_s, 1'600'000'000);
  ASSERT_EQ(infos[1].files.size(), 1U);
  EXPECT_EQ(infos[1].files[0], *mars::file_stamp(path.string()));
  EXPECT_TRUE(infos[1].illustration);
  EXPECT_TRUE(infos[1].datum == infos[0].datum);
  EXPECT_EQ(infos[1].resolution_m, 250);
  EXPECT_EQ(infos[1].treatment, "2 formulas change the heights of the sources before it");
}

TEST(ReliefSource, ABoundaryIsThatOfTheSourceBelow) {
  const auto source = changed({kPad});
  const std::vector<glm::dvec3> directions{mars::direction({40, 10}), mars::direction({40, -10})};
  std::vector<double> posts(2);
  mars::boundary_distance_of(*source, directions, 8, posts);
  EXPECT_EQ(posts[0], 8);
  EXPECT_EQ(posts[1], 0);
}

TEST(ReliefSource, TheGroundIsThatOfTheFinestPosts) {
  const GroundHeight ground = ground_of(below());
  EXPECT_EQ(ground(mars::direction({3, 4})), test_support::bumpy_height(mars::direction({3, 4})));
  EXPECT_TRUE(std::isnan(ground(mars::direction({3, -4}))));
  EXPECT_TRUE(std::isnan(ground(mars::direction({3, -84}))));
}

}  // namespace
}  // namespace relief
