#include "objects/points/point_voxels.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numeric>

#include "objects/sticks/place_index.h"

namespace objects {

namespace {

// Parts of a voxel, and of a normal, that sums count. 50 million times these fit into 64 bits.
constexpr double kPlaceParts = 1 << 20;
constexpr double kNormalParts = 1 << 20;
constexpr double kLeastMeanNormal = 0.2;  // as in voxelise()

glm::dvec3 in_voxels(const StickGrid& grid, const glm::vec3& point_m) {
  return (glm::dvec3(point_m) - glm::dvec3(grid.corner_m)) / static_cast<double>(grid.voxel_m);
}

}  // namespace

glm::ivec3 voxel_of_point(const StickGrid& grid, const glm::vec3& point_m) {
  const glm::dvec3 last(grid.columns_x - 1, grid.columns_y - 1, grid.height - 1);
  return glm::ivec3(glm::clamp(glm::floor(in_voxels(grid, point_m)), glm::dvec3(0), last));
}

PointVoxels::PointVoxels(const Mesh& points, const VoxelGrid& grid)
    : has_colours_(!points.colours.empty()), height_(static_cast<std::uint64_t>(grid.grid().height)) {
  add_points(points, grid);
  first_.assign(grid.columns() + 1, 0);
  for (const std::uint64_t place : places_) ++first_[place / height_ + 1];
  for (std::size_t n = 1; n < first_.size(); ++n) first_[n] += first_[n - 1];
  middles_.reserve(sums_.size());
  for (std::size_t n = 0; n < sums_.size(); ++n) {
    glm::dvec3& middle = middles_.emplace_back(grid.voxel_of(places_[n]));
    for (std::size_t k = 0; k < 3; ++k)
      middle[static_cast<int>(k)] += static_cast<double>(sums_[n].place[k]) / kPlaceParts / sums_[n].points;
  }
}

void PointVoxels::add_points(const Mesh& points, const VoxelGrid& grid) {
  PlaceIndex index;
  std::vector<Sum> sums;
  for (std::size_t n = 0; n < points.positions_m.size(); ++n) {
    const glm::vec3& p = points.positions_m[n];
    const glm::ivec3 at = voxel_of_point(grid.grid(), p);
    const std::uint32_t number = index.add(grid.place(at.x, at.y, at.z));
    if (number == sums.size()) sums.emplace_back();
    Sum& sum = sums[number];
    ++sum.points;
    const glm::dvec3 within = glm::clamp(in_voxels(grid.grid(), p) - glm::dvec3(at), 0.0, 1.0);
    for (std::size_t k = 0; k < 3; ++k)
      sum.place[k] += static_cast<std::uint64_t>(std::llround(kPlaceParts * within[static_cast<int>(k)]));
    if (has_colours_) {
      const Rgba& c = points.colours[n];
      sum.colour[0] += c.r;
      sum.colour[1] += c.g;
      sum.colour[2] += c.b;
    }
    if (points.normals.empty()) continue;
    const double length = glm::length(glm::dvec3(points.normals[n]));
    if (!(length > 0)) continue;
    ++sum.normals;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto part = static_cast<double>(points.normals[n][static_cast<int>(k)]) / length;
      sum.normal[k] += std::llround(kNormalParts * part);
    }
  }
  std::vector<std::uint32_t> order(sums.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return index.places()[a] < index.places()[b]; });
  places_.reserve(order.size());
  sums_.reserve(order.size());
  for (const std::uint32_t n : order) {
    places_.push_back(index.places()[n]);
    sums_.push_back(sums[n]);
  }
}

Rgba PointVoxels::colour_of(const Sum& sum) const {
  if (!has_colours_) return {160, 160, 160, 255};
  const std::uint64_t count = sum.points;
  const auto mean = [&](std::uint64_t channel) {
    return static_cast<std::uint8_t>((2 * channel + count) / (2 * count));
  };
  return {mean(sum.colour[0]), mean(sum.colour[1]), mean(sum.colour[2]), 255};
}

Rgba PointVoxels::colour(std::uint32_t number) const { return colour_of(sums_[number]); }

glm::vec3 PointVoxels::normal(std::uint32_t number) const {
  const Sum& sum = sums_[number];
  glm::dvec3 mean(0);
  if (sum.normals == 0) return glm::vec3(mean);
  for (std::size_t k = 0; k < 3; ++k)
    mean[static_cast<int>(k)] = static_cast<double>(sum.normal[k]) / kNormalParts / sum.normals;
  const double length = glm::length(mean);
  return length < kLeastMeanNormal ? glm::vec3(0) : glm::vec3(mean / length);
}

Rgba PointVoxels::mean_colour() const {
  Sum all;
  for (const Sum& sum : sums_) {
    all.points += sum.points;
    for (std::size_t k = 0; k < 3; ++k) all.colour[k] += sum.colour[k];
  }
  return colour_of(all);
}

}  // namespace objects
