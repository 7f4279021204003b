// The three control functions of 1992, both rules, and what control may never do to a selection.
#include "lod/control.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>

#include "lod/options.h"
#include "lod/select.h"
#include "mars/sphere.h"
#include "tests/lod/fake_tree.h"
#include "tests/support/support.h"

// After GoogleTest, which it does not include.
#include <rapidcheck/gtest.h>

namespace {

using lod::ControlFunction;
using lod::Selection;
using lod::SelectOptions;
using lod::TileTree;
using test_support::Random;
namespace core = vpe::core;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

core::View view_at(double lon, double lat, double alt_m, double yaw, double pitch) {
  core::View view;
  view.eye = mars::to_eye(mars::Pose{lon, lat, alt_m, yaw, pitch, 0}, fake::kRadius_m);
  return view;
}

core::View random_view(Random& random) {
  core::View view =
      view_at(random.uniform(-180, 180), random.uniform(-90, 90), 8500 + random.log_uniform(10, 3e6),
              random.uniform(0, 360), random.uniform(-90, 10));
  view.fov_deg = random.uniform(20, 100);
  return view;
}

const TileTree& rough_tree() {
  static const TileTree tree = fake::tree(fake::rough(3, 9));
  return tree;
}

Selection selected(const SelectOptions& options, const TileTree& tree, const core::View& view) {
  lod::SelectScratch scratch;
  Selection selection;
  lod::select(options, tree, lod::select_view(view), scratch, selection);
  return selection;
}

SelectOptions hitchner(const ControlFunction& distance, const ControlFunction& centre = {}) {
  SelectOptions options;
  options.control.rule = core::LodRule::kHitchner;
  options.control.distance = distance;
  options.control.centre = centre;
  return options;
}

// Of a tile that is in a selection or was refined for it.
lod::ControlTerms terms_of(const SelectOptions& options, const TileTree& tree, const core::View& view,
                           const lod::TileKey& key) {
  const auto index = static_cast<TileTree::Index>(tree.find(key) - &tree[0]);
  const cull::Shell shell = tree.shell(index, 1.0, tree[index].variants[0].terms.total_m);
  const cull::Eye eye = cull::make_eye(view.eye.eye_m);
  const double distance = cull::min_distance_m(eye, cull::nearest_chord2(shell.rect, eye.direction),
                                               shell.min_radius_m, shell.max_radius_m);
  return lod::control_terms(options.control, lod::centre_of_view(view),
                            {cull::make_volume(shell), shell.rect, distance}, true);
}

// Disjoint, and every finest tile that the same view sees at tolerance 0 is in one.
void expect_cover(const Selection& s, const core::View& view) {
  std::vector<std::int64_t> begins;
  std::int64_t end = -1;
  for (const lod::SelectedTile& t : s.tiles) {
    ASSERT_GE(lod::z_position(t.key), end);
    begins.push_back(lod::z_position(t.key));
    end = lod::z_position(t.key) + lod::z_extent(t.key.level);
  }
  ASSERT_EQ(s.visited, s.culled_frustum + s.culled_horizon + s.refined + static_cast<int>(s.tiles.size()));
  SelectOptions all;
  all.tolerance_px = 0;
  for (const lod::SelectedTile& leaf : selected(all, rough_tree(), view).tiles) {
    const auto after = std::upper_bound(begins.begin(), begins.end(), lod::z_position(leaf.key));
    ASSERT_NE(after, begins.begin());
    ASSERT_TRUE(lod::contains(s.tiles[static_cast<std::size_t>(after - begins.begin()) - 1].key, leaf.key))
        << lod::to_string(leaf.key);
  }
}

const lod::SelectedTile* holder(const Selection& s, const glm::dvec3& place) {
  const lod::TileKey key = lod::tile_at(mars::chart_point(place), lod::kMaxLevel);
  for (const lod::SelectedTile& t : s.tiles) {
    if (lod::contains(t.key, key)) return &t;
  }
  return nullptr;
}

TEST(ControlFunctions, ByDistanceFromTheEye) {
  // A thousand kilometres over x, and three more.
  const ControlFunction f{1e6, 3, 1, {}};
  EXPECT_EQ(lod::levels(f, 1e5), 13.0);
  EXPECT_EQ(lod::levels(f, 4e5), 5.5);
  EXPECT_EQ(lod::levels(f, 1e7), 3.1);
  EXPECT_EQ(lod::levels(f, 0), kInfinity);
  EXPECT_EQ(lod::wanted_lod(lod::levels(f, 1e5)), 13);
  EXPECT_EQ(lod::wanted_lod(lod::levels(f, 4e5)), 5);  // (int) 5.5
  EXPECT_EQ(lod::wanted_lod(lod::levels(f, 1e7)), 3);
  EXPECT_EQ(lod::wanted_lod(kInfinity), lod::kMaxLevel + 1);
  EXPECT_EQ(lod::wanted_lod(0.9), 1);  // nothing is coarser than the roots
  EXPECT_EQ(lod::wanted_lod(-7), 1);
  // The scale is the knob of reach, the offset moves all.
  EXPECT_EQ(lod::levels({2e6, 3, 1, {}}, 4e5), 8.0);
  EXPECT_EQ(lod::levels({1e6, 4, 1, {}}, 4e5), 6.5);
  EXPECT_EQ(lod::levels({0, 4, 1, {}}, 0), 4.0);
  // What a time budget does to it: twice as far.
  EXPECT_EQ(lod::levels({1e6, 3, 1, {}, 2}, 4e5), 4.25);
}

TEST(ControlFunctions, ByLookupTable) {
  const ControlFunction f{1e6, 3, 1, {{0, 12}, {1e4, 9}, {1e5, 6}, {1e6, 3.5}}};
  EXPECT_EQ(lod::levels(f, 0), 12.0);
  EXPECT_EQ(lod::levels(f, 9999.9), 12.0);
  EXPECT_EQ(lod::levels(f, 1e4), 9.0);
  EXPECT_EQ(lod::levels(f, 5e5), 6.0);
  EXPECT_EQ(lod::levels(f, 1e9), 3.5);
  EXPECT_EQ(lod::levels(f, kInfinity), 3.5);
  EXPECT_EQ(lod::levels({0, 0, 1, {{10, 2}, {20, 1}}}, 5), 2.0);  // the first row holds below its x
  EXPECT_EQ(lod::levels({0, 0, 1, {{10, 2}, {20, 1}}, 3}, 5), 2.0);
  EXPECT_EQ(lod::levels({0, 0, 1, {{10, 2}, {20, 1}}, 4}, 5), 1.0);
}

TEST(ControlFunctions, ByDistanceFromTheCentre) {
  // 90 degrees high: half the picture's height is a tangent of 1.
  core::View view = view_at(0, 0, 1e5, 0, -90);
  view.fov_deg = 90;
  const lod::CentreOfView centre = lod::centre_of_view(view);
  EXPECT_EQ(lod::centre_distance(centre, 0), 0.0);
  EXPECT_NEAR(lod::centre_distance(centre, std::atan(0.5)), 0.5, 1e-15);
  EXPECT_NEAR(lod::centre_distance(centre, mars::kPi / 4), 1.0, 1e-15);  // the upper edge
  EXPECT_EQ(lod::centre_distance(centre, mars::kPi / 2), kInfinity);
  const ControlFunction f{0.25, -1, 1, {}};
  EXPECT_EQ(lod::levels(f, 0.05), 4.0);
  EXPECT_EQ(lod::levels(f, 0.25), 0.0);
  EXPECT_EQ(lod::levels(f, 1), -0.75);
  EXPECT_EQ(lod::levels(f, kInfinity), -1.0);
  // The same in a picture of another size and field of view.
  view.fov_deg = 20;
  view.width = view.height = 99;
  EXPECT_NEAR(lod::centre_distance(lod::centre_of_view(view), 10 * mars::kRadiansPerDegree), 1.0, 1e-15);
  // Parts, and pictures that are shifted for stereo, have the centre of the whole.
  view.part = {3, 4, 5, 6};
  view.principal_offset_px = {7, 8};
  EXPECT_EQ(lod::centre_of_view(view).forward, view.eye.axes.forward);
  view.projection = core::Projection::kEquirectangular;
  view.fov_deg = 180;
  EXPECT_NEAR(lod::centre_distance(lod::centre_of_view(view), mars::kPi / 4), 0.5, 1e-15);
}

TEST(ControlFunctions, ByInterest) {
  // A circle of 1000 km about the middle of +X, whose tiles of level 2 are 22.5 degrees or 1330 km wide.
  const lod::ControlRegion finer = lod::control_region({0, 0, 1e6, 2}, fake::kRadius_m);
  const lod::ControlRegion coarser = lod::control_region({0, 0, 1e6, -1}, fake::kRadius_m);
  const mars::ChartRect touched = lod::chart_rect({mars::Face::kPlusX, 2, 2, 2});
  const mars::ChartRect inside = lod::chart_rect({mars::Face::kPlusX, 4, 8, 8});
  const mars::ChartRect outside = lod::chart_rect({mars::Face::kPlusX, 2, 3, 3});
  const auto levels = [](std::vector<lod::ControlRegion> regions, const mars::ChartRect& rect) {
    return lod::interest_levels(regions, rect);
  };
  EXPECT_EQ(levels({finer}, touched), 2);
  EXPECT_EQ(levels({finer}, inside), 2);
  EXPECT_EQ(levels({finer}, outside), 0);
  EXPECT_EQ(levels({coarser}, touched), 0);  // a part of it is not to be coarser
  EXPECT_EQ(levels({coarser}, inside), -1);
  EXPECT_EQ(levels({finer, coarser, coarser}, inside), 0);  // they add up
  EXPECT_EQ(levels({finer, finer}, touched), 4);
  // A radius beyond the antipode is the whole planet; none is a point.
  EXPECT_EQ(levels({lod::control_region({10, 20, 1e8, -3}, fake::kRadius_m)}, outside), -3);
  EXPECT_EQ(levels({lod::control_region({0, 0, 0, 1}, fake::kRadius_m)}, inside), 1);
  EXPECT_EQ(levels({lod::control_region({0, 0, 0, 1}, fake::kRadius_m)}, outside), 0);
}

TEST(ControlFunctions, TheSumIsWeightedAndCutToAWholeNumberOnce) {
  // Straight down from 400 km at the middle of a flat tile's corner: distance 400 km, centre 0 is avoided by a
  // look aside, so that all three terms are finite.
  const TileTree ball = fake::tree(fake::uniform(5));
  SelectOptions options = hitchner({1e6, 3, 1, {}}, {0.25, -1, 2, {}});
  options.control.interest_weight = 0.5;
  options.control.regions = {lod::control_region({0, 0, 1e6, 3}, fake::kRadius_m)};
  core::View view = view_at(0, 0, 4e5, 0, 0);
  const lod::ControlTerms t = terms_of(options, ball, view, {mars::Face::kPlusX, 5, 16, 16});
  // Distance: the shell's outer rim is at the mesh's error above the ground at the most.
  EXPECT_NEAR(t.distance.x, 4e5, 1);
  EXPECT_NEAR(t.distance.levels, 5.5, 1e-4);
  // Straight ahead is the horizontal: the tile's nearest direction lies below it by some 67 degrees, that is
  // tan(67) / tan(30) = 4 halves of the height off.
  const double share = std::tan(t.centre_angle_rad) / std::tan(30 * mars::kRadiansPerDegree);
  EXPECT_EQ(t.centre.x, share);
  EXPECT_GT(t.centre_angle_rad, 1.1);
  EXPECT_LT(t.centre_angle_rad, 1.3);
  EXPECT_EQ(t.centre.levels, 0.25 / share - 1);
  EXPECT_EQ(t.interest.levels, 3.0);
  EXPECT_EQ(t.sum, t.distance.levels + 2 * t.centre.levels + 0.5 * 3);
  EXPECT_EQ(lod::wanted_lod(t.sum), static_cast<int>(t.sum));
  // The error-bounded rule counts the last two.
  options.control.rule = core::LodRule::kError;
  EXPECT_EQ(terms_of(options, ball, view, {mars::Face::kPlusX, 5, 16, 16}).sum, 2 * t.centre.levels + 1.5);
}

// Against directions to dense samples of the volume: never more than the least of them, and not much less.
TEST(ControlFunctions, TheNearestPointToTheCentreIsFound) {
  Random random(61);
  int inside = 0;
  int aside = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const core::View view = random_view(random);
    const lod::CentreOfView centre = lod::centre_of_view(view);
    const int level = random.integer(0, 9);
    const glm::dvec3 near =
        glm::normalize(view.eye.eye_m / fake::kRadius_m + random.uniform(0, 1) * random.direction());
    const lod::TileKey key = lod::tile_at(mars::chart_point(near), level);
    const cull::Shell shell{lod::chart_rect(key), fake::kRadius_m - random.uniform(0, 5000),
                            fake::kRadius_m + 3000};
    const cull::TileVolume v = cull::make_volume(shell);
    const double angle = lod::least_angle_rad(centre, v);
    double least = kInfinity;
    double steps = 0;
    constexpr int kSteps = 60;
    glm::dvec3 last(0);
    for (int a = 0; a <= kSteps; ++a) {
      for (int b = 0; b <= kSteps; ++b) {
        for (int h = 0; h <= 4; ++h) {
          const double x = a / double{kSteps};
          const double y = b / double{kSteps};
          const auto at = [&](std::size_t k) {
            return (1 - y) * ((1 - x) * v.corners_m[k] + x * v.corners_m[k + 1]) +
                   y * ((1 - x) * v.corners_m[k + 2] + x * v.corners_m[k + 3]);
          };
          const glm::dvec3 d = (1 - h / 4.0) * at(0) + h / 4.0 * at(4) - centre.eye_m;
          least = std::min(least, mars::angle_between_rad(d, centre.forward));
          if (b > 0 && h == 4) steps = std::max(steps, mars::angle_between_rad(d, last));
          if (h == 4) last = d;
        }
      }
    }
    ASSERT_LE(angle, least + 1e-7) << trial;
    if (angle == 0.0) {
      ++inside;
    } else {
      ++aside;
      ASSERT_GE(angle, least - 2 * steps - 1e-7) << trial << " " << lod::to_string(key);
    }
  }
  EXPECT_GT(inside, 10);
  EXPECT_GT(aside, 100);
}

