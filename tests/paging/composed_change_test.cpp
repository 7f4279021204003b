// Changes of ground that are made of others, and the change from a planet to another.
#include "paging/live/composed_change.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "paging/live/planet_change.h"
#include "tests/paging/patch_between.h"

namespace {

using paging::changes_in_order;
using paging::GroundChange;
using paging::partial_change;
using test_support::build_changed;
using test_support::kPatched;
using test_support::kPatchedReach_rad;
using test_support::Random;
using test_support::TempDir;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// Turns a height h into factor * h + added on the northern hemisphere.
class Linear final : public GroundChange {
 public:
  Linear(double factor, double added, double spacing_m)
      : factor_(factor), added_(added), spacing_m_(spacing_m) {}

  std::vector<mars::SourceInfo> infos() const override {
    mars::SourceInfo info;
    info.name = vpe_name();
    return {info};
  }
  bool touches(const mars::Cap& cap) const override { return cap.centre.z + cap.radius_rad > 0; }
  double spacing_in(const mars::Cap& cap) const override {
    return touches(cap) ? spacing_m_ : std::numeric_limits<double>::infinity();
  }
  void change(std::span<const glm::dvec3> directions, double /*spacing_m*/, std::span<double> heights_m,
              std::span<int> decided_by) const override {
    for (std::size_t i = 0; i < directions.size(); ++i) {
      decided_by[i] = directions[i].z > 0 ? 0 : -1;
      if (directions[i].z > 0) heights_m[i] = factor_ * heights_m[i] + added_;
    }
  }

