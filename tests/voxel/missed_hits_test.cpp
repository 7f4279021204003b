// Tests casts against brute force: no ray passes through the reference surface, none stops above it.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <limits>

#include "tests/paging/planet_fixture.h"
#include "tests/voxel/brute_force.h"
#include "vpe/base/number.h"
#include "vpe/base/parallel.h"

namespace {

using test_support::BruteForce;
using test_support::Random;
using test_support::Verdict;

// Bumpy, with posts eight times as dense about two places: a cube corner, and one within a face.
std::shared_ptr<const paging::PlanetFile> stepped_planet(const std::filesystem::path& path) {
  const glm::dvec3 corner = glm::normalize(glm::dvec3(1, 1, 1));
  const glm::dvec3 inside = mars::direction({-63, 17});
  const test_support::FakeElevation source(test_support::bumpy_height, [=](const mars::Cap& cap) {
    for (const glm::dvec3& at : {corner, inside}) {
      if (glm::length(cap.centre - at) < cap.radius_rad + 0.02) return 6000.0;
    }
    return 1e9;
  });
  return test_support::build_fake(path, source, 60000);
}

// Casts in double must be exact to their rounding, not only to 1e-6 of the range.
constexpr test_support::Tie kRounding{4e-15, 1e-8};

struct Ray {
  glm::dvec3 camera_m;
  glm::dvec3 direction;
};

// Returns a chart coordinate of a tile: a border if asked for, else one of its post lines or any.
double pick_line(Random& random, const std::vector<double>& lines, bool border) {
  const int last = static_cast<int>(lines.size()) - 1;
  if (border) return random.integer(0, 1) == 0 ? lines.front() : lines.back();
  if (random.integer(0, 1) == 0) return lines[static_cast<std::size_t>(random.integer(0, last))];
  return random.uniform(lines.front(), lines.back());
}

// Returns a point of the reference surface or, half of the time, just below it; mostly on a border of tiles,
// levels or faces.
glm::dvec3 pick_target(Random& random, const paging::Surface& surface) {
  const lod::TileTree& tree = surface.planet().tree();
  for (;;) {
    const lod::TileInfo& tile =
        tree[static_cast<lod::TileTree::Index>(random.integer(0, static_cast<int>(tree.size()) - 1))];
    if (tile.has_children) continue;
    const lod::GridLines lines = lod::grid_lines(tile.key, tree.shape().intervals());
    const int border = random.integer(0, 3);  // one, the other, a corner, neither
    const double u = pick_line(random, lines.u, border == 0 || border == 2);
    const double v = pick_line(random, lines.v, border == 1 || border == 2);
    const glm::dvec3 direction = mars::chart_direction(tile.key.face, u, v);
    const double sunk_m = random.integer(0, 1) == 0 ? 0.0 : random.log_uniform(1e-8, 1.0);
    return direction * (surface.at(direction).radius_m - sunk_m);
  }
}

// Returns a ray from a camera 1 m to 10 000 km above ground to a target below, grazing half of the time; one
// ray in four points anywhere.
Ray pick_ray(Random& random, const paging::Surface& surface) {
  for (;;) {
    Ray ray;
    const double distance_m = random.log_uniform(1.0, 1e7);
    if (random.integer(0, 3) == 0) {
      const glm::dvec3 up = random.direction();
      ray.camera_m = up * (surface.at(up).radius_m + distance_m);
      ray.direction = random.direction();
      return ray;
    }
    const glm::dvec3 target = pick_target(random, surface);
    const glm::dvec3 up = glm::normalize(target);
    const glm::dvec3 along = glm::normalize(glm::cross(up, random.direction()));
    const double elevation_rad =
        random.integer(0, 1) == 0 ? random.uniform(0.0, 1.57) : random.log_uniform(1e-7, 0.3);
    ray.camera_m = target + distance_m * (std::cos(elevation_rad) * along + std::sin(elevation_rad) * up);
    ray.direction = glm::normalize(target - ray.camera_m);
    if (glm::length(ray.camera_m) > surface.at(ray.camera_m).radius_m + 0.5) return ray;
  }
}

void expect_no_missed_hits(std::int64_t count) {
  const test_support::TempDir dir;
  const auto planet = stepped_planet(dir / "stepped.vpe");
  const paging::Surface surface(planet, std::size_t{256} << 20);
  const BruteForce truth(*planet);
  Random random(7000);
  std::array<std::int64_t, 4> verdict_counts{};
  std::int64_t hits = 0;
  std::vector<Ray> wrong;
  constexpr std::int64_t kBatch = 20000;
  for (std::int64_t done = 0; done < count; done += kBatch) {
    std::vector<Ray> rays(static_cast<std::size_t>(std::min(kBatch, count - done)));
    for (Ray& ray : rays) ray = pick_ray(random, surface);
    std::vector<Verdict> verdicts(rays.size());
    std::vector<char> hit(rays.size());
    vpe::base::parallel_for(rays.size(), 0, [&](std::size_t n) {
      const double found_m = surface.cast(rays[n].camera_m, rays[n].direction);
      verdicts[n] = test_support::judge(truth, rays[n].camera_m, rays[n].direction, found_m, kRounding);
      hit[n] = std::isfinite(found_m) ? 1 : 0;
    });
    for (std::size_t n = 0; n < rays.size(); ++n) {
      ++verdict_counts[static_cast<std::size_t>(verdicts[n])];
      hits += hit[n];
      if (verdicts[n] == Verdict::kMissed || verdicts[n] == Verdict::kPhantom) wrong.push_back(rays[n]);
    }
  }
  const auto verdicts = [&](Verdict v) { return verdict_counts[static_cast<std::size_t>(v)]; };
  for (std::size_t n = 0; n < std::min<std::size_t>(wrong.size(), 5); ++n) {
    const Ray& ray = wrong[n];
    ADD_FAILURE() << "camera " << ray.camera_m.x << " " << ray.camera_m.y << " " << ray.camera_m.z
                  << " towards " << ray.direction.x << " " << ray.direction.y << " " << ray.direction.z
                  << ": cast " << surface.cast(ray.camera_m, ray.direction) << " m, exact "
                  << truth.cast(ray.camera_m, ray.direction) << " m";
  }
  EXPECT_EQ(verdicts(Verdict::kMissed), 0);
  EXPECT_EQ(verdicts(Verdict::kPhantom), 0);
  EXPECT_LE(verdicts(Verdict::kTie), count / 20);  // rays aimed at ridges from beside them
  EXPECT_GE(hits, count / 2);                      // most rays reach the ground
  ::testing::Test::RecordProperty("rays", std::to_string(count));
  ::testing::Test::RecordProperty("ties", std::to_string(verdicts(Verdict::kTie)));
  std::printf("%lld rays, %lld hits, %lld ties, %zu triangles\n", static_cast<long long>(count),
              static_cast<long long>(hits), static_cast<long long>(verdicts(Verdict::kTie)), truth.triangles());
}

TEST(ZeroMissedHits, InGrazingRaysAtBorders) { expect_no_missed_hits(20000); }

// $VPE_RAYS: fewer or more than a million.
TEST(LongRaysZeroMissedHits, InAMillionRays) {
  const char* asked = std::getenv("VPE_RAYS");
  const auto count = asked != nullptr ? vpe::base::parse_integer(asked) : std::nullopt;
  expect_no_missed_hits(count.value_or(1000000));
}

// Tests the judge itself: true ranges pass, ranges beside them do not.
TEST(BruteForceJudge, TellsWrongFromRight) {
  const test_support::TempDir dir;
  const auto planet = test_support::build_fake(dir / "bumpy.vpe",
                                               test_support::FakeElevation(test_support::bumpy_height), 200000);
  const paging::Surface surface(planet, std::size_t{64} << 20);
  const BruteForce truth(*planet);
  Random random(17);
  for (int n = 0; n < 300; ++n) {
    const glm::dvec3 up = random.direction();
    const double ground_m = surface.at(up).radius_m;
    EXPECT_NEAR(truth.radius_m(up), ground_m, 1e-8);
    const double height_m = random.log_uniform(10, 1e6);
    const glm::dvec3 camera = up * (ground_m + height_m);
    EXPECT_EQ(test_support::judge(truth, camera, -up, height_m), Verdict::kSame);
    EXPECT_EQ(test_support::judge(truth, camera, -up, height_m * (1 + 5e-7)), Verdict::kTie);
    EXPECT_EQ(test_support::judge(truth, camera, -up, height_m * (1 + 1e-4)), Verdict::kMissed);
    EXPECT_EQ(test_support::judge(truth, camera, -up, height_m * (1 - 5e-7)), Verdict::kTie);
    EXPECT_EQ(test_support::judge(truth, camera, -up, height_m * (1 - 1e-4)), Verdict::kPhantom);
    constexpr double kNone = std::numeric_limits<double>::infinity();
    EXPECT_EQ(test_support::judge(truth, camera, -up, kNone), Verdict::kMissed);
    EXPECT_EQ(test_support::judge(truth, camera, up, kNone), Verdict::kSame);
    EXPECT_EQ(test_support::judge(truth, camera, up, 5.0), Verdict::kPhantom);
    EXPECT_EQ(test_support::judge(truth, camera, -up, std::numeric_limits<double>::quiet_NaN()),
              Verdict::kPhantom);
  }
}

}  // namespace
