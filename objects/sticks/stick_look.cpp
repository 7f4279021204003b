#include "objects/sticks/stick_look.h"

#include <algorithm>
#include <cmath>

namespace objects {

StickLook look_of(const StickModel::Level& level) {
  StickLook look;
  const StickGrid& grid = level.grid;
  const auto height = static_cast<std::size_t>(grid.height);
  std::vector<std::uint8_t> along_x(static_cast<std::size_t>(grid.columns_y) * height, 0);
  std::vector<std::uint8_t> along_y(static_cast<std::size_t>(grid.columns_x) * height, 0);
  double full_columns = 0;
  double opacity = 0;
  double weight = 0;
  for (int y = 0; y < grid.columns_y; ++y) {
    for (int x = 0; x < grid.columns_x; ++x) {
      const auto column =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(grid.columns_x) + static_cast<std::size_t>(x);
      const StickModel::Stick& stick = level.sticks[level.columns[column]];
      if (stick.runs == 0) continue;
      ++full_columns;
      double through = 1;
      for (std::uint32_t r = stick.first_run; r < stick.first_run + stick.runs; ++r) {
        const StickModel::Run& run = level.runs[r];
        for (std::size_t z = 0; z < run.length; ++z) {
          along_x[static_cast<std::size_t>(y) * height + run.begin + z] = 1;
          along_y[static_cast<std::size_t>(x) * height + run.begin + z] = 1;
          const StickVoxel& voxel = level.voxels[run.first_voxel + (run.is_uniform ? 0 : z)];
          const double share = static_cast<double>(voxel.colour.a) / 255;
          look.colour += share * glm::dvec3(voxel.colour.r, voxel.colour.g, voxel.colour.b);
          weight += share;
          through *= 1 - share;
        }
      }
      opacity += 1 - through;
    }
  }
  const double square_m2 = static_cast<double>(grid.voxel_m) * static_cast<double>(grid.voxel_m);
  const auto count = [](const std::vector<std::uint8_t>& seen) {
    return static_cast<double>(std::count(seen.begin(), seen.end(), std::uint8_t{1}));
  };
  look.area_m2 = square_m2 * glm::dvec3(count(along_x), count(along_y), full_columns);
  if (weight > 0) look.colour /= weight;
  look.opacity = full_columns > 0 ? opacity / full_columns : 0;
  return look;
}

}  // namespace objects
