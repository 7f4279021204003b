#include "vpe/app/report/papers/volume_image.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "vpe/report/value_noise.h"
#include "vpe/voxel/volume/pixel_rays.h"

namespace vpe::app {

namespace {

constexpr int kHillLevels = 64;
constexpr double kLowestHill = 6;
constexpr double kHighestHill = 57;

// Heights of a grid, stretched over most of the levels.
voxel::VolumeHeights hill_heights(int side) {
  std::vector<double> heights;
  for (int j = 0; j < side; ++j) {
    for (int i = 0; i < side; ++i) {
      double height = 0;
      double size = 1;
      double waves = 3.0 / side;
      for (std::uint64_t octave = 0; octave < 8; ++octave) {
        height += size * report::value_noise({i * waves, j * waves, 0.5}, octave);
        size *= 0.48;
        waves *= 2;
      }
      heights.push_back(height);
    }
  }
  const auto [low, high] = std::ranges::minmax(heights);
  voxel::VolumeHeights grid{side, side, {}};
  for (const double height : heights)
    grid.heights.push_back(
        static_cast<float>(kLowestHill + (kHighestHill - kLowestHill) * (height - low) / (high - low)));
  return grid;
}

std::vector<base::Rgb> photograph_of(const voxel::VolumeHeights& grid) {
  std::vector<base::Rgb> colours;
  const glm::dvec3 sun = glm::normalize(glm::dvec3(-1, 1, 1.2));
  const auto height = [&](int i, int j) {
    const int x = std::clamp(i, 0, grid.columns - 1);
    const int y = std::clamp(j, 0, grid.rows - 1);
    return static_cast<double>(
        grid.heights[static_cast<std::size_t>(y) * static_cast<std::size_t>(grid.columns) +
                     static_cast<std::size_t>(x)]);
  };
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const glm::dvec3 normal = glm::normalize(
          glm::dvec3(height(i - 1, j) - height(i + 1, j), height(i, j - 1) - height(i, j + 1), 2));
      const double rise = (height(i, j) - kLowestHill) / (kHighestHill - kLowestHill);
      const double spots = 0.12 * report::value_noise({i / 5.0, j / 5.0, 0.5}, 77);
      const double light = 0.25 + 0.75 * std::max(0.0, glm::dot(normal, sun));
      const auto tone = [&](double low, double high) {
        return static_cast<std::uint8_t>(
            std::lround(std::clamp(light * (low + (high - low) * rise + 255 * spots), 0.0, 255.0)));
      };
      colours.push_back({tone(120, 225), tone(110, 205), tone(80, 180)});
    }
  }
  return colours;
}

// Returns the photograph's colour at a place, bilinear.
base::Rgb colour_at(const PhotographedVolume& scene, double x, double y) {
  const int columns = scene.volume.columns();
  const int i = std::clamp(static_cast<int>(x), 0, columns - 2);
  const int j = std::clamp(static_cast<int>(y), 0, scene.volume.rows() - 2);
  const double u = x - i;
  const double v = y - j;
  const base::Rgb* at =
      scene.photograph.data() + static_cast<std::size_t>(j) * static_cast<std::size_t>(columns) + i;
  const auto channel = [&](std::uint8_t base::Rgb::*c) {
    const double south = at[0].*c + u * (static_cast<double>(at[1].*c) - at[0].*c);
    const double north = at[columns].*c + u * (static_cast<double>(at[columns + 1].*c) - at[columns].*c);
    return static_cast<std::uint8_t>(south + v * (north - south) + 0.5);
  };
  return {channel(&base::Rgb::r), channel(&base::Rgb::g), channel(&base::Rgb::b)};
}

}  // namespace

VolumeImage draw_volume(const PhotographedVolume& scene, const core::View& view,
                        const voxel::VolumeCastOptions& options, base::ThreadPool& pool) {
  constexpr base::Rgb kSky{190, 208, 230};
  const voxel::VolumeRanges found = voxel::cast_volume(scene.volume, scene.cells, view, options, pool);
  VolumeImage image{{found.width, found.height, std::vector<base::Rgb>(found.range.size(), kSky)},
                    found.counts};
  const voxel::PixelRays rays(view);
  pool.run(static_cast<std::size_t>(found.height), [&](std::size_t row) {
    for (int x = 0; x < found.width; ++x) {
      const std::size_t n = row * static_cast<std::size_t>(found.width) + static_cast<std::size_t>(x);
      if (!std::isfinite(found.range[n])) continue;
      const glm::dvec3 at =
          view.camera.position_m + static_cast<double>(found.range[n]) * rays.through(x, static_cast<int>(row));
      image.colours.pixels[n] = colour_at(scene, at.x, at.y);
    }
  });
  return image;
}

PhotographedVolume hills_volume(int side, voxel::VolumeFilter filter) {
  const voxel::VolumeHeights grid = hill_heights(side);
  voxel::TerrainVolume volume = voxel::make_terrain_volume(grid, {.levels = kHillLevels, .filter = filter});
  voxel::BoundaryCells cells(volume);
  return {std::move(volume), std::move(cells), photograph_of(grid)};
}

}  // namespace vpe::app
