#include "vpe/voxel/volume/terrain_volume.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "vpe/voxel/volume/cube_share.h"

namespace vpe::voxel {

namespace {

constexpr double kFull = 255;

void require_volume(bool is_met, const std::string& problem) {
  if (!is_met) throw std::invalid_argument("a terrain volume: " + problem);
}

void check_spec(const VolumeHeights& heights, const VolumeSpec& spec) {
  require_volume(
      spec.levels >= 3 && spec.levels <= kMostVolumeLevels,
      "expected 3 to " + std::to_string(kMostVolumeLevels) + " levels, found " + std::to_string(spec.levels));
  require_volume(spec.sigma >= 0.5 && spec.sigma <= 4, "expected a sigma of 0.5 to 4 voxels");
  require_volume(spec.box_radius >= 1 && spec.box_radius <= 4, "expected a radius of the box of 1 to 4 voxels");
  require_volume(heights.columns >= 2 && heights.rows >= 2 && heights.columns <= kMostVolumeSide &&
                     heights.rows <= kMostVolumeSide,
                 "expected 2 to " + std::to_string(kMostVolumeSide) + " columns and rows");
  require_volume(heights.heights.size() ==
                     static_cast<std::size_t>(heights.columns) * static_cast<std::size_t>(heights.rows),
                 "the heights must fill the grid");
  require_volume(
      std::all_of(heights.heights.begin(), heights.heights.end(), [](float h) { return std::isfinite(h); }),
      "a height is not finite");
}

// The plane of the ground at a post: z = height + x_slope (x - i) + y_slope (y - j).
struct LocalPlane {
  double height = 0;
  double x_slope = 0;
  double y_slope = 0;
};

LocalPlane plane_at(const VolumeHeights& grid, int i, int j) {
  const auto height = [&](int column, int row) {
    return static_cast<double>(
        grid.heights[static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.columns) +
                     static_cast<std::size_t>(column)]);
  };
  const int west = std::max(i - 1, 0);
  const int east = std::min(i + 1, grid.columns - 1);
  const int south = std::max(j - 1, 0);
  const int north = std::min(j + 1, grid.rows - 1);
  return {height(i, j), (height(east, j) - height(west, j)) / (east - west),
          (height(i, north) - height(i, south)) / (north - south)};
}

// Returns the density of a voxel before smoothing, 0 to 1.
double first_density(const LocalPlane& plane, int k, const VolumeSpec& spec) {
  if (spec.filter == VolumeFilter::kNone) return k < plane.height ? 1 : 0;
  const double length = std::sqrt(1 + plane.x_slope * plane.x_slope + plane.y_slope * plane.y_slope);
  const double depth = (plane.height - k) / length;
  if (spec.filter == VolumeFilter::kBox) return std::clamp(0.5 + depth / (2 * spec.box_radius), 0.0, 1.0);
  return cube_share_below({-plane.x_slope / length, -plane.y_slope / length, 1 / length}, depth);
}

// Smooths along one axis: `count` values that lie `stride` apart, repeated for `lines` of them. Beyond an end its value goes on.
void smooth_line(std::vector<float>& values, std::size_t first, std::size_t stride, int count,
                 const std::vector<double>& kernel, std::vector<float>& line) {
  const int reach = static_cast<int>(kernel.size()) - 1;
  line.resize(static_cast<std::size_t>(count + 2 * reach));
  for (int n = -reach; n < count + reach; ++n) {
    const auto from = static_cast<std::size_t>(std::clamp(n, 0, count - 1));
    line[static_cast<std::size_t>(n + reach)] = values[first + from * stride];
  }
  for (int n = 0; n < count; ++n) {
    const float* at = line.data() + n + reach;
    double sum = kernel[0] * static_cast<double>(*at);
    for (int k = 1; k <= reach; ++k)
      sum += kernel[static_cast<std::size_t>(k)] * (static_cast<double>(at[k]) + static_cast<double>(at[-k]));
    values[first + static_cast<std::size_t>(n) * stride] = static_cast<float>(sum);
  }
}

// Returns half of a Gaussian from its middle; the whole sums up to 1.
std::vector<double> gaussian(double sigma) {
  constexpr double kReach = 4;  // of sigma
  std::vector<double> kernel(static_cast<std::size_t>(std::ceil(kReach * sigma)) + 1);
  double sum = 0;
  for (std::size_t n = 0; n < kernel.size(); ++n) {
    const double x = static_cast<double>(n) / sigma;
    kernel[n] = std::exp(-0.5 * x * x);
    sum += n == 0 ? kernel[n] : 2 * kernel[n];
  }
  for (double& weight : kernel) weight /= sum;
  return kernel;
}

void smooth(std::vector<float>& values, const VolumeHeights& grid, const VolumeSpec& spec) {
  const std::vector<double> kernel = gaussian(spec.sigma);
  std::vector<float> line;
  const auto columns = static_cast<std::size_t>(grid.columns);
  const auto rows = static_cast<std::size_t>(grid.rows);
  const auto levels = static_cast<std::size_t>(spec.levels);
  for (std::size_t n = 0; n < columns * rows; ++n)
    smooth_line(values, n * levels, 1, spec.levels, kernel, line);
  for (std::size_t j = 0; j < rows; ++j)
    for (std::size_t k = 0; k < levels; ++k)
      smooth_line(values, j * columns * levels + k, levels, grid.columns, kernel, line);
  for (std::size_t i = 0; i < columns; ++i)
    for (std::size_t k = 0; k < levels; ++k)
      smooth_line(values, i * levels + k, columns * levels, grid.rows, kernel, line);
}

}  // namespace

