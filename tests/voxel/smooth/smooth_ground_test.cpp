// Tests casts at smooth ground: closed forms, grazing rays against the trial of every cell, images.
#include "vpe/voxel/smooth/smooth_ground.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "tests/voxel/smooth/smooth_fixture.h"
#include "vpe/base/parallel.h"
#include "vpe/core/frame.h"
#include "vpe/voxel/smooth/smooth_caster.h"
#include "vpe/voxel/smooth/smooth_ray.h"

namespace {

namespace core = vpe::core;
using test_support::kPatches;
using test_support::name_of;
using test_support::Random;
using test_support::SmoothPlanet;
using vpe::voxel::FaceRay;
using vpe::voxel::RaySegment;
using vpe::voxel::SmoothForm;
using vpe::voxel::SmoothGround;
using vpe::voxel::SmoothTile;

constexpr double kNone = std::numeric_limits<double>::infinity();

// Finds hits by every cell of every tile that the ray is over, without bounds: samples of the height over the patch, and
// golden sections where three of them show a least one.
class EveryCell {
 public:
  EveryCell(const SmoothPlanet& planet, const SmoothForm& form) : planet_(planet), form_(form) {
    for (lod::TileTree::Index n = 0; n < planet.tree().size(); ++n)
      if (!planet.tree()[n].has_children) tiles_.push_back(planet.ground.tile(n, form.patch));
  }

  // Returns a place of the first cell in which the ray is `depth_m` or more below the ground.
  double first_below(const glm::dvec3& origin_m, const glm::dvec3& direction, double depth_m) const {
    double first = kNone;
    for (const auto& tile : tiles_) {
      const mars::ChartRect rect = lod::chart_rect(tile->key());
      const FaceRay ray(rect.face, origin_m, direction);
      // Not beyond the planet's highest ground.
      const double top_m = planet_.ground.radius_m() + form_.exaggeration * 20000;
      const double rest = ray.ed * ray.ed - ray.ee + top_m * top_m;
      if (!(rest > 0)) continue;
      RaySegment segment{std::max(0.0, -ray.ed - std::sqrt(rest)), -ray.ed + std::sqrt(rest)};
      if (!vpe::voxel::cut_to_rect(ray, rect.u0, rect.u1, rect.v0, rect.v1, segment)) continue;
      first = std::min(first, in_tile(*tile, ray, segment, depth_m));
    }
    return first;
  }

 private:
  double in_tile(const SmoothTile& tile, const FaceRay& ray, const RaySegment& segment, double depth_m) const {
    std::vector<double> ends{segment.s0, segment.s1};
    const auto add = [&](double e, double d, const std::vector<double>& lines) {
      for (const double line : lines) {
        const double s = (line * ray.e.z - e) / (d - line * ray.d.z);
        if (s > segment.s0 && s < segment.s1) ends.push_back(s);
      }
    };
    add(ray.e.x, ray.d.x, tile.u_lines());
    add(ray.e.y, ray.d.y, tile.v_lines());
    std::sort(ends.begin(), ends.end());
    for (std::size_t n = 0; n + 1 < ends.size(); ++n) {
      const double a = ends[n];
      const double b = ends[n + 1];
      const glm::dvec3 middle = ray.e + 0.5 * (a + b) * ray.d;
      const auto cell = [](const std::vector<double>& lines, double x) {
        return static_cast<int>(std::upper_bound(lines.begin() + 1, lines.end() - 1, x) - lines.begin()) - 1;
      };
      const int i = cell(tile.u_lines(), middle.x / middle.z);
      const int j = cell(tile.v_lines(), middle.y / middle.z);
      // Quickly past cells that the ray is far above.
      const double highest_m =
          planet_.ground.radius_m() +
          form_.exaggeration * static_cast<double>(tile.bounds(tile.levels(), 0, 0).high_m) + 10;
      const double lowest = std::clamp(-ray.ed, a, b);
      if (ray.ee + lowest * (2 * ray.ed + lowest) > highest_m * highest_m) continue;
      const double u0 = tile.u_lines()[static_cast<std::size_t>(i)];
      const double v0 = tile.v_lines()[static_cast<std::size_t>(j)];
      const double du = tile.u_lines()[static_cast<std::size_t>(i) + 1] - u0;
      const double dv = tile.v_lines()[static_cast<std::size_t>(j) + 1] - v0;
      const vpe::voxel::SmoothPatch patch = tile.patch(i, j, form_.exaggeration);
      const auto over = [&](double s) {
        const glm::dvec3 p = ray.e + s * ray.d;
        const double h = patch.at((p.x / p.z - u0) / du, (p.y / p.z - v0) / dv).h;
        return glm::length(p) - planet_.ground.radius_m() - form_.exaggeration * tile.base_m() - h + depth_m;
      };
      constexpr int kSamples = 24;
      std::array<double, kSamples + 1> value{};
      const auto place = [&](int k) { return a + (b - a) * k / kSamples; };
      for (int k = 0; k <= kSamples; ++k) value[static_cast<std::size_t>(k)] = over(place(k));
      for (int k = 0; k <= kSamples; ++k) {
        const auto at = static_cast<std::size_t>(k);
        if (value[at] <= 0) return place(k);
        if (k == 0 || k == kSamples || value[at] > value[at - 1] || value[at] > value[at + 1]) continue;
        double low = place(k - 1);
        double high = place(k + 1);
        for (int step = 0; step < 60; ++step) {
          const double left = low + 0.381966 * (high - low);
          const double right = high - 0.381966 * (high - low);
          (over(left) < over(right) ? high : low) = over(left) < over(right) ? right : left;
        }
        if (over(0.5 * (low + high)) <= 0) return 0.5 * (low + high);
      }
    }
    return kNone;
  }

