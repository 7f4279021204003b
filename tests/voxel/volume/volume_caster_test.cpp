// Casts of terrain volumes: starts, cells, approximation, roll, overhangs.
#include "vpe/voxel/volume/volume_caster.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>

#include "tests/support/support.h"
#include "tests/voxel/volume/volume_scenes.h"
#include "vpe/voxel/volume/pixel_rays.h"

namespace vpe::voxel {
namespace {

using test_support::Random;
using volume_scenes::brute_range;
using volume_scenes::hill;
using volume_scenes::view_from;

struct Scene {
  explicit Scene(VolumeFilter filter, int side = 96)
      : volume(make_terrain_volume(volume_scenes::hills(side), {.levels = 64, .filter = filter})),
        cells(volume) {}

  VolumeRanges cast(const core::View& view, const VolumeCastOptions& options, int threads = 2) const {
    base::ThreadPool pool(threads);
    return cast_volume(volume, cells, view, options, pool);
  }

  TerrainVolume volume;
  BoundaryCells cells;
};

// A view from above the hills, of any direction and roll.
core::View any_view(Random& random) {
  const glm::dvec3 eye{random.uniform(5, 90), random.uniform(5, 90), random.uniform(41, 90)};
  return view_from(eye, random.uniform(-180, 180), random.uniform(-89, 10), random.uniform(-180, 180),
                   random.integer(20, 70), random.integer(20, 70), random.uniform(20, 100));
}

TEST(VolumeCaster, StartsAndCellsDoNotChangeTheHits) {
  Random random(1);
  for (const VolumeFilter filter : {VolumeFilter::kNone, VolumeFilter::kGaussian, VolumeFilter::kBox}) {
    const Scene scene(filter);
    for (int n = 0; n < 25; ++n) {
      const core::View view = any_view(random);
      const VolumeRanges plain = scene.cast(view, {.start = VolumeStart::kCamera, .uses_cells = false});
      const VolumeRanges flagged = scene.cast(view, {.start = VolumeStart::kCamera});
      const VolumeRanges checked = scene.cast(view, {.start = VolumeStart::kChecked});
      ASSERT_EQ(flagged.range, plain.range) << n;
      ASSERT_EQ(checked.range, plain.range) << n;
      ASSERT_EQ(scene.cast(view, {}, 1).range, checked.range);
      EXPECT_LE(flagged.counts.interpolations, plain.counts.interpolations);
      EXPECT_LE(checked.counts.samples, flagged.counts.samples);
      // In approximate images the start does not matter either.
      const VolumeRanges near = scene.cast(view, {.is_approximate = true});
      ASSERT_EQ(scene.cast(view, {.is_approximate = true, .start = VolumeStart::kCamera}).range, near.range);
      EXPECT_EQ(near.counts.interpolations, 0);
      for (std::size_t k = 0; k < near.range.size(); ++k) ASSERT_LE(near.range[k], plain.range[k] + 0.61F);
    }
  }
}

// The start of the paper, from where it is meant to be used: looking ahead, without ground that is met behind other ground by
// oblique planes alone.
TEST(VolumeCaster, StartsOfThePaperMissLittle) {
  const Scene scene(VolumeFilter::kGaussian);
  for (const double roll_deg : {0.0, 20.0, 45.0, -30.0}) {
    const core::View view = view_from({48, 4, 50}, 5, -30, roll_deg, 160, 120, 50);
    const VolumeRanges exact = scene.cast(view, {.start = VolumeStart::kCamera});
    const VolumeRanges paper = scene.cast(view, {.start = VolumeStart::kPaper});
    std::size_t differs = 0;
    for (std::size_t n = 0; n < exact.range.size(); ++n) differs += exact.range[n] != paper.range[n] ? 1 : 0;
    EXPECT_LT(static_cast<double>(differs), 0.02 * static_cast<double>(exact.range.size())) << roll_deg;
    EXPECT_LT(paper.counts.samples, exact.counts.samples / 4) << roll_deg;
    EXPECT_GT(paper.counts.retraced, 0);
  }
}

TEST(VolumeCaster, RangesAreThoseOfFineSteps) {
  const Scene scene(VolumeFilter::kGaussian);
  Random random(2);
  double most = 0;
  int missed = 0;
  int hits = 0;
  for (int n = 0; n < 12; ++n) {
    const core::View view = any_view(random);
    const VolumeRanges found = scene.cast(view, {});
    for (std::size_t k = 0; k < found.range.size(); k += 5) {
      const auto width = static_cast<std::size_t>(view.width);
      const glm::dvec3 d =
          core::pixel_ray(view, static_cast<double>(k % width) + 0.5, static_cast<double>(k / width) + 0.5);
      const double expected = brute_range(scene.volume, view.camera.position_m, d, 0.01);
      const double range = static_cast<double>(found.range[k]);
      if (!std::isfinite(expected)) {
        EXPECT_FALSE(std::isfinite(range));
        continue;
      }
      ++hits;
      // Ridges thinner than the interval may be passed.
      if (range - expected > 0.6) {
        ++missed;
      } else {
        most = std::max(most, std::abs(range - expected));
      }
    }
  }
  EXPECT_GT(hits, 1000);
  EXPECT_LT(missed, hits / 100);
  EXPECT_LT(most, 0.6);
}

TEST(VolumeCaster, WithoutAFilterHitsLieWithinHalfAVoxelOfTheHeights) {
  const Scene scene(VolumeFilter::kNone);
  Random random(3);
  int count = 0;
  double most = 0;
  for (int n = 0; n < 12; ++n) {
    const core::View view = any_view(random);
    const VolumeRanges found = scene.cast(view, {.interval = 0.05});
    for (std::size_t k = 0; k < found.range.size(); ++k) {
      if (!std::isfinite(found.range[k])) continue;
      const auto width = static_cast<std::size_t>(view.width);
      const glm::dvec3 d =
          core::pixel_ray(view, static_cast<double>(k % width) + 0.5, static_cast<double>(k / width) + 0.5);
      const glm::dvec3 p = view.camera.position_m + static_cast<double>(found.range[k]) * d;
      // Sides of the volume are no surface.
      if (std::min({p.x, p.y, 95 - p.x, 95 - p.y}) < 1) continue;
      ++count;
      // The nearest point of the bilinear surface over the posts.
      const auto height = [&](double x, double y) {
        const double i = std::floor(x);
        const double j = std::floor(y);
        const double u = x - i;
        const double v = y - j;
        return (1 - v) * ((1 - u) * hill(i, j) + u * hill(i + 1, j)) +
               v * ((1 - u) * hill(i, j + 1) + u * hill(i + 1, j + 1));
      };
      double nearest = std::abs(p.z - height(p.x, p.y));
      for (int dy = -10; dy <= 10; ++dy)
        for (int dx = -10; dx <= 10; ++dx) {
          const glm::dvec2 at{p.x + 0.06 * dx, p.y + 0.06 * dy};
          nearest = std::min(nearest, glm::length(glm::dvec3(at, height(at.x, at.y)) - p));
        }
      most = std::max(most, nearest);
    }
  }
  EXPECT_GT(count, 5000);
  EXPECT_LE(most, 0.51);
}

// An arch: a bar over a gap, under which rays pass, and whose underside they meet from below.
TEST(VolumeCaster, OverhangsAreMetFromAllSides) {
  constexpr int kSide = 40;
  constexpr int kLevels = 30;
  std::vector<std::uint8_t> densities;
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i)
      for (int k = 0; k < kLevels; ++k) {
        // A half ring about (20, 3) in the plane of x and z, 6 voxels deep, on flat ground.
        const double r = std::hypot(i - 20.0, k - 3.0);
        const double arch = std::min({r - 9, 16 - r, 3.5 - std::abs(j - 20.0)});
        const double depth = std::max(3.4 - k, arch);
        densities.push_back(
            static_cast<std::uint8_t>(std::lround(255 * std::clamp(0.5 + depth / 3.6, 0.0, 1.0))));
      }
  const TerrainVolume volume(kSide, kSide, kLevels, 127, densities);
  const BoundaryCells cells(volume);
  base::ThreadPool pool(2);
  int under = 0;
  int through = 0;
  for (const auto& [eye, pitch_deg] :
       {std::pair(glm::dvec3(20, 2, 7), 4.0), std::pair(glm::dvec3(22, 16.5, 5), 60.0),
        std::pair(glm::dvec3(3, 5, 25), -20.0)}) {
    const core::View view = view_from(eye, 10, pitch_deg, 15, 60, 50, 70);
    const VolumeRanges found = cast_volume(volume, cells, view, {}, pool);
    EXPECT_EQ(
        cast_volume(volume, cells, view, {.start = VolumeStart::kCamera, .uses_cells = false}, pool).range,
        found.range);
    for (std::size_t k = 0; k < found.range.size(); ++k) {
      const glm::dvec3 d =
          core::pixel_ray(view, static_cast<double>(k % 60) + 0.5, static_cast<double>(k / 60) + 0.5);
      const double expected = brute_range(volume, eye, d, 0.02);
      const double range = static_cast<double>(found.range[k]);
      if (std::isfinite(expected) != std::isfinite(range) || std::abs(expected - range) > 0.05) {
        // Only edges may be cut off by the interval.
        EXPECT_LT(std::abs(volume.density(eye + expected * d) - 127.5), 40);
        continue;
      }
      if (!std::isfinite(range)) continue;
      const glm::dvec3 p = eye + range * d;
      if (p.z > 9 && d.z > 0) ++under;
      if (p.z < 4.5 && p.y > 25 && eye.y < 16 && std::abs(p.x - 20) < 6) ++through;
    }
  }
  EXPECT_GT(under, 50);
  EXPECT_GT(through, 20);
}

TEST(PixelRays, AreThoseOfTheView) {
  Random random(5);
  for (int n = 0; n < 40; ++n) {
    core::View view = any_view(random);
    view.principal_offset_px = {random.uniform(-30, 30), random.uniform(-30, 30)};
    const PixelRays rays(view);
    for (int k = 0; k < 20; ++k) {
      const int x = random.integer(0, view.width - 1);
      const int y = random.integer(0, view.height - 1);
      EXPECT_LT(glm::length(rays.through(x, y) - core::pixel_ray(view, x + 0.5, y + 0.5)), 1e-14);
    }
  }
}

TEST(VolumeCaster, RefusesWhatItCannotCast) {
  const Scene scene(VolumeFilter::kBox, 20);
  const Scene other(VolumeFilter::kBox, 24);
  base::ThreadPool pool(1);
  core::View view = view_from({10, 10, 50}, 0, -30, 0, 10, 10, 50);
  EXPECT_THROW(cast_volume(scene.volume, other.cells, view, {}, pool), std::invalid_argument);
  EXPECT_THROW(scene.cast(view, {.interval = 0}), std::invalid_argument);
  EXPECT_THROW(scene.cast(view, {.interval = NAN}), std::invalid_argument);
  view.part = {0, 0, 5, 5};
  EXPECT_THROW(scene.cast(view, {}), std::invalid_argument);
  view.part = {};
  view.projection = core::Projection::kCylinder;
  EXPECT_THROW(scene.cast(view, {}), std::invalid_argument);
  // A camera outside, that looks away or in.
  const VolumeRanges away = scene.cast(view_from({10, -30, 30}, 180, 0, 0, 8, 8, 40), {});
  EXPECT_TRUE(std::all_of(away.range.begin(), away.range.end(), [](float r) { return std::isinf(r); }));
  const VolumeRanges in = scene.cast(view_from({10, -30, 30}, 0, -20, 0, 8, 8, 40), {});
  EXPECT_TRUE(std::any_of(in.range.begin(), in.range.end(), [](float r) { return std::isfinite(r); }));
}

}  // namespace
}  // namespace vpe::voxel