TerrainVolume::TerrainVolume(int columns, int rows, int levels, std::uint8_t threshold,
                             std::vector<std::uint8_t> densities)
    : columns_(columns), rows_(rows), levels_(levels), threshold_(threshold), densities_(std::move(densities)) {
  const auto is_side = [](int n, int most) { return n >= 2 && n <= most; };
  require_volume(
      is_side(columns, kMostVolumeSide) && is_side(rows, kMostVolumeSide) && is_side(levels, kMostVolumeLevels),
      "expected 2 to " + std::to_string(kMostVolumeSide) + " columns and rows and 2 to " +
          std::to_string(kMostVolumeLevels) + " levels");
  require_volume(densities_.size() == static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows) *
                                          static_cast<std::size_t>(levels),
                 "the densities must fill the grid");
}

double TerrainVolume::density(const glm::dvec3& at) const {
  const int i = std::clamp(static_cast<int>(at.x), 0, columns_ - 2);
  const int j = std::clamp(static_cast<int>(at.y), 0, rows_ - 2);
  const int k = std::clamp(static_cast<int>(at.z), 0, levels_ - 2);
  const double x = at.x - i;
  const double y = at.y - j;
  const double z = at.z - k;
  const auto along_z = [&](const std::uint8_t* voxels) {
    return voxels[k] + z * (static_cast<double>(voxels[k + 1]) - voxels[k]);
  };
  const double south = along_z(column(i, j)) * (1 - x) + along_z(column(i + 1, j)) * x;
  const double north = along_z(column(i, j + 1)) * (1 - x) + along_z(column(i + 1, j + 1)) * x;
  return south * (1 - y) + north * y;
}

TerrainVolume make_terrain_volume(const VolumeHeights& heights, const VolumeSpec& spec) {
  check_spec(heights, spec);
  std::vector<float> shares;
  shares.reserve(heights.heights.size() * static_cast<std::size_t>(spec.levels));
  for (int j = 0; j < heights.rows; ++j) {
    for (int i = 0; i < heights.columns; ++i) {
      const LocalPlane plane = plane_at(heights, i, j);
      for (int k = 0; k < spec.levels; ++k) shares.push_back(static_cast<float>(first_density(plane, k, spec)));
    }
  }
  if (spec.filter == VolumeFilter::kGaussian) smooth(shares, heights, spec);
  std::vector<std::uint8_t> densities;
  densities.reserve(shares.size());
  for (const float share : shares)
    densities.push_back(
        static_cast<std::uint8_t>(std::lround(kFull * std::clamp(static_cast<double>(share), 0.0, 1.0))));
  TerrainVolume volume(heights.columns, heights.rows, spec.levels, spec.threshold, std::move(densities));
  for (int j = 0; j < heights.rows; ++j) {
    for (int i = 0; i < heights.columns; ++i) {
      require_volume(volume.is_ground(i, j, 0) && !volume.is_ground(i, j, spec.levels - 1),
                     "column " + std::to_string(i) + ", row " + std::to_string(j) +
                         " would be all ground or all air; keep heights away from 0 and " +
                         std::to_string(spec.levels - 1));
    }
  }
  return volume;
}

}  // namespace vpe::voxel