TEST(ControlSelection, ByDefaultNothingChanges) {
  // To the bit: what a request with default settings asks for, and the plain options.
  rc::check([] {
    Random random(*rc::gen::arbitrary<std::uint32_t>());
    const core::View view = random_view(random);
    SelectOptions plain;
    plain.tolerance_px = random.log_uniform(0.2, 20);
    plain.max_triangles = random.integer(0, 1) == 0 ? 1'000'000'000 : random.integer(10'000, 300'000);
    core::DrawRequest request;
    request.settings.lod_tolerance_px = plain.tolerance_px;
    const SelectOptions asked = lod::select_options(request, fake::kRadius_m, plain.max_triangles);
    RC_ASSERT(lod::is_neutral(asked.control));
    const Selection a = selected(plain, rough_tree(), view);
    const Selection b = selected(asked, rough_tree(), view);
    RC_ASSERT(a.tiles.size() == b.tiles.size());
    for (std::size_t n = 0; n < a.tiles.size(); ++n) {
      RC_ASSERT(a.tiles[n].key == b.tiles[n].key);
      RC_ASSERT(a.tiles[n].variant == b.tiles[n].variant);
      RC_ASSERT(a.tiles[n].error_px == b.tiles[n].error_px);
      RC_ASSERT(b.tiles[n].control == 0.0);
    }
  });
}

