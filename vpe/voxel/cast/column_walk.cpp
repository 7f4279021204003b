#include "vpe/voxel/cast/column_walk.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "mars/geodesy/cube.h"
#include "vpe/voxel/columns/discrete.h"

namespace vpe::voxel {

namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

// Bounds of a quadtree cell in the chart of its face.
struct Cell {
  double u0;
  double u1;
  double v0;
  double v1;
};

}  // namespace

// Leads one group over one face after the other.
class GroupWalk : public HeightGridSource {
 public:
  GroupWalk(const ColumnWalk& walk, const Rows& rows, ThreadLocalTiles& tiles, ColumnGroup& group)
      : walk_(walk), tree_(walk.tree_), rows_(rows), tiles_(tiles), group_(group) {}

  void go(const glm::dvec3* azimuth) {
    update_least_slope(rows_, group_);
    // The face below the camera comes first; the others follow by their angle to it (docs/design/rays.md).
    std::array<int, mars::kFaces> order{};
    for (int f = 0; f < mars::kFaces; ++f) order[static_cast<std::size_t>(f)] = f;
    const auto facing = [&](int f) {
      return glm::dot(walk_.camera_.up, mars::face_axes(static_cast<mars::Face>(f)).out);
    };
    std::sort(order.begin(), order.end(), [&](int a, int b) { return facing(a) > facing(b); });
    for (int f : order) {
      const auto root = static_cast<lod::TileTree::Index>(f);
      if (done() || hidden(root)) continue;
      set_face(azimuth, static_cast<mars::Face>(f));
      visit(root, root, {-1, 1, -1, 1});
    }
  }

  const HeightGridLines<float>& lines(LineFamily family) override {
    return tiles_.grids(tile_, posts_of_, family)->lines(grid_i_, grid_j_);
  }
  const HeightGridLines<double>& exact_lines(LineFamily family) override {
    return tiles_.exact_grids(tile_, posts_of_, family)->lines(grid_i_, grid_j_);
  }

 private:
  bool done() const { return !(group_.least_slope < kInfinite); }
  bool hidden(lod::TileTree::Index tile) const {
    return static_cast<double>(walk_.slope_bound(tile)) < group_.least_slope;
  }

  void set_face(const glm::dvec3* azimuth, mars::Face face) {
    const mars::FaceAxes& axes = mars::face_axes(face);
    const auto in_face = [&](const glm::dvec3& x) {
      return glm::dvec3(glm::dot(x, axes.right), glm::dot(x, axes.up), glm::dot(x, axes.out));
    };
    up_ = in_face(walk_.camera_.up);
    for (int lane = 0; lane < column_lanes(); ++lane) {
      const glm::dvec3 a = in_face(azimuth[std::min(lane, group_.columns - 1)]);
      const glm::dvec3 n = glm::cross(a, up_);
      for (int k = 0; k < 3; ++k) {
        group_.azimuth[k][lane] = a[k];
        group_.normal[k][lane] = n[k];
      }
    }
    // The wedge between the first and the last column, if they form one.
    const glm::dvec3 first = in_face(azimuth[0]);
    const glm::dvec3 last = in_face(azimuth[group_.columns - 1]);
    const glm::dvec3 middle = in_face(azimuth[group_.columns / 2]);
    side_[0] = glm::cross(first, up_);
    side_[1] = -glm::cross(last, up_);
    if (glm::dot(side_[0], last) < 0) {
      side_[0] = -side_[0];
      side_[1] = -side_[1];
    }
    middle_ = middle;
    wedge_ = glm::dot(first, last) > 0.5 && glm::dot(first, middle) > 0.5;
  }

  bool outside(const Cell& cell) const {
    if (!wedge_) return false;
    const double u = 0.5 * (cell.u0 + cell.u1);
    const double v = 0.5 * (cell.v0 + cell.v1);
    const double du = cell.u1 - u;
    const double dv = cell.v1 - v;
    constexpr double kSlack = 1e-12;
    for (const glm::dvec3& n : side_) {
      if (n.x * u + n.y * v + n.z + std::abs(n.x) * du + std::abs(n.y) * dv < -kSlack) return true;
    }
    return false;
  }

