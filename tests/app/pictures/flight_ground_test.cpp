// The planets of a flight whose ground changes: what they show, in both backends, and how they change from frame to frame.
#include "vpe/app/planet/flight_ground.h"

#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "paging/planet/planet_user.h"
#include "relief/files/relief_file.h"
#include "relief/relief.h"
#include "tests/gl/certified.h"
#include "tests/paging/patch_between.h"
#include "vpe/core/backend.h"
#include "vpe/voxel/ray_renderer.h"

namespace {

namespace core = vpe::core;
using core::Backend;
using scripts::GroundState;
using scripts::GroundTracks;
using test_support::build_changed;
using test_support::kPatched;
using test_support::Random;
using vpe::app::Common;
using vpe::app::FlightGround;
using Planet = std::shared_ptr<const paging::PlanetFile>;

const mars::LonLat kPlace = mars::lon_lat(kPatched);

std::string place_words(double east_deg = 0) {
  return "lon=" + std::to_string(kPlace.lon_deg + east_deg) + " lat=" + std::to_string(kPlace.lat_deg);
}

// A crater that grows, moves and deepens near a corner of the cube, and a pad on its way.
std::string growing() {
  return "at 1 relief pit kind=crater " + place_words() +
         " radius=30000 depth=3000 rim=600 floor_ratio=0.1 peak=0\n" + "at 1 relief pad kind=pad " +
         place_words(1.5) + " radius=20000 falloff=15000 rise=500\n" +
         "at 5 relief pit radius=60000 depth=8000 rim=1600 lon=" + std::to_string(kPlace.lon_deg + 0.5) +
         "\nat 5 end\n";
}

scripts::Flight flight_of(const std::string& lines) {
  const auto parsed = scripts::parse_flight("flight 1.3\nat 0 pose lon=0 lat=0 alt=1\n" + lines, "F");
  if (!parsed.flight) throw std::logic_error(scripts::to_string(parsed.errors.at(0)));
  return *parsed.flight;
}

Common two_threads() {
  Common common;
  common.threads = 2;
  return common;
}

class FlightGroundTest : public test_support::GlTest {
 protected:
  FlightGround ground_of(const Planet& planet, const std::string& lines) const {
    return {planet, GroundTracks(flight_of(lines), planet->radius_m()), "F.flight", two_threads()};
  }
  std::string message_of(const Planet& planet, const std::string& lines) const {
    try {
      const FlightGround ground = ground_of(planet, lines);
    } catch (const std::runtime_error& e) {
      return e.what();
    }
    return "";
  }
  Planet base() { return build_changed(dir_ / "base.vpe", {}); }
};

double height_at(const Planet& planet, const glm::dvec3& direction) {
  return paging::Surface(planet, std::size_t{8} << 20).at(direction).height_m;
}

TEST_F(FlightGroundTest, PlanetsHaveTheGroundOfTheTime) {
  const Planet planet = base();
  FlightGround ground = ground_of(planet, growing());
  EXPECT_EQ(ground.planet(ground.tracks().at(0.5)), planet);
  const GroundState state = ground.tracks().at(3);
  const Planet changed = ground.planet(state);
  EXPECT_NE(changed, planet);
  EXPECT_EQ(ground.planet(state), changed) << "what stands still is kept";
  // Tiles of 17 x 17 posts are more than a patch may have.
  EXPECT_TRUE(ground.is_coarser());
  FlightGround wide =
      ground_of(planet, "at 0 relief pit kind=crater " + place_words() + " radius=30000 spacing=20000\n");
  EXPECT_FALSE(wide.is_coarser());
  const paging::Surface before(planet, std::size_t{16} << 20);
  const paging::Surface after(changed, std::size_t{16} << 20);
  const relief::Relief placed =
      relief::place(state.reliefs, planet->radius_m(),
                    [&](const glm::dvec3& direction) { return before.at(direction).height_m; });
  Random random(8);
  double largest_m = 0;
  for (int n = 0; n < 400; ++n) {
    const glm::dvec3 direction = glm::normalize(kPatched + 0.03 * random.direction());
    const double was_m = before.at(direction).height_m;
    const double wanted_m = placed.height_m(direction, was_m);
    // Between its posts the ground is flat.
    EXPECT_NEAR(after.at(direction).height_m, wanted_m, 250) << n;
    EXPECT_NEAR(ground.height_m(mars::lon_lat(direction), 1, 3), wanted_m, 1) << n;
    EXPECT_NEAR(ground.height_m(mars::lon_lat(direction), 2, 3) - before.at(direction, 2).height_m,
                2 * (wanted_m - was_m), 1)
        << n;
    largest_m = std::max(largest_m, std::abs(wanted_m - was_m));
  }
  EXPECT_GT(largest_m, 2000);
  const glm::dvec3 far_away = -kPatched;
  EXPECT_EQ(after.at(far_away).height_m, before.at(far_away).height_m);
}

TEST_F(FlightGroundTest, APlanetDoesNotDependOnTheOnesBefore) {
  const Planet planet = base();
  FlightGround forwards = ground_of(planet, growing());
  FlightGround backwards = ground_of(planet, growing());
  std::vector<std::string> identities;
  for (const double time_s : {1.0, 2.0, 3.5, 5.0})
    identities.push_back(forwards.planet(forwards.tracks().at(time_s))->meta().identity);
  std::size_t n = identities.size();
  for (const double time_s : {5.0, 3.5, 2.0, 1.0})
    EXPECT_EQ(backwards.planet(backwards.tracks().at(time_s))->meta().identity, identities[--n]);
  EXPECT_EQ(std::set<std::string>(identities.begin(), identities.end()).size(), identities.size());
}

// The ground of neighbouring frames differs by no more than formulas do there, and the rounding of heights and flat facets
// between posts allow; levels of detail stay.
TEST_F(FlightGroundTest, GroundDoesNotJumpFromFrameToFrame) {
  const Planet planet = base();
  FlightGround ground = ground_of(planet, growing());
  constexpr double kStep_s = 1.0 / 25;
  Random random(9);
  std::vector<glm::dvec3> places;
  for (int n = 0; n < 300; ++n) places.push_back(glm::normalize(kPatched + 0.05 * random.direction()));
  const auto ground_m = [&](const glm::dvec3& direction) { return height_at(planet, direction); };
  Planet was = ground.planet(ground.tracks().at(2));
  relief::Relief was_placed = relief::place(ground.tracks().at(2).reliefs, planet->radius_m(), ground_m);
  const double quantum_m = planet->meta().quantum_m;
  double largest_m = 0;
  for (int k = 1; k <= 8; ++k) {
    const GroundState state = ground.tracks().at(2 + k * kStep_s);
    const Planet is = ground.planet(state);
    relief::Relief placed = relief::place(state.reliefs, planet->radius_m(), ground_m);
    const paging::Surface before(was, std::size_t{16} << 20);
    const paging::Surface after(is, std::size_t{16} << 20);
    // A facet moves by what its corners move by, which are at most so far away.
    for (const glm::dvec3& place : places) {
      double formula_m = 0;
      for (int n = 0; n < 60; ++n) {
        const glm::dvec3 near = glm::normalize(place + 0.004 * random.direction());
        formula_m = std::max(formula_m, std::abs(placed.height_m(near, 0) - was_placed.height_m(near, 0)));
      }
      const double moved_m = std::abs(after.at(place).height_m - before.at(place).height_m);
      EXPECT_LE(moved_m, 1.5 * formula_m + 2 * quantum_m) << k;
      largest_m = std::max(largest_m, moved_m);
    }
    const lod::TileKey key = lod::tile_at(mars::chart_point(kPatched), lod::kMaxLevel);
    EXPECT_EQ(is->tree().deepest(key).key.level, was->tree().deepest(key).key.level);
    was = is;
    was_placed = std::move(placed);
  }
  EXPECT_GT(largest_m, 20);
}

class ChangedViews : public FlightGroundTest, public ::testing::WithParamInterface<Backend> {
 protected:
  std::unique_ptr<core::Renderer> make(const Planet& planet) {
    if (GetParam() == Backend::kPolygon) return renderer(planet);
    return vpe::voxel::make_ray_renderer(planet, {std::size_t{256} << 20, 2});
  }