 private:
  std::string vpe_name() const { return "linear " + std::to_string(factor_); }
  double factor_;
  double added_;
  double spacing_m_;
};

// Returns the height of a place after a change, and who decided it.
std::pair<double, int> changed(const GroundChange& change, const glm::dvec3& direction, double height_m) {
  int decided = 7;
  change.change({&direction, 1}, 100, {&height_m, 1}, {&decided, 1});
  return {height_m, decided};
}

const glm::dvec3 kNorth{0, 0, 1};
const glm::dvec3 kSouth{0, 0, -1};

TEST(ComposedChange, APartMakesAShareOfTheChange) {
  const auto whole = std::make_shared<const Linear>(3, 10, 50);
  Random random(3);
  for (int n = 0; n < 100; ++n) {
    const double share = random.uniform(0, 1);
    const double height_m = random.uniform(-1e4, 1e4);
    const auto [is_m, decided] = changed(*partial_change(whole, share), kNorth, height_m);
    EXPECT_NEAR(is_m, height_m + share * (2 * height_m + 10), 1e-9);
    EXPECT_EQ(decided, share >= 0.5 ? 0 : -1);
    EXPECT_EQ(changed(*partial_change(whole, 1), kNorth, height_m), changed(*whole, kNorth, height_m));
    EXPECT_EQ(changed(*partial_change(whole, share), kSouth, height_m).first, height_m);
  }
  EXPECT_EQ(changed(*partial_change(whole, 0), kNorth, 5).first, 5);
  EXPECT_FALSE(partial_change(whole, 0)->touches({kNorth, 0.1}));
  EXPECT_TRUE(partial_change(whole, 0.1)->touches({kNorth, 0.1}));
  EXPECT_FALSE(partial_change(whole, 0.1)->touches({kSouth, 0.1}));
  EXPECT_EQ(partial_change(whole, 0.1)->spacing_in({kNorth, 0.1}), 50);
  EXPECT_TRUE(std::isnan(changed(*partial_change(whole, 0.4), kNorth, kNan).first));
}

TEST(ComposedChange, SharesThatAreNoneAreRefused) {
  const auto whole = std::make_shared<const Linear>(3, 10, 50);
  for (const double share : {-0.1, 1.1, kNan})
    EXPECT_THROW(partial_change(whole, share), std::invalid_argument);
  EXPECT_THROW(partial_change(nullptr, 1), std::invalid_argument);
  EXPECT_THROW(changes_in_order({whole, nullptr}), std::invalid_argument);
}

TEST(ComposedChange, ChangesAreMadeInTheirOrder) {
  const auto first = std::make_shared<const Linear>(3, 10, 50);
  const auto second = std::make_shared<const Linear>(1, -7, 20);
  const auto both = changes_in_order({first, second});
  const auto back = changes_in_order({second, first});
  EXPECT_EQ(changed(*both, kNorth, 2), std::pair(9.0, 1));
  EXPECT_EQ(changed(*back, kNorth, 2), std::pair(-5.0, 1));
  EXPECT_EQ(changed(*both, kSouth, 2), std::pair(2.0, -1));
  ASSERT_EQ(both->infos().size(), 2U);
  EXPECT_EQ(both->infos()[0].name, first->infos()[0].name);
  EXPECT_EQ(both->infos()[1].name, second->infos()[0].name);
  EXPECT_EQ(both->spacing_in({kNorth, 0.1}), 20);
  EXPECT_TRUE(both->touches({kNorth, 0.1}));
  EXPECT_FALSE(both->touches({kSouth, 0.1}));
  EXPECT_EQ(changes_in_order({first}), first);
}

TEST(PlanetChangeOfGround, IsTheOtherPlanetWhereItDiffers) {
  const TempDir dir;
  const auto base = build_changed(dir / "base.vpe", {});
  const auto raised = build_changed(dir / "raised.vpe", {.raised_m = 1500, .is_finer = true});
  const auto change = paging::planet_change(*base, raised);
  ASSERT_EQ(change->infos().size(), 1U);
  EXPECT_EQ(change->infos()[0].name, raised->path());
  EXPECT_TRUE(change->touches({kPatched, 0.001}));
  EXPECT_FALSE(change->touches({-kPatched, 0.001}));
  EXPECT_TRUE(std::isinf(change->spacing_in({-kPatched, 0.001})));
  EXPECT_LT(change->spacing_in({kPatched, 0.001}),
            lod::post_spacing_m(
                base->tree().deepest(lod::tile_at(mars::chart_point(kPatched), lod::kMaxLevel)).key.level,
                base->meta().tile.intervals(), base->radius_m()));
  const paging::Surface before(base, std::size_t{16} << 20);
  const paging::Surface after(raised, std::size_t{16} << 20);
  Random random(4);
  double largest_m = 0;
  for (int n = 0; n < 500; ++n) {
    const glm::dvec3 direction =
        n % 2 == 0 ? random.direction() : glm::normalize(kPatched + kPatchedReach_rad * random.direction());
    const double was_m = before.at(direction).height_m;
    const double is_m = after.at(direction).height_m;
    largest_m = std::max(largest_m, std::abs(is_m - was_m));
    // No place that differs is left out.
    if (is_m != was_m) {
      EXPECT_TRUE(change->touches({direction, 0}));
    }
    EXPECT_NEAR(changed(*change, direction, was_m).first, is_m, 1e-6);
  }
  EXPECT_GT(largest_m, 1000);
  const auto none = paging::planet_change(*base, base);
  EXPECT_FALSE(none->touches({kPatched, 4}));
}

TEST(PlanetChangeOfGround, PlanetsOfOtherBodiesAreRefused) {
  const TempDir dir;
  const auto base = build_changed(dir / "base.vpe", {});
  const auto moon = test_support::build_fake(
      dir / "moon.vpe", test_support::FakeElevation(test_support::bumpy_height), 400000, 2, "Moon");
  try {
    (void)paging::planet_change(*base, moon);
    FAIL();
  } catch (const paging::PlanetError& e) {
    const std::string text = e.what();
    EXPECT_NE(text.find("moon.vpe: cannot be mixed with"), std::string::npos) << text;
    EXPECT_NE(text.find("its body is Moon, and that of the other Mars"), std::string::npos) << text;
  }
}

}  // namespace
