// Synthetic detail below other data of Mars.
#include "mars/embedded/detail_below.h"

#include <cmath>
#include <memory>

#include "mars/embedded/embedded.h"
#include "mars/sources/combine.h"
#include "tests/mars/patch.h"
#include "tests/support/fake_source.h"
#include "tests/support/support.h"

namespace mars {
namespace {

// Flat data with a resolution of its own; nodata west of 137 E.
class Flat final : public test_support::FakeElevation {
 public:
  explicit Flat(double resolution_m)
      : FakeElevation([](const glm::dvec3& d) { return lon_lat(d).lon_deg < 137 ? std::nan("") : -4000.0; },
                      [resolution_m](const Cap&) { return resolution_m; }),
        resolution_m_(resolution_m) {}
  std::vector<SourceInfo> infos() const override {
    auto infos = FakeElevation::infos();
    infos[0].name = "flat " + std::to_string(static_cast<int>(resolution_m_));
    infos[0].resolution_m = resolution_m_;
    return infos;
  }

 private:
  double resolution_m_;
};

TEST(EmbeddedBelow, HasSmallMeansOverPostsOfTheData) {
  for (const double data_m : {20.0, 463.0, 1853.0}) {
    for (const LonLat place : {LonLat{137.4, -4.8}, LonLat{-65, -12}, LonLat{-155, 25}}) {
      // 12 x 12 posts of the data, each of 16 x 16 places.
      constexpr int kPosts = 12, kSteps = 16, kSide = kPosts * kSteps;
      const double spacing_m = data_m / kSteps;
      const auto directions = patch(place, kSide, spacing_m);
      std::vector<double> detail_m(directions.size());
      detail_below(directions, spacing_m, data_m, detail_m);
      double square = 0, square_of_means = 0;
      for (int b = 0; b < kPosts; ++b) {
        for (int a = 0; a < kPosts; ++a) {
          double mean = 0;
          for (int y = 0; y < kSteps; ++y) {
            for (int x = 0; x < kSteps; ++x) {
              const double d = detail_m[static_cast<std::size_t>((b * kSteps + y) * kSide + a * kSteps + x)];
              mean += d / (kSteps * kSteps);
              square += d * d / (kSide * kSide);
            }
          }
          square_of_means += mean * mean / (kPosts * kPosts);
        }
      }
      const std::string what = std::to_string(data_m) + " m at " + std::to_string(place.lon_deg);
      RecordProperty(what,
                     std::to_string(std::sqrt(square_of_means)) + " m of " + std::to_string(std::sqrt(square)));
      EXPECT_GT(square, 0.0) << what;
      EXPECT_LE(std::sqrt(square_of_means), 0.05 * data_m) << what << ", " << std::sqrt(square) << " m";
    }
  }
}

TEST(EmbeddedBelow, IsWhatTheEmbeddedMarsHasBelowItsOwnData) {
  const auto directions = patch({137.4, -4.8}, 24, 30.0);
  std::vector<double> detail_m(directions.size()), with(directions.size()), without(directions.size());
  detail_below(directions, 30.0, 7409.0, detail_m);
  embedded_elevation({.finest_m = 30})->sample(directions, 30.0, with);
  embedded_elevation({.detail = false})->sample(directions, 30.0, without);
  for (std::size_t n = 0; n < with.size(); ++n) EXPECT_NEAR(detail_m[n], with[n] - without[n], 1e-9);
}

TEST(EmbeddedBelow, NothingAtThePostsOfTheDataAndWhereThereAreNone) {
  const auto data = std::make_shared<Flat>(463.0);
  const auto detailed = with_detail(data, 10.0);
  ASSERT_EQ(detailed->infos().size(), 2U);
  EXPECT_EQ(detailed->infos()[1].name, "embedded-detail below flat 463");
  EXPECT_TRUE(detailed->infos()[1].illustration);
  const auto directions = patch({137.0, -4.8}, 32, 20.0);
  std::vector<double> own(directions.size()), fine(directions.size());
  std::vector<int> origin(directions.size());
  data->sample(directions, 20.0, own);
  // Posts that are no finer than the data show the data.
  detailed->sample_with_origin(directions, 463.0, fine, origin);
  for (std::size_t n = 0; n < own.size(); ++n) {
    if (std::isnan(own[n])) {
      EXPECT_TRUE(std::isnan(fine[n]));
      EXPECT_EQ(origin[n], -1);
    } else {
      EXPECT_EQ(fine[n], own[n]);
      EXPECT_EQ(origin[n], 0);
    }
  }
  detailed->sample_with_origin(directions, 20.0, fine, origin);
  std::vector<double> again(directions.size());
  detailed->sample(directions, 20.0, again);
  int changed = 0;
  for (std::size_t n = 0; n < own.size(); ++n) {
    ASSERT_EQ(std::isnan(own[n]), std::isnan(fine[n]));
    if (std::isnan(own[n])) {
      EXPECT_EQ(origin[n], -1);
      continue;
    }
    EXPECT_EQ(origin[n], 1);
    EXPECT_EQ(fine[n], again[n]);
    changed += fine[n] != own[n] ? 1 : 0;
  }
  EXPECT_GT(changed, 400);
  EXPECT_EQ(detailed->spacing_in({direction({138, -4.8}), 0.001}), 10.0);
}

// An inset decides by the resolution of its data, whatever spacing its detail has, and fades into the coarser one.
TEST(EmbeddedBelow, InsetsFadeIntoTheDetailOfTheirBase) {
  CombineOptions options;
  options.finish = [](auto source) { return with_detail(std::move(source), 5.0); };
  const auto base = std::make_shared<test_support::FakeElevation>([](const glm::dvec3&) { return -4000.0; });
  const Combined combined = combine_elevation({base, std::make_shared<Flat>(100.0)}, options);
  const auto infos = combined.source->infos();
  ASSERT_EQ(infos.size(), 4U);
  const auto directions = patch({137.05, -4.8}, 8, 5.0);
  std::vector<double> heights(directions.size());
  std::vector<int> origin(directions.size());
  combined.source->sample_with_origin(directions, 5.0, heights, origin);
  for (const int o : origin)
    EXPECT_EQ(infos[static_cast<std::size_t>(o)].name, "embedded-detail below flat 100");
}

// Constant heights above the areoid.
class Constant final : public test_support::FakeElevation {
 public:
  Constant() : FakeElevation([](const glm::dvec3&) { return -123.0; }) {}
  std::vector<SourceInfo> infos() const override {
    auto infos = FakeElevation::infos();
    infos[0].datum = VerticalDatum::areoid();
    return infos;
  }
};

// What is measured is not hidden by what is made up, however fine.
TEST(EmbeddedBelow, DataDecideOverTheFinerDetailOfCoarserData) {
  CombineOptions options;
  options.check_outliers = false;
  const Combined combined =
      combine_elevation({embedded_elevation({.finest_m = 5}), std::make_shared<Constant>()}, options);
  const auto directions = patch({137.4, -4.8}, 8, 5.0);
  std::vector<double> heights(directions.size());
  combined.source->sample(directions, 5.0, heights);
  for (const double h : heights) EXPECT_EQ(h, -123.0);
}

}  // namespace
}  // namespace mars
