// Figure: rays of a column that climb sticks, pass cavities and gather semi-transparent voxels (Cohen-Or 1996, section 2).
#include <cmath>
#include <glm/geometric.hpp>

#include "objects/sticks/build_sticks.h"
#include "objects/sticks/stick_model.h"
#include "objects/sticks/voxel_grid.h"
#include "tests/bench/figures/ray_figures.h"

namespace bench {

namespace {

constexpr int kColumns = 44;
constexpr int kHeight = 20;
constexpr objects::Rgba kStone{176, 160, 140, 255};
constexpr objects::Rgba kBrick{186, 98, 70, 255};
constexpr objects::Rgba kTrunk{110, 80, 52, 255};
constexpr objects::Rgba kLeaf{70, 140, 70, 90};

// A post, a wall of two colours, a tree, and an arch: one layer of columns.
objects::StickModel make_model() {
  objects::VoxelGrid voxels({.columns_x = kColumns, .columns_y = 1, .height = kHeight, .voxel_m = 1});
  const auto fill = [&](int x0, int x1, int z0, int z1, const objects::Rgba& colour) {
    for (int x = x0; x < x1; ++x)
      for (int z = z0; z < z1; ++z) voxels.set(x, 0, z, objects::stick_voxel(colour, {-1, 0, 0}));
  };
  fill(3, 4, 0, 6, kStone);
  fill(9, 11, 0, 5, kStone);
  fill(9, 11, 5, 10, kBrick);
  for (int x = 16; x < 25; ++x) {
    for (int z = 6; z < 17; ++z)
      if (std::hypot(x - 20, (z - 11) * 0.9) < 4.6) fill(x, x + 1, z, z + 1, kLeaf);
  }
  fill(20, 21, 0, 8, kTrunk);
  fill(31, 33, 0, 9, kBrick);
  fill(39, 41, 0, 9, kBrick);
  fill(31, 41, 9, 12, kStone);
  return objects::build_sticks(std::move(voxels));
}

std::string colour_text(const objects::Rgba& c) {
  return "rgb(" + std::to_string(c.r) + "," + std::to_string(c.g) + "," + std::to_string(c.b) + ")";
}

}  // namespace

std::string draw_sticks(const Scene&, const std::string& file) {
  const objects::StickModel model = make_model();
  const objects::StickModel::Level& level = model.levels().front();
  Drawing out(720, 360, "Rays that climb sticks");
  out.text({14, 44}, "Uniform, textured and complex sticks from the side, with rays of one column of pixels.");
  const Panel side = square_panel(20, 60, 680, 270, {0.5 * kColumns - 6, 0.5 * kHeight + 1}, kColumns + 14);
  const glm::dvec2 foot = side.at({-14, 0});
  out.rectangle(foot, {side.x_px + side.width_px - foot.x, 5}, {.fill = kSoil});
  const glm::dvec2 cell = side.scale();
  for (int x = 0; x < kColumns; ++x) {
    const objects::StickModel::Stick& stick = level.sticks[level.columns[static_cast<std::size_t>(x)]];
    for (std::uint32_t r = stick.first_run; r < stick.first_run + stick.runs; ++r) {
      const objects::StickModel::Run& run = level.runs[r];
      for (int z = 0; z < run.length; ++z) {
        const objects::StickVoxel& voxel =
            level.voxels[run.first_voxel + (run.is_uniform ? 0U : static_cast<std::uint32_t>(z))];
        const std::string fill = colour_text(voxel.colour);
        out.rectangle(side.at({x, run.begin + z + 1.0}), cell,
                      {.stroke = "#fff", .width_px = 0.5, .fill = fill.c_str()});
      }
    }
  }
  const glm::dvec2 camera{-12, 14};
  out.circle(side.at(camera), 4, {.fill = kInk});
  int hits = 0;
  int layers = 0;
  objects::StickHits found;
  for (double slope = -1.02; slope <= 0.1; slope += slope < -0.45 ? 0.06 : 0.03) {
    const objects::ModelRay ray{{camera.x, 0.5, camera.y}, {1, 0, slope}};
    model.cast(ray, 0, 1e6F, found);
    const double ground = slope < 0 ? -camera.y / slope : 1e9;
    const double end = std::min({found.has_front ? static_cast<double>(found.front.t) : 1e9, ground, 58.0});
    const auto at = [&](double t) { return side.at(camera + t * glm::dvec2(1, slope)); };
    out.line(at(0), at(end), {.stroke = kInk, .width_px = 0.8});
    for (const objects::StickLayer& layer : found.layers) {
      out.line(at(static_cast<double>(layer.t)), at(static_cast<double>(layer.end_t)),
               {.stroke = kGreen, .width_px = 3});
      ++layers;
    }
    if (!found.has_front) continue;
    out.circle(at(static_cast<double>(found.front.t)), 3, {.fill = kRed});
    ++hits;
  }
  out.text(
      {14, 346},
      "Red: opaque voxels that rays end at. Green: stretches of semi-transparent voxels, which are blended.");
  out.write(file);
  return std::to_string(hits) + " rays end at sticks, " + std::to_string(layers) +
         " stretches of semi-transparent voxels";
}

}  // namespace bench