  // Draws views of ground at any times of a flight that changes it, and compares them with the reference surface.
  void expect_certified_views(int views);
};

void ChangedViews::expect_certified_views(int views) {
  const Planet planet = base();
  FlightGround ground = ground_of(planet, growing());
  const std::unique_ptr<core::Renderer> draw = make(planet);
  Random random(10);
  for (int n = 0; n < views; ++n) {
    const double time_s = random.uniform(0.5, 5);
    const Planet now = ground.planet(ground.tracks().at(time_s));
    paging::change_planet(*draw, now);
    const paging::Surface surface(now, std::size_t{64} << 20);
    const mars::LonLat place = mars::lon_lat(glm::normalize(kPatched + 0.04 * random.direction()));
    const double height_m = random.log_uniform(200, 5e5);
    const mars::Pose pose{
        place.lon_deg,          place.lat_deg,           surface.at(mars::direction(place)).height_m + height_m,
        random.uniform(0, 360), random.uniform(-90, -3), random.uniform(-30, 30)};
    const core::DrawRequest request =
        test_support::request_for(pose, planet->radius_m(), 120, 80, random.uniform(25, 80));
    const std::string name = "view " + std::to_string(n) + " at " + std::to_string(time_s) + " s";
    if (GetParam() == Backend::kPolygon) {
      test_support::expect_certified(*draw, surface, request, name);
      continue;
    }
    SCOPED_TRACE(name);
    const core::DrawResult result = draw->draw(request);
    const core::ImageErrors errors = core::compare_to_reference(
        request.view, result.frame.range_m, test_support::reference_ranges(surface, request.view),
        test_support::radius_of(surface), {4, 2});
    EXPECT_EQ(errors.sky_for_ground, 0);
    EXPECT_EQ(errors.false_surface, 0);
    EXPECT_EQ(errors.invalid, 0);
    EXPECT_LE(errors.forward.max_px, result.certificate.shift_bound_px);
  }
}

TEST_P(ChangedViews, KeepTheirCertificates) { expect_certified_views(24); }

using LongChangedViews = ChangedViews;

TEST_P(LongChangedViews, KeepTheirCertificatesInTwoHundred) { expect_certified_views(200); }

TEST_P(ChangedViews, AreThoseOfANewRenderer) {
  const Planet planet = base();
  FlightGround ground = ground_of(planet, growing());
  const std::unique_ptr<core::Renderer> draw = make(planet);
  const core::DrawRequest request = test_support::request_for(
      {kPlace.lon_deg - 3, kPlace.lat_deg, 60000, 90, -25, 0}, planet->radius_m(), 160, 100);
  const core::DrawResult bare = draw->draw(request);
  for (const double time_s : {2.0, 4.0, 2.0, 0.0}) {
    const Planet now = ground.planet(ground.tracks().at(time_s));
    paging::change_planet(*draw, now);
    const core::DrawResult went_over = draw->draw(request);
    const core::DrawResult fresh = make(now)->draw(request);
    EXPECT_TRUE(went_over.frame.colour == fresh.frame.colour) << time_s;
    EXPECT_TRUE(went_over.frame.range_m == fresh.frame.range_m) << time_s;
    EXPECT_EQ(went_over.frame.range_m == bare.frame.range_m, time_s == 0) << time_s;
  }
}

INSTANTIATE_TEST_SUITE_P(Backends, ChangedViews, testing::Values(Backend::kPolygon, Backend::kRay),
                         [](const auto& made) { return std::string(core::to_string(made.param)); });
INSTANTIATE_TEST_SUITE_P(LongBackends, LongChangedViews, testing::Values(Backend::kPolygon, Backend::kRay),
                         [](const auto& made) { return std::string(core::to_string(made.param)); });

TEST_F(FlightGroundTest, FilesAreMixedIn) {
  const Planet planet = base();
  const Planet raised = build_changed(dir_ / "raised.vpe", {.raised_m = 1500});
  const std::string file = (dir_ / "works.relief.toml").string();
  std::ofstream(file) << "version = 1\n[[relief]]\nkind = \"pad\"\nlon = " << kPlace.lon_deg
                      << "\nlat = " << kPlace.lat_deg
                      << "\nradius_m = 40000\nfalloff_m = 20000\nlevel_m = 5000\n";
  const double base_m = height_at(planet, kPatched);
  const double raised_m = height_at(raised, kPatched);
  ASSERT_NEAR(raised_m - base_m, 1500, 30);
  FlightGround other = ground_of(
      planet, "at 0 patch " + raised->path() + " mix=0\nat 4 patch " + raised->path() + " mix=1\nat 4 end\n");
  for (const double time_s : {0.0, 1.0, 2.0, 4.0}) {
    const Planet now = other.planet(other.tracks().at(time_s));
    // Posts are rounded once more.
    EXPECT_NEAR(height_at(now, kPatched), base_m + time_s / 4 * (raised_m - base_m),
                0.5 * planet->meta().quantum_m + 0.02)
        << time_s << ", step " << planet->meta().quantum_m;
    EXPECT_EQ(height_at(now, -kPatched), height_at(planet, -kPatched));
  }
  // Reliefs stand on the patched ground; those of a file are mixed in like other files.
  FlightGround works =
      ground_of(planet, "at 0 patch " + file + " mix=0.25\nat 0 relief top kind=pad " + place_words() +
                            " radius=20000 falloff=10000 rise=100\nat 4 end\n");
  const Planet now = works.planet(works.tracks().at(0));
  EXPECT_NEAR(height_at(now, kPatched), base_m + 0.25 * (5000 - base_m) + 100, 1);
  EXPECT_TRUE(now->meta().illustration);
}

TEST_F(FlightGroundTest, WhatCannotBeMixedIsNamed) {
  const Planet planet = base();
  const auto expect = [&](const std::string& lines, const std::string& part) {
    const std::string message = message_of(planet, lines);
    EXPECT_TRUE(message.starts_with("F.flight: ")) << message;
    EXPECT_NE(message.find(part), std::string::npos) << message << "\nwanted: " << part;
  };
  expect("at 1 patch absent.vpe mix=1\n", "a patch cannot be used: absent.vpe");
  expect("at 1 patch absent.tif mix=1\n", "absent.tif");
  expect("at 1 patch absent.relief.toml mix=1\n", "absent.relief.toml");
  const std::string bad = (dir_ / "bad.relief.toml").string();
  std::ofstream(bad) << "version = 1\n[[relief]]\nkind = \"pad\"\nlon = 1\nlat = 2\nradius_m = -3\n";
  expect("at 1 patch " + bad + " mix=1\n", "bad.relief.toml:");
  std::ofstream(dir_ / "junk.vpe") << "no planet";
  expect("at 1 patch " + (dir_ / "junk.vpe").string() + " mix=1\n", "junk.vpe");
  const auto moon = test_support::build_fake(
      dir_ / "moon.vpe", test_support::FakeElevation(test_support::bumpy_height), 400000, 2, "Moon");
  expect("at 1 patch " + moon->path() + " mix=1\n", "its body is Moon, and that of the other Mars");
  std::ofstream(dir_ / "a.relief.toml") << "version = 1\n";
  std::filesystem::create_symlink(dir_ / "a.relief.toml", dir_ / "b.relief.toml");
  expect("at 1 patch " + (dir_ / "a.relief.toml").string() + " mix=1\nat 1 patch " +
             (dir_ / "b.relief.toml").string() + " mix=1\n",
         "are one file");
}

TEST_F(FlightGroundTest, StampsTellContents) {
  const Planet planet = base();
  const std::string file = (dir_ / "a.relief.toml").string();
  std::ofstream(file) << "version = 1\n";
  const auto before = vpe::app::ground_file_stamps({file, planet->path()});
  EXPECT_EQ(before.at(planet->path()), "planet " + planet->meta().identity);
  EXPECT_EQ(vpe::app::ground_file_stamps({file, planet->path()}), before);
  std::ofstream(file) << "version = 1\n# changed\n";
  EXPECT_NE(vpe::app::ground_file_stamps({file}).at(file), before.at(file));
  EXPECT_THROW(vpe::app::ground_file_stamps({"absent.relief.toml"}), std::runtime_error);
}

}  // namespace
