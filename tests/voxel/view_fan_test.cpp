// Tests that a fan's samples lie about all pixels of its image, and refines ranges whose surface is known.
#include "vpe/voxel/cast/view_fan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "tests/support/support.h"

namespace {

namespace core = vpe::core;
using test_support::Random;
using vpe::voxel::FanSamples;
using vpe::voxel::ViewFan;

core::View random_round_view(Random& random) {
  core::View view;
  view.projection =
      random.integer(0, 1) == 0 ? core::Projection::kCylinder : core::Projection::kEquirectangular;
  view.width = random.integer(1, 300);
  view.height = random.integer(1, 200);
  view.fov_deg = random.log_uniform(2, view.projection == core::Projection::kCylinder ? 150 : 180);
  const double pitch_deg = random.integer(0, 2) == 0 ? 90 * random.integer(-1, 1) : random.uniform(-90, 90);
  view.camera = mars::to_camera({random.uniform(-180, 180), random.uniform(-89, 89), 1e4,
                                 random.uniform(-180, 180), pitch_deg, random.uniform(-180, 180)},
                                3396190);
  if (random.integer(0, 1) == 0 && view.width > 20 && view.height > 20)
    view.part = {random.integer(0, 9), random.integer(0, 9), view.width - random.integer(9, 19),
                 view.height - random.integer(9, 19)};
  return view;
}

TEST(ViewFan, HasSamplesAboutEveryPixel) {
  Random random(11);
  int full_circles = 0;
  for (int n = 0; n < 300; ++n) {
    const core::View view = random_round_view(random);
    const glm::dvec3 up = glm::normalize(view.camera.position_m);
    const ViewFan fan(view, up);
    const FanSamples samples = fan.samples(nullptr);
    full_circles += samples.is_full_circle ? 1 : 0;
    ASSERT_LE(samples.elevation_step, fan.spacing_rad() * (1 + 1e-12));
    const core::SubRectangle part = core::drawn_part(view);
    for (int y = 0; y < part.height; ++y) {
      for (int x = 0; x < part.width; ++x) {
        const glm::dvec3 ray = core::pixel_ray(view, part.x + x + 0.5, part.y + y + 0.5);
        const double along = glm::dot(ray, samples.north);
        const double across = glm::dot(ray, samples.east);
        const double level = std::hypot(along, across);
        double turn = std::atan2(across, along) - samples.first_azimuth;
        turn -= 2 * mars::kPi * std::floor(turn / (2 * mars::kPi));
        const int column = static_cast<int>(turn / samples.azimuth_step);
        const double line =
            (std::atan2(glm::dot(ray, up), level) - samples.first_elevation) / samples.elevation_step;
        const int row = static_cast<int>(std::floor(line));
        // Columns lie as close as rows where the ray is.
        ASSERT_LE(samples.azimuth_step * level, fan.spacing_rad() * (1 + 1e-9) + 1e-12);
        for (const int at : {column, column + 1}) {
          ASSERT_TRUE(samples.is_full_circle || at < samples.columns) << n << " " << x << " " << y;
          const int c = at % samples.columns;
          // No row lies beyond the zenith or the nadir.
          const bool has_row_above =
              samples.first_elevation + (row + 1) * samples.elevation_step < mars::kPi / 2;
          ASSERT_LE(samples.first_row[c], std::max(row, 0)) << n << " " << x << " " << y;
          ASSERT_GT(samples.end_row[c], has_row_above ? row + 1 : row) << n << " " << x << " " << y;
        }
      }
    }
  }
  EXPECT_GT(full_circles, 50);
  EXPECT_LT(full_circles, 250);
}

TEST(ViewFan, NeedsFewMoreSamplesThanPixels) {
  core::View view;
  view.projection = core::Projection::kEquirectangular;
  view.width = 2000;
  view.height = 1000;
  view.fov_deg = 180;
  view.camera = mars::to_camera({10, 20, 1e4, 40, -35, 10}, 3396190);
  const glm::dvec3 up = glm::normalize(view.camera.position_m);
  EXPECT_NEAR(static_cast<double>(ViewFan(view, up).sample_count()), 2e6, 2e4);
  // A part about the nadir needs only columns that are as close as its pixels at its border.
  const core::Projected nadir = core::project(view, view.camera.position_m - up);
  view.part = {static_cast<int>(nadir.xy.x) - 50, static_cast<int>(nadir.xy.y) - 50, 100, 100};
  EXPECT_LT(ViewFan(view, up).sample_count(), 4 * 100 * 100);
}

}  // namespace