TEST(ControlSelection, HitchnersRuleHoldsAtEveryTile) {
  Random random(62);
  int finest = 0;
  int reached = 0;
  for (int trial = 0; trial < 600; ++trial) {
    const core::View view = random_view(random);
    SelectOptions options = hitchner({random.log_uniform(1e4, 1e7), random.uniform(-2, 6), 1, {}},
                                     {random.uniform(0, 1), random.uniform(-2, 1), random.uniform(0, 2), {}});
    if (trial % 3 == 0) options.control.distance.table = {{0, 12}, {1e5, 8}, {1e6, 5}, {2e6, 3}};
    options.control.regions = {lod::control_region({0, 0, 1e6, random.integer(-3, 3)}, fake::kRadius_m)};
    const Selection s = selected(options, rough_tree(), view);
    expect_cover(s, view);
    if (HasFatalFailure()) return;
    ASSERT_FALSE(s.capped);
    for (const lod::SelectedTile& t : s.tiles) {
      const lod::TileInfo& info = rough_tree()[t.index];
      const int wanted = lod::wanted_lod(terms_of(options, rough_tree(), view, t.key).sum);
      ASSERT_EQ(t.control, wanted);
      if (lod::is_full_grid(info, t.variant)) {
        ASSERT_GE(wanted, lod::lod_number(t.key));
        ++finest;
      } else {
        ASSERT_EQ(t.variant, 0);
        ASSERT_LE(wanted, lod::lod_number(t.key) - (info.has_children ? 0 : 1));
        ++reached;
      }
      if (t.key.level > 0) {
        const lod::TileKey above = lod::parent(t.key);
        ASSERT_GT(lod::wanted_lod(terms_of(options, rough_tree(), view, above).sum), lod::lod_number(above));
      }
    }
  }
  EXPECT_GT(finest, 100);
  EXPECT_GT(reached, 100);
}

