#include "paging/surface/section.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "paging/surface/profile.h"
#include "tests/paging/planet_fixture.h"

namespace {

using test_support::build_fake;
using test_support::bumpy_height;
using test_support::FakeElevation;
using test_support::fine_around;
using test_support::Random;
using test_support::TempDir;

const glm::dvec3 kCorner = glm::normalize(glm::dvec3(1, 1, 1));

class Section : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TempDir>();
    const FakeElevation source(bumpy_height, fine_around(kCorner, 0.02, 1000));
    surface_ = std::make_unique<paging::Surface>(build_fake(*folder_ / "p.vpe", source, 100000), 64 << 20);
  }
  static void TearDownTestSuite() {
    surface_.reset();
    folder_.reset();
  }
  static std::vector<paging::SectionPiece> pieces(const glm::dvec3& a, const glm::dvec3& b) {
    std::vector<paging::SectionPiece> all;
    paging::section(*surface_, a, b, [&](const paging::SectionPiece& p) { all.push_back(p); });
    return all;
  }

  static std::unique_ptr<TempDir> folder_;
  static std::unique_ptr<paging::Surface> surface_;
};
std::unique_ptr<TempDir> Section::folder_;
std::unique_ptr<paging::Surface> Section::surface_;

// Every piece lies on the reference surface from end to end, in the plane, and begins where the one before it
// ends: over faces, corners of the cube, tiles of unlike depth, poles, along borders.
TEST_F(Section, PiecesLieOnTheGroundAndInThePlane) {
  Random random(1);
  std::vector<std::pair<glm::dvec3, glm::dvec3>> paths{
      {{1, 0, 0}, {0, 1, 0}},   {{1, 1, 0}, {1, 1, 2}},    {{0.3, 0, 1}, {-0.3, 0, 1}},
      {{1, 0.2, 0.2}, kCorner}, {{-1, 0.9, 1}, {1, 1, 1}}, {{1, 0, 0}, {-0.9, 1e-3, 0.1}},
      {{1, 1, -1}, {1, 1, 1}},  {{1, 0, 0}, {1, 0, 0.5}}};
  for (int n = 0; n < 20; ++n) paths.push_back({random.direction(), random.direction()});
  for (int n = 0; n < 20; ++n) {
    paths.push_back({kCorner + 0.03 * random.direction(), kCorner + 0.03 * random.direction()});
  }
  for (const auto& [from, to] : paths) {
    const auto all = pieces(from, to);
    ASSERT_FALSE(all.empty());
    const double near_m = paging::kSectionError * 4e6;
    EXPECT_LT(mars::angle_between_rad(all.front().begin_m, from), 1e-14);
    EXPECT_LT(mars::angle_between_rad(all.back().end_m, to), 1e-14);
    const glm::dvec3 plane = glm::normalize(glm::cross(glm::normalize(from), glm::normalize(to)));
    const double plane_error =
        1e-9 + 4e6 * 1e-15 / glm::length(glm::cross(glm::normalize(from), glm::normalize(to)));
    for (std::size_t i = 0; i < all.size(); ++i) {
      for (const double t : {0.1, 0.5, 0.9}) {
        const glm::dvec3 p = glm::mix(all[i].begin_m, all[i].end_m, t);
        EXPECT_NEAR(surface_->at(p).radius_m, glm::length(p), 5e-8);
        EXPECT_NEAR(glm::dot(plane, p), 0, plane_error);
      }
      if (i > 0) {
        EXPECT_LT(glm::length(all[i].begin_m - all[i - 1].end_m), near_m);
      }
    }
  }
}

TEST_F(Section, LengthsAddUpAndFineStepsComeCloseFromBelow) {
  const glm::dvec3 a = mars::direction({44, 34});
  const glm::dvec3 b = mars::direction({46, 36.5});
  const paging::SectionFigures whole = paging::section_figures(*surface_, a, b);
  double sum_m = 0;
  double straight_m = 0;
  double lowest_m = 1e9, highest_m = -1e9;
  constexpr int kSteps = 20000;
  for (int i = 0; i < kSteps; ++i) {
    const glm::dvec3 p = mars::slerp(a, b, static_cast<double>(i) / kSteps);
    const glm::dvec3 q = mars::slerp(a, b, static_cast<double>(i + 1) / kSteps);
    const double r = surface_->at(p).radius_m;
    straight_m += glm::length(q * surface_->at(q).radius_m - p * r);
    lowest_m = std::min(lowest_m, r - mars::kMarsRadius_m);
    highest_m = std::max(highest_m, r - mars::kMarsRadius_m);
    if (i % 1000 == 0) {
      sum_m += paging::section_figures(*surface_, p, mars::slerp(a, b, (i + 1000.0) / kSteps)).length_m;
    }
  }
  EXPECT_NEAR(sum_m, whole.length_m, 1e-6);
  EXPECT_LE(straight_m, whole.length_m + 1e-4);
  EXPECT_NEAR(straight_m, whole.length_m, 1e-5 * whole.length_m);
  EXPECT_LE(whole.lowest_m, lowest_m + 1e-7);
  EXPECT_NEAR(whole.lowest_m, lowest_m, 1);
  EXPECT_GE(whole.highest_m, highest_m - 1e-7);
  EXPECT_NEAR(whole.highest_m, highest_m, 1);
}

TEST_F(Section, NoPieceBetweenEqualPlacesAndAnErrorBetweenOppositeOnes) {
  EXPECT_TRUE(pieces({1, 2, 3}, {1, 2, 3}).empty());
  EXPECT_THROW(pieces({1, 2, 3}, {-1, -2, -3}), std::invalid_argument);
}

TEST_F(Section, TheGroundDistanceOfAProfileDoesNotDependOnItsStep) {
  const std::vector<mars::LonLat> places{{44, 34}, {46, 36.5}, {80, 10}};
  const auto fine = paging::profile(*surface_, places, 500);
  const auto coarse = paging::profile(*surface_, places, 400000);
  EXPECT_NEAR(fine.back().ground_distance_m, coarse.back().ground_distance_m, 1e-4);
  EXPECT_GT(fine.size(), 50 * coarse.size());
  // The coarse one has the extremes of what lies between its points.
  double lowest_m = 1e9, highest_m = -1e9;
  for (const auto& p : fine)
    lowest_m = std::min(lowest_m, p.height_m), highest_m = std::max(highest_m, p.height_m);
  double low_m = 1e9, high_m = -1e9;
  for (const auto& p : coarse) low_m = std::min(low_m, p.lowest_m), high_m = std::max(high_m, p.highest_m);
  EXPECT_LE(low_m, lowest_m);
  EXPECT_GE(high_m, highest_m);
  EXPECT_NEAR(low_m, lowest_m, 5);
  EXPECT_NEAR(high_m, highest_m, 5);
}

}  // namespace
