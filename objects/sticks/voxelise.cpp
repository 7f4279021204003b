#include "objects/sticks/voxelise.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>

#include "objects/model/surface_sample.h"
#include "objects/sticks/column_winding.h"
#include "objects/sticks/flood_fill.h"
#include "objects/sticks/grid_around.h"
#include "objects/sticks/outer_voxels.h"
#include "objects/sticks/place_index.h"
#include "objects/sticks/triangle_voxels.h"

namespace objects {

namespace {

constexpr double kLeastArea = 1e-6;  // of a triangle that only touches a voxel

StickGrid grid_around_mesh(const Mesh& mesh, int voxels_longest) {
  glm::dvec3 low(std::numeric_limits<double>::infinity());
  glm::dvec3 high(-low);
  for (const glm::uvec3& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const glm::dvec3 p(mesh.positions_m[t[k]]);
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
  }
  return grid_around(low, high, voxels_longest);
}

// What triangles add to a voxel.
struct SurfaceSum {
  double area = 0;
  double visible = 0;  // area times opacity
  glm::dvec3 colour{0, 0, 0};
  glm::dvec3 normal{0, 0, 0};
  double largest = 0;
  glm::vec3 largest_normal{0, 0, 1};
  bool is_opaque = false;
  glm::dvec3 to_centre{0, 0, 0};  // from the nearest opaque place, in voxels

  void add(double part, const glm::vec4& c, const glm::vec3& n) {
    const double weight = part * static_cast<double>(c.w) / 255.0;
    area += part;
    visible += weight;
    colour += weight * glm::dvec3(c);
    normal += weight * glm::dvec3(n);
    if (weight > largest) {
      largest = weight;
      largest_normal = n;
    }
  }

  StickVoxel voxel() const {
    const auto byte = [&](double sum) {
      return static_cast<std::uint8_t>(std::clamp(std::lround(sum / visible), 0L, 255L));
    };
    const auto alpha = is_opaque ? 255 : std::clamp(std::lround(255.0 * visible / area), 1L, 254L);
    const bool cancels = glm::length(normal) < 0.2 * visible;
    return stick_voxel({byte(colour.x), byte(colour.y), byte(colour.z), static_cast<std::uint8_t>(alpha)},
                       cancels ? largest_normal : glm::vec3(normal / visible));
  }
};

class SurfaceVoxels {
 public:
  SurfaceVoxels(const Mesh& mesh, const std::vector<TexturePyramid>& textures, bool is_tight, VoxelGrid& out)
      : mesh_(mesh), textures_(textures), out_(out), is_tight_(is_tight), winding_(out.grid()) {}

  void add(std::uint32_t triangle) {
    const StickGrid& g = out_.grid();
    VoxelTriangle t;
    for (int k = 0; k < 3; ++k)
      t[static_cast<std::size_t>(k)] =
          (glm::dvec3(mesh_.positions_m[mesh_.triangles[triangle][k]]) - glm::dvec3(g.corner_m)) /
          static_cast<double>(g.voxel_m);
    if (is_tight_) winding_.add(t);
    touched_.clear();
    append_voxels(t, {g.columns_x, g.columns_y, g.height}, touched_);
    for (const glm::ivec3& at : touched_) {
      const std::array<double, 2> near = nearest_weights(t, glm::dvec3(at) + 0.5);
      const glm::vec2 weights(static_cast<float>(near[0]), static_cast<float>(near[1]));
      const glm::vec4 colour = surface_colour(mesh_, textures_, triangle, weights, g.voxel_m);
      if (colour.w < 0.5F) continue;
      const double area = area_in_voxel(t, at);
      const std::uint32_t number = index_.add(out_.place(at.x, at.y, at.z));
      if (number == sums_.size()) sums_.emplace_back();
      SurfaceSum& sum = sums_[number];
      sum.add(std::max(area, kLeastArea), colour, surface_normal(mesh_, triangle, weights));
      if (colour.w < 254.5F) continue;
      const glm::dvec3 to_centre =
          glm::dvec3(at) + 0.5 - t[0] - near[0] * (t[1] - t[0]) - near[1] * (t[2] - t[0]);
      if (!sum.is_opaque || glm::dot(to_centre, to_centre) < glm::dot(sum.to_centre, sum.to_centre))
        sum.to_centre = to_centre;
      sum.is_opaque = true;
    }
  }

  // Stores the voxels and what they enclose.
  void store() {
    SurfaceSum all;
    for (std::size_t n = 0; n < sums_.size(); ++n) {
      const glm::ivec3 at = out_.voxel_of(index_.places()[n]);
      if (sums_[n].is_opaque) out_.set(at.x, at.y, at.z);
      all.visible += sums_[n].visible;
      all.colour += sums_[n].colour;
    }
    all.is_opaque = true;
    if (all.visible > 0) out_.filling = all.voxel();
    fill_inside(out_);
    if (is_tight_) tighten();
    for (std::size_t n = 0; n < sums_.size(); ++n) {
      const glm::ivec3 at = out_.voxel_of(index_.places()[n]);
      if (sums_[n].is_opaque == out_.is_set(at.x, at.y, at.z)) out_.set(at.x, at.y, at.z, sums_[n].voxel());
    }
    out_.tidy();
  }

 private:
  // Removes voxels that stick out; those of the inside that come to light take their colours.
  void tighten() {
    std::vector<glm::vec3> to_centres;
    to_centres.reserve(sums_.size());
    for (const SurfaceSum& sum : sums_) to_centres.emplace_back(sum.to_centre);
    const std::vector<std::uint8_t> marks = outer_voxels(winding_.inside(), index_, to_centres);
    for (std::size_t n = 0; n < sums_.size(); ++n) {
      const glm::ivec3 at = out_.voxel_of(index_.places()[n]);
      if (marks[n] != 0) out_.clear(at.x, at.y, at.z);
    }
    PlaceIndex shown;
    for (std::size_t n = 0; n < sums_.size(); ++n) {
      if (marks[n] == 0) continue;
      const glm::ivec3 at = out_.voxel_of(index_.places()[n]);
      for (int side = 0; side < 6; ++side) {
        glm::ivec3 beside = at;
        beside[side / 2] += side % 2 == 0 ? -1 : 1;
        if (!out_.is_set(beside.x, beside.y, beside.z)) continue;
        const std::uint64_t place = out_.place(beside.x, beside.y, beside.z);
        if (index_.find(place) != PlaceIndex::kNone || shown.find(place) != PlaceIndex::kNone) continue;
        shown.add(place);
        out_.add_colour(place, sums_[n].voxel());
      }
    }
  }

  const Mesh& mesh_;
  const std::vector<TexturePyramid>& textures_;
  VoxelGrid& out_;
  bool is_tight_;
  ColumnWinding winding_;
  PlaceIndex index_;
  std::vector<SurfaceSum> sums_;
  std::vector<glm::ivec3> touched_;
};

}  // namespace

VoxelGrid voxelise(const Mesh& mesh, const std::vector<TexturePyramid>& textures,
                   const VoxeliseOptions& options) {
  if (options.voxels_longest < 1 || options.voxels_longest > kMostVoxelsLongest)
    throw std::invalid_argument("a mesh gets 1 to " + std::to_string(kMostVoxelsLongest) +
                                " voxels along its longest side, not " +
                                std::to_string(options.voxels_longest));
  VoxelGrid out(grid_around_mesh(mesh, options.voxels_longest));
  SurfaceVoxels surface(mesh, textures, options.is_tight, out);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) surface.add(t);
  surface.store();
  return out;
}

}  // namespace objects