TEST(ControlSelection, FromAFarEyeTheNumbersAreThoseOfTheFormula) {
  // 10 radii up over the middle of +X all tiles are 34 000 to 38 000 km away: 1e8 / x is 2.6 to 2.9, so that
  // LOD 2 + 2 = 4 is wanted everywhere, level 3 in our numbers.
  const TileTree ball = fake::tree(fake::uniform(5));
  const core::View view = view_at(0, 0, 10 * fake::kRadius_m, 0, -90);
  const Selection s = selected(hitchner({1e8, 2, 1, {}}), ball, view);
  ASSERT_FALSE(s.tiles.empty());
  EXPECT_EQ(s.tiles_by_level, (std::vector<int>{0, 0, 0, static_cast<int>(s.tiles.size())}));
  for (const lod::SelectedTile& t : s.tiles) EXPECT_EQ(t.control, 4);
  // Half the weight: int(0.5 * (2.6 .. 2.9 + 2)) = 2.
  EXPECT_EQ(selected(hitchner({1e8, 2, 0.5, {}}), ball, view).tiles_by_level.size(), 2U);
  // One more in a region: there alone.
  SelectOptions options = hitchner({1e8, 2, 1, {}});
  options.control.regions = {lod::control_region({0, 0, 1e5, 1}, fake::kRadius_m)};
  const Selection with = selected(options, ball, view);
  EXPECT_EQ(holder(with, {1, 0, 0})->key.level, 4);
  EXPECT_EQ(holder(with, {1, 0.5, 0})->key.level, 3);
}