  // Returns true if no column meets the cell in front of the camera. Points in front of any column of the wedge are in front of the
  // middle one.
  bool behind(const Cell& cell) const {
    const double u = middle_.x > 0 ? cell.u1 : cell.u0;
    const double v = middle_.y > 0 ? cell.v1 : cell.v0;
    constexpr double kSlack = 1e-12;
    return wedge_ && middle_.x * u + middle_.y * v + middle_.z < -kSlack;
  }

  // Visits the quarters of a cell from near to far: at each middle line the side of the camera's foot is
  // nearer.
  template <typename Visit>
  void quarters(const Cell& cell, double um, double vm, Visit&& visit_quarter) {
    const bool east_first = up_.x - um * up_.z >= 0;
    const bool north_first = up_.y - vm * up_.z >= 0;
    for (int q = 0; q < 4; ++q) {
      const bool east = ((q & 1) != 0) != east_first;
      const bool north = ((q & 2) != 0) != north_first;
      visit_quarter(east, north,
                    Cell{east ? um : cell.u0, east ? cell.u1 : um, north ? vm : cell.v0, north ? cell.v1 : vm});
    }
  }

  void visit(lod::TileTree::Index tile, lod::TileTree::Index parent, const Cell& cell) {
    if (done() || hidden(tile) || outside(cell)) return;
    const lod::TileInfo& info = tree_[tile];
    if (walk_.ends_at(tile)) {
      tile_ = tile;
      posts_of_ = walk_.has_parents_posts(tile) ? parent : tile;
      intervals_ = walk_.intervals(tile);
      walk_.mark_used(tile);
      const int per_side = grids_per_side(info.key.level, tree_.shape().intervals());
      visit_grids(cell, 0, 0, per_side, per_side);
      return;
    }
    const lod::TileTree::Index first = tree_.first_child(tile);
    const double um = walk_.middle_line(info.key.level, info.key.i);
    const double vm = walk_.middle_line(info.key.level, info.key.j);
    quarters(cell, um, vm, [&](bool east, bool north, const Cell& part) {
      visit(first + (east ? 1U : 0U) + (north ? 2U : 0U), tile, part);
    });
  }

  // Visits grids [i, i + size) x [j, j + size) of the current tile, which is not outside and not hidden.
  void visit_grids(const Cell& cell, int i, int j, int size, int per_side) {
    if (behind(cell)) return;
    if (size == 1) {
      grid_i_ = i;
      grid_j_ = j;
      const int n = intervals_ / per_side;
      const HeightGridFrame frame{n, cell.u0, (cell.u1 - cell.u0) / n, cell.v0, (cell.v1 - cell.v0) / n};
      if (walk_.rule_.is_discrete) {
        walk_grid_discretely(frame, *this, walk_.camera_, up_, rows_, walk_.blend_from_m(tile_), group_);
      } else {
        walk_grid(frame, *this, walk_.camera_, up_, rows_, group_);
      }
      update_least_slope(rows_, group_);
      return;
    }
    const lod::TileKey& key = tree_[tile_].key;
    const int half = size / 2;
    const int grids_level = key.level + static_cast<int>(std::lround(std::log2(per_side)));
    const double um = mars::face_line(std::int64_t{key.i} * per_side + i + half, grids_level);
    const double vm = mars::face_line(std::int64_t{key.j} * per_side + j + half, grids_level);
    quarters(cell, um, vm, [&](bool east, bool north, const Cell& part) {
      if (done() || hidden(tile_) || outside(part)) return;
      visit_grids(part, east ? i + half : i, north ? j + half : j, half, per_side);
    });
  }

  const ColumnWalk& walk_;
  const lod::TileTree& tree_;
  const Rows& rows_;
  ThreadLocalTiles& tiles_;
  ColumnGroup& group_;
  glm::dvec3 up_{0, 0, 1};
  glm::dvec3 side_[2]{};
  glm::dvec3 middle_{};
  bool wedge_ = false;
  lod::TileTree::Index tile_ = 0;
  lod::TileTree::Index posts_of_ = 0;
  int intervals_ = 0;
  int grid_i_ = 0;
  int grid_j_ = 0;
};

void ColumnWalk::cast(const glm::dvec3* azimuth, const Rows& rows, ThreadLocalTiles& tiles,
                      ColumnGroup& group) const {
  GroupWalk(*this, rows, tiles, group).go(azimuth);
}

}  // namespace vpe::voxel