  const SmoothPlanet& planet_;
  SmoothForm form_;
  std::vector<std::shared_ptr<const SmoothTile>> tiles_;
};

struct Ray {
  glm::dvec3 origin_m;
  glm::dvec3 direction;
};

// Returns a ray in a tangent plane of the ground at some place, up to a metre above or below, and from up to 300 km away.
Ray grazing_ray(Random& random, const SmoothGround& ground, const SmoothForm& form) {
  glm::dvec3 at = random.direction();
  if (random.integer(0, 2) == 0)
    at = glm::normalize(glm::normalize(glm::dvec3(1, 1, 1)) + 0.03 * random.direction());
  if (random.integer(0, 3) == 0) {
    // On an edge of the cube.
    at = mars::cube_point(mars::Face::kPlusX, 1, random.uniform(-1, 1));
    at = glm::normalize(at);
  }
  const auto point = ground.at(at, form);
  const glm::dvec3 along = glm::normalize(glm::cross(point.normal, random.direction()));
  const double lift_m = (random.integer(0, 1) == 0 ? 1 : -1) * random.log_uniform(1e-6, 1);
  const glm::dvec3 touched = at * (ground.radius_m() + point.height_m) + lift_m * point.normal;
  return {touched - random.log_uniform(100, 3e5) * along, along};
}

void expect_no_missed_hits(std::int64_t count) {
  const test_support::TempDir dir;
  const SmoothPlanet planet(test_support::levels_planet(dir / "levels.vpe"));
  for (const core::RayPatch patch : kPatches) {
    const SmoothForm form{patch, 1.5};
    const EveryCell truth(planet, form);
    Random random(31);
    std::int64_t hits = 0;
    std::int64_t missed = 0;
    std::int64_t phantoms = 0;
    for (std::int64_t n = 0; n < count; ++n) {
      const Ray ray = grazing_ray(random, planet.ground, form);
      // Only cameras above the ground.
      const double ground_m = planet.ground.radius_m() + planet.ground.at(ray.origin_m, form).height_m;
      if (glm::length(ray.origin_m) < ground_m + 1e-3) continue;
      const double found = planet.ground.cast(ray.origin_m, ray.direction, form);
      // What is a tenth of a micrometre deep must be hit, and what is hit is as near to the ground as that: heights round to
      // some 1e-9 m.
      const double deep = truth.first_below(ray.origin_m, ray.direction, 1e-7);
      hits += deep < kNone ? 1 : 0;
      missed += deep < kNone && found > deep + 1e-3 ? 1 : 0;
      if (!(found < kNone)) continue;
      const glm::dvec3 point_m = ray.origin_m + found * ray.direction;
      const double over_m =
          glm::length(point_m) - planet.ground.radius_m() - planet.ground.at(point_m, form).height_m;
      phantoms += over_m > 1e-5 ? 1 : 0;
    }
    std::printf("%s: %lld hits, %lld missed, %lld phantoms\n", name_of(patch), static_cast<long long>(hits),
                static_cast<long long>(missed), static_cast<long long>(phantoms));
    EXPECT_GT(hits, count / 4);
    EXPECT_EQ(missed, 0);
    EXPECT_EQ(phantoms, 0);
  }
}

TEST(SmoothGrazing, NoRayPassesThroughThePatches) { expect_no_missed_hits(1500); }

// VPE_LONG=1: a hundred thousand rays of each kind.
TEST(LongSmoothGrazing, NoRayPassesThroughThePatches) {
  if (std::getenv("VPE_LONG") == nullptr) GTEST_SKIP() << "skipped: takes long; set VPE_LONG=1";
  expect_no_missed_hits(100000);
}

// Rays straight at borders between tiles, from either side: none comes through a crack.
TEST(SmoothGround, NoRayComesThroughABorder) {
  const test_support::TempDir dir;
  const SmoothPlanet planet(test_support::levels_planet(dir / "levels.vpe"));
  Random random(32);
  for (const core::RayPatch patch : kPatches) {
    const SmoothForm form{patch, 1};
    for (int n = 0; n < 6000; ++n) {
      const auto index =
          static_cast<lod::TileTree::Index>(random.integer(0, static_cast<int>(planet.tree().size()) - 1));
      if (planet.tree()[index].has_children) continue;
      const mars::ChartRect rect = lod::chart_rect(planet.tree()[index].key);
      const bool is_corner = n % 5 == 0;
      const double t = is_corner ? random.integer(0, 1) : random.uniform(0, 1);
      const bool north = random.integer(0, 1) == 0;
      const double u =
          north ? (random.integer(0, 1) == 0 ? rect.u0 : rect.u1) : rect.u0 + t * (rect.u1 - rect.u0);
      const double v =
          north ? rect.v0 + t * (rect.v1 - rect.v0) : (random.integer(0, 1) == 0 ? rect.v0 : rect.v1);
      const glm::dvec3 direction = mars::chart_direction(rect.face, u, v);
      const auto point = planet.ground.at(direction, form);
      const glm::dvec3 target = direction * (planet.ground.radius_m() + point.height_m);
      const glm::dvec3 side = glm::normalize(glm::cross(direction, random.direction()));
      const double elevation = random.uniform(0.3, 1.5);
      const double range_m = random.log_uniform(10, 1e6);
      const glm::dvec3 camera_m =
          target + range_m * (std::cos(elevation) * side + std::sin(elevation) * direction);
      if (glm::length(camera_m) < planet.ground.radius_m() + planet.ground.at(camera_m, form).height_m)
        continue;
      const double found = planet.ground.cast(camera_m, glm::normalize(target - camera_m), form);
      // Something may stand in between, but nothing lies behind.
      ASSERT_LE(found, range_m + 2e-2) << name_of(patch) << " " << n;
    }
  }
}

TEST(SmoothGround, FlatGroundIsTheSphere) {
  const test_support::TempDir dir;
  const SmoothPlanet planet(
      test_support::levels_planet(dir / "flat.vpe", [](const glm::dvec3&) { return 0.0; }));
  Random random(33);
  const double radius_m = planet.ground.radius_m();
  for (const core::RayPatch patch : kPatches) {
    for (int n = 0; n < 3000; ++n) {
      const glm::dvec3 camera_m = random.direction() * (radius_m + random.log_uniform(1, 1e7));
      const glm::dvec3 direction = glm::normalize(random.direction() * (0.9 * radius_m) - camera_m);
      const double found = planet.ground.cast(camera_m, direction, {patch, 1});
      const double half = glm::dot(camera_m, direction);
      const double rest = half * half - glm::dot(camera_m, camera_m) + radius_m * radius_m;
      if (std::abs(rest) < 1e3) continue;
      if (rest < 0) {
        ASSERT_EQ(found, kNone);
        continue;
      }
      const double exact = -half - std::sqrt(rest);
      // The posts are rounded to the file's steps.
      ASSERT_NEAR(found, exact, 2e-2 * radius_m / std::sqrt(rest) + 1e-9 * exact);
      const auto point = planet.ground.at(camera_m + found * direction, {patch, 1});
      ASSERT_NEAR(glm::dot(point.normal, glm::normalize(camera_m + found * direction)), 1, 1e-9);
    }
  }
}

core::View random_view(Random& random, const SmoothPlanet& planet, const SmoothForm& form, int width,
                       int height) {
  const glm::dvec3 up = random.direction();
  const auto place = mars::lon_lat(up);
  const double ground_m = planet.ground.at(up, form).height_m;
  core::View view;
  view.width = width;
  view.height = height;
  view.fov_deg = random.uniform(20, 100);
  view.camera = mars::to_camera({place.lon_deg, place.lat_deg, ground_m + random.log_uniform(2, 1e7),
                                 random.uniform(0, 360), random.uniform(-90, 10), random.uniform(-30, 30)},
                                planet.ground.radius_m());
  return view;
}

// Images are single casts, in every projection, and 1 and 3 threads draw the same.
TEST(SmoothCaster, ImagesAreSingleCasts) {
  const test_support::TempDir dir;
  const SmoothPlanet planet(test_support::levels_planet(dir / "levels.vpe"));
  Random random(34);
  vpe::base::ThreadPool one(1);
  vpe::base::ThreadPool three(3);
  for (int n = 0; n < 24; ++n) {
    const SmoothForm form{kPatches[static_cast<std::size_t>(n % 2)], random.log_uniform(0.5, 4)};
    core::View view = random_view(random, planet, form, 45, 37);
    view.projection = static_cast<core::Projection>(n % 3);
    if (n % 4 == 3) view.part = {5, 3, 30, 20};
    const core::SubRectangle part = core::drawn_part(view);
    const auto count = static_cast<std::size_t>(part.width * part.height);
    std::vector<float> range_m(count);
    std::vector<vpe::voxel::PixelNormal> normals(count);
    const auto usage = cast_smooth(planet.ground, view, form, one, {range_m, normals});
    int hits = 0;
    for (int y = 0; y < part.height; ++y) {
      for (int x = 0; x < part.width; ++x) {
        const glm::dvec3 ray = core::pixel_ray(view, part.x + x + 0.5, part.y + y + 0.5);
        const double single = planet.ground.cast(view.camera.position_m, ray, form);
        const auto at = static_cast<std::size_t>(y * part.width + x);
        const auto found = static_cast<double>(range_m[at]);
        ASSERT_EQ(std::isfinite(found), std::isfinite(single)) << n << ": " << x << " " << y;
        if (!std::isfinite(found)) continue;
        ++hits;
        ASSERT_NEAR(found, single, 1e-7 * single + 1e-6);
        const auto& normal = normals[at];
        if (normal.share <= 0) continue;
        const auto point = planet.ground.at(view.camera.position_m + single * ray, form);
        ASSERT_NEAR(glm::dot(point.normal, glm::dvec3(normal.x, normal.y, normal.z)), 1, 1e-4);
      }
    }
    EXPECT_EQ(hits > 0, usage.smoothing_px > 0);
    std::vector<float> again_m(count);
    std::vector<vpe::voxel::PixelNormal> again(count);
    const auto other = cast_smooth(planet.ground, view, form, three, {again_m, again});
    ASSERT_EQ(again_m, range_m);
    ASSERT_EQ(other.smoothing_m, usage.smoothing_m);
    ASSERT_EQ(other.smoothing_px, usage.smoothing_px);
    ASSERT_EQ(other.tiles.tiles.size(), usage.tiles.tiles.size());
    // A mask leaves the others alone.
    std::vector<std::uint8_t> wanted(count);
    for (auto& pixel : wanted) pixel = random.integer(0, 2) == 0 ? 1 : 0;
    std::vector<float> some_m(count, -1);
    cast_smooth(planet.ground, view, form, three, {some_m, {}, wanted});
    for (std::size_t k = 0; k < count; ++k) ASSERT_EQ(some_m[k], wanted[k] != 0 ? range_m[k] : -1) << k;
  }
}

// 200 views: the ground that pixels show lies within the stated distance of the reference surface.
TEST(SmoothCaster, PixelsAgreeWithTheReferenceSurface) {
  const test_support::TempDir dir;
  const SmoothPlanet planet(test_support::levels_planet(dir / "levels.vpe"));
  Random random(35);
  vpe::base::ThreadPool pool(2);
  std::int64_t pixels = 0;
  std::int64_t off = 0;
  for (int n = 0; n < 200; ++n) {
    const SmoothForm form{kPatches[static_cast<std::size_t>(n % 2)],
                          n % 3 == 0 ? random.log_uniform(0.5, 4) : 1.0};
    const core::View view = random_view(random, planet, form, 40, 30);
    std::vector<float> range_m(1200);
    const auto usage = cast_smooth(planet.ground, view, form, pool, {range_m});
    for (int k = 0; k < 1200; ++k) {
      const auto range = static_cast<double>(range_m[static_cast<std::size_t>(k)]);
      if (!std::isfinite(range)) continue;
      const glm::dvec3 point_m =
          view.camera.position_m + range * core::pixel_ray(view, k % 40 + 0.5, k / 40 + 0.5);
      const double over_m = glm::length(point_m) - planet.surface.at(point_m, form.exaggeration).radius_m;
      ++pixels;
      // Ranges are floats.
      off += std::abs(over_m) > usage.smoothing_m + 1.2e-7 * range ? 1 : 0;
    }
  }
  std::printf("%lld pixels, %lld beyond the stated distance\n", static_cast<long long>(pixels),
              static_cast<long long>(off));
  EXPECT_GT(pixels, 100000);
  EXPECT_LE(static_cast<double>(off), 0.005 * static_cast<double>(pixels));
  EXPECT_EQ(off, 0);
}

// Hills whose shortest wave is some ten posts long: normals of patches are four times as right as those of flat facets.
TEST(SmoothGround, NormalsOfMagnifiedPostsAreFourTimesAsRight) {
  const test_support::TempDir dir;
  const auto height = [](const glm::dvec3& d) {
    return 3000 * std::sin(22 * d.x + 1) * std::sin(20 * d.y) + 2000 * std::sin(18 * d.z + 2);
  };
  const SmoothPlanet planet(
      test_support::build_fake(dir / "hills.vpe", test_support::FakeElevation(height), 100000));
  Random random(36);
  double smooth2 = 0;
  double bilinear2 = 0;
  double flat2 = 0;
  const double radius_m = planet.ground.radius_m();
  for (int n = 0; n < 20000; ++n) {
    const glm::dvec3 d = random.direction();
    const auto at = [&](const glm::dvec3& way) {
      const glm::dvec3 to = glm::normalize(way);
      return (radius_m + height(to)) * to;
    };
    const glm::dvec3 a =
        glm::normalize(glm::cross(d, std::abs(d.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0)));
    const glm::dvec3 b = glm::cross(d, a);
    constexpr double kStep = 1e-6;
    const glm::dvec3 exact = glm::normalize(
        glm::cross(at(d + kStep * a) - at(d - kStep * a), at(d + kStep * b) - at(d - kStep * b)));
    const auto error2 = [&](const glm::dvec3& normal) {
      const glm::dvec3 off = glm::cross(normal, exact);
      return glm::dot(off, off);
    };
    smooth2 += error2(planet.ground.at(d, {core::RayPatch::kBicubic, 1}).normal);
    bilinear2 += error2(planet.ground.at(d, {core::RayPatch::kBilinear, 1}).normal);
    flat2 += error2(planet.surface.at(d).normal);
  }
  std::printf("RMS error of normals to that of flat facets: bicubic %.3f, bilinear %.3f\n",
              std::sqrt(smooth2 / flat2), std::sqrt(bilinear2 / flat2));
  EXPECT_LE(std::sqrt(smooth2 / flat2), 0.25);
}

}  // namespace