TEST(ControlSelection, TheCapIsHardInBothRules) {
  Random random(63);
  int capped = 0;
  for (int trial = 0; trial < 120; ++trial) {
    const core::View view = random_view(random);
    SelectOptions options = hitchner({1e6, 3, 1, {}}, {0.25, -1, random.integer(0, 1) * 1.0, {}});
    if (trial % 2 == 0) options.control.rule = core::LodRule::kError;
    options.control.regions = {lod::control_region({0, 0, 2e6, random.integer(-2, 2)}, fake::kRadius_m)};
    const Selection free = selected(options, rough_tree(), view);
    std::int64_t before = 0;
    for (const std::int64_t cap : {1LL, 10'000LL, 50'000LL, 200'000LL}) {
      options.max_triangles = cap;
      const Selection s = selected(options, rough_tree(), view);
      expect_cover(s, view);
      if (HasFatalFailure()) return;
      std::int64_t triangles = 0;
      for (const auto& t : s.tiles)
        triangles += rough_tree()[t.index].variants[static_cast<std::size_t>(t.variant)].triangles;
      ASSERT_EQ(triangles, s.triangles);
      if (s.triangles > cap) {
        ASSERT_EQ(s.tiles_by_level.size(), 1U);  // roots alone
      }
      ASSERT_GE(s.visited, before);
      before = s.visited;
      if (!s.capped) {
        ASSERT_EQ(s.triangles, free.triangles);
        continue;
      }
      ++capped;
      if (options.control.rule == core::LodRule::kHitchner) {
        // Coarsest first: whatever was refined lacked as many levels as all that is left, or more.
        double most = 0;
        for (const auto& t : s.tiles) {
          const lod::TileInfo& info = rough_tree()[t.index];
          if (lod::is_full_grid(info, t.variant)) continue;
          most = std::max(
              most, t.control - lod::lod_number(t.key, t.variant, static_cast<int>(info.variants.size())));
        }
        for (const auto& t : s.tiles) {
          if (t.key.level == 0) continue;
          const lod::TileKey above = lod::parent(t.key);
          ASSERT_GE(lod::wanted_lod(terms_of(options, rough_tree(), view, above).sum) - lod::lod_number(above),
                    most);
        }
      }
    }
  }
  EXPECT_GT(capped, 100);
}

TEST(ControlSelection, MoreWeightOnTheCentreNeverCoarsensTheCentre) {
  int finer = 0;
  rc::check([&finer] {
    Random random(*rc::gen::arbitrary<std::uint32_t>());
    core::View view = random_view(random);
    view.eye = mars::to_eye(
        mars::Pose{random.uniform(-180, 180), random.uniform(-90, 90), random.log_uniform(1e4, 2e6),
                   random.uniform(0, 360), random.uniform(-90, -50), 0},
        fake::kRadius_m);
    // Where the ray ahead meets the ground, nearly.
    const double b = glm::dot(view.eye.eye_m, view.eye.axes.forward);
    const double root = b * b - glm::dot(view.eye.eye_m, view.eye.eye_m) + fake::kRadius_m * fake::kRadius_m;
    RC_PRE(root > 0);
    const glm::dvec3 place = view.eye.eye_m + (-b - std::sqrt(root)) * view.eye.axes.forward;
    SelectOptions options = hitchner({1e6, 1, 1, {}}, {0.25, -1, 0, {}});
    if (random.integer(0, 1) == 0) options.control.rule = core::LodRule::kError;
    static const TileTree ball = fake::tree(fake::uniform(7));
    int level = 0;
    int variant = 0;
    for (const double weight : {0.0, 0.5, 1.0, 3.0}) {
      options.control.centre.weight = weight;
      const Selection s = selected(options, ball, view);
      const lod::SelectedTile* t = holder(s, place);
      RC_ASSERT(t != nullptr);
      RC_ASSERT(t->key.level > level || (t->key.level == level && t->variant >= variant));
      finer += t->key.level > level ? 1 : 0;
      level = t->key.level;
      variant = t->variant;
    }
  });
  EXPECT_GT(finer, 50);
}

TEST(ControlSelection, MoreInterestNeverCoarsens) {
  int finer = 0;
  rc::check([&finer] {
    Random random(*rc::gen::arbitrary<std::uint32_t>());
    const core::View view = random_view(random);
    SelectOptions options = hitchner({1e6, 2, 1, {}});
    if (random.integer(0, 1) == 0) options.control.rule = core::LodRule::kError;
    const mars::LonLat at = mars::lon_lat(view.eye.eye_m);
    for (int n = random.integer(0, 2); n > 0; --n) {
      options.control.regions.push_back(
          lod::control_region({at.lon_deg + random.uniform(-5, 5), random.uniform(-90, 90),
                               random.log_uniform(1e4, 1e7), random.integer(-3, 3)},
                              fake::kRadius_m));
    }
    const Selection before = selected(options, rough_tree(), view);
    options.control.regions.push_back(lod::control_region(
        {at.lon_deg, at.lat_deg, random.log_uniform(3e5, 5e6), random.integer(1, 2)}, fake::kRadius_m));
    const Selection after = selected(options, rough_tree(), view);
    finer += after.visited > before.visited ? 1 : 0;
    for (const lod::SelectedTile& t : after.tiles) {
      for (const lod::SelectedTile& old : before.tiles) {
        if (!lod::contains(t.key, old.key)) continue;
        RC_ASSERT(t.key == old.key);  // never an ancestor
        RC_ASSERT(t.variant >= old.variant);
      }
    }
  });
  EXPECT_GT(finer, 10);
}

TEST(ControlSelection, TheErrorThatIsReportedIsTheTrueOne) {
  const core::View view = view_at(0, 0, 2e6, 0, -90);
  SelectOptions options;
  options.control.regions = {lod::control_region({0, 0, 1e8, -3}, fake::kRadius_m)};
  const Selection coarse = selected(options, rough_tree(), view);
  EXPECT_GT(coarse.max_error_px, 1.0);
  EXPECT_LE(coarse.max_error_px, 8.0);
  EXPECT_EQ(coarse.max_error_px, [&] {
    SelectOptions eight;
    eight.tolerance_px = 8;
    return selected(eight, rough_tree(), view).max_error_px;
  }());
}

TEST(ControlSelection, RefusesWhatIsNoNumber) {
  const TileTree ball = fake::tree(fake::uniform(1));
  const core::View view = view_at(0, 0, 1e6, 0, -90);
  const auto refuses = [&](const auto& spoil) {
    SelectOptions options;
    spoil(options.control);
    EXPECT_THROW(selected(options, ball, view), std::invalid_argument);
  };
  refuses([](auto& c) { c.distance.scale = -1; });
  refuses([](auto& c) { c.distance.offset = kInfinity; });
  refuses([](auto& c) { c.centre.weight = -1; });
  refuses([](auto& c) { c.centre.weight = std::nan(""); });
  refuses([](auto& c) { c.centre.x_factor = 0; });
  refuses([](auto& c) { c.interest_weight = std::nan(""); });
}

}  // namespace
