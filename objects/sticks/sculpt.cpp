#include "objects/sticks/sculpt.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "objects/sticks/sculpt_view.h"

namespace objects {

namespace {

constexpr int kMostSculptVoxels = 1024;
constexpr std::size_t kLeastViews = 3;

std::string photo_name(SculptSide side) { return "the photograph from the " + std::string(name_of(side)); }

std::string percent(double share) { return std::to_string(std::lround(100.0 * share)) + " percent"; }

void check_sides(std::span<const SculptView> views) {
  if (views.size() < kLeastViews)
    throw std::runtime_error("sculpting takes at least three photographs, not " + std::to_string(views.size()) +
                             "; add one from another side");
  std::array<bool, 3> is_seen{};
  for (std::size_t n = 0; n < views.size(); ++n) {
    if (views[n].side > SculptSide::kBottom) throw std::runtime_error("a photograph is from an unknown side");
    is_seen[static_cast<std::size_t>(axes_of(views[n].side).depth)] = true;
    for (std::size_t m = 0; m < n; ++m) {
      if (views[m].side == views[n].side)
        throw std::runtime_error("two photographs are from the " + std::string(name_of(views[n].side)) +
                                 "; leave one out");
    }
  }
  if (is_seen[0] + is_seen[1] + is_seen[2] < 2)
    throw std::runtime_error("all photographs look along one axis; add one from another side");
}

void check_pixels(const SculptView& view) {
  const PhotoMask& mask = view.mask;
  const auto pixels =
      static_cast<std::size_t>(std::max(mask.width, 0)) * static_cast<std::size_t>(std::max(mask.height, 0));
  const std::string name = photo_name(view.side);
  if (pixels == 0 || view.image.pixels.size() != pixels || view.image.width != mask.width)
    throw std::runtime_error(name + " has " + std::to_string(view.image.width) + " x " +
                             std::to_string(view.image.height) + " pixels, its mask " +
                             std::to_string(mask.width) + " x " + std::to_string(mask.height) +
                             "; give both the same size");
  if (mask.shows.size() != pixels)
    throw std::runtime_error("the mask of " + name + " has not the size that it states");
  const auto shown = pixels - static_cast<std::size_t>(std::count(mask.shows.begin(), mask.shows.end(), 0));
  if (shown == 0)
    throw std::runtime_error("the mask of " + name + " is empty; check the background's colour or the contour");
  if (shown == pixels)
    throw std::runtime_error(
        "the mask of " + name +
        " is the whole image; check the background's colour, or leave a rim around the object");
}

void check_proportions(const SculptView& view, const glm::dvec3& size_m) {
  const SculptAxes axes = axes_of(view.side);
  const PixelBox box = silhouette_box(view.mask).value_or(PixelBox{0, 0, 1, 1});
  const double is = static_cast<double>(box.width) / box.height;
  const double should = size_m[axes.across] / size_m[axes.up];
  // A pixel more or less is no fault of small pictures.
  const double slack = 1.0 / box.width + 1.0 / box.height;
  const double error = is > should ? is / should - 1.0 : should / is - 1.0;
  if (error <= kMostAspectError + slack) return;
  throw std::runtime_error("what " + photo_name(view.side) + " shows is " + std::to_string(box.width) + " x " +
                           std::to_string(box.height) + " pixels, " + percent(error) + " too " +
                           (is > should ? "wide" : "narrow") + " for the size of the object; at most " +
                           percent(kMostAspectError) + " are allowed, so correct the size or the mask");
}

StickGrid grid_of_size(const SculptOptions& options) {
  const glm::dvec3& size_m = options.size_m;
  const double longest_m = std::max({size_m.x, size_m.y, size_m.z});
  StickGrid grid;
  grid.voxel_m = static_cast<float>(longest_m / options.voxels_longest);
  const auto side = [&](double extent_m) {
    return std::max(1, static_cast<int>(std::lround(extent_m / longest_m * options.voxels_longest)));
  };
  grid.columns_x = side(size_m.x);
  grid.columns_y = side(size_m.y);
  grid.height = side(size_m.z);
  grid.corner_m = {-0.5F * grid.voxel_m * static_cast<float>(grid.columns_x),
                   -0.5F * grid.voxel_m * static_cast<float>(grid.columns_y), 0.0F};
  return grid;
}

// Removes the voxels that a view does not show.
void carve(VoxelGrid& voxels, const ProjectedView& view) {
  const StickGrid& g = voxels.grid();
  if (view.axes().depth == 2) {
    for (int y = 0; y < g.columns_y; ++y) {
      for (int x = 0; x < g.columns_x; ++x) {
        if (view.shows(x, y)) continue;
        const std::span<std::uint64_t> words = voxels.bits(voxels.column(x, y));
        std::fill(words.begin(), words.end(), 0);
      }
    }
    return;
  }
  std::vector<std::uint64_t> heights(voxels.words());
  for (int across = 0; across < view.voxels_across(); ++across) {
    std::fill(heights.begin(), heights.end(), 0);
    for (int z = 0; z < g.height; ++z) {
      if (view.shows(across, z)) heights[static_cast<std::size_t>(z) / 64] |= std::uint64_t{1} << (z % 64);
    }
    const bool is_row = view.axes().across == 1;
    const int depth = is_row ? g.columns_x : g.columns_y;
    for (int n = 0; n < depth; ++n) {
      const std::span<std::uint64_t> words =
          voxels.bits(is_row ? voxels.column(n, across) : voxels.column(across, n));
      for (std::size_t w = 0; w < words.size(); ++w) words[w] &= heights[w];
    }
  }
}

}  // namespace

std::string_view name_of(SculptSide side) {
  switch (side) {
    case SculptSide::kRight: return "right";
    case SculptSide::kLeft: return "left";
    case SculptSide::kFront: return "front";
    case SculptSide::kBack: return "back";
    case SculptSide::kTop: return "top";
    case SculptSide::kBottom: break;
  }
  return "bottom";
}

VoxelGrid sculpt(std::span<const SculptView> views, const SculptOptions& options) {
  for (int k = 0; k < 3; ++k) {
    if (!(options.size_m[k] > 0) || !(options.size_m[k] <= MeshLimits::kMostExtent_m))
      throw std::runtime_error("the width, length and height of the object must be above 0 and at most 1e9 m");
  }
  if (options.voxels_longest < 1 || options.voxels_longest > kMostSculptVoxels)
    throw std::runtime_error("an object gets 1 to " + std::to_string(kMostSculptVoxels) +
                             " voxels along its longest side, not " + std::to_string(options.voxels_longest));
  check_sides(views);
  for (const SculptView& view : views) {
    check_pixels(view);
    check_proportions(view, options.size_m);
  }
  VoxelGrid voxels(grid_of_size(options));
  const StickGrid& g = voxels.grid();
  std::vector<ProjectedView> projected;
  for (const SculptView& view : views)
    projected.emplace_back(view, glm::ivec3(g.columns_x, g.columns_y, g.height));
  for (std::size_t column = 0; column < voxels.columns(); ++column) {
    const std::span<std::uint64_t> words = voxels.bits(column);
    std::fill(words.begin(), words.end(), ~std::uint64_t{0});
    if (g.height % 64 != 0) words.back() = (std::uint64_t{1} << (g.height % 64)) - 1;
  }
  for (const ProjectedView& view : projected) carve(voxels, view);
  colour_surface(voxels, projected);
  if (voxels.coloured().empty())
    throw std::runtime_error("no voxel lies in all silhouettes; check the sides of the photographs");
  return voxels;
}

}  // namespace objects
