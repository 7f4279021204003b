#include "paging/surface/distance.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <queue>
#include <vector>

namespace paging {

namespace {

// Returns the squared distance of a point from a triangle. The regions of its corners, edges and inside are told apart by
// projections on the edges.
double squared_distance(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const auto to_edge = [&p](const glm::dvec3& from, const glm::dvec3& to) {
    const glm::dvec3 edge = to - from;
    const double length2 = glm::dot(edge, edge);
    const double share = length2 > 0 ? std::clamp(glm::dot(p - from, edge) / length2, 0.0, 1.0) : 0.0;
    const glm::dvec3 away = p - (from + share * edge);
    return glm::dot(away, away);
  };
  const glm::dvec3 normal = glm::cross(b - a, c - a);
  const double area2 = glm::dot(normal, normal);
  if (area2 > 0) {
    const auto is_within = [&](const glm::dvec3& from, const glm::dvec3& to) {
      return glm::dot(glm::cross(to - from, p - from), normal) >= 0;
    };
    if (is_within(a, b) && is_within(b, c) && is_within(c, a)) {
      const double height = glm::dot(p - a, normal);
      return height * height / area2;
    }
  }
  return std::min({to_edge(a, b), to_edge(b, c), to_edge(c, a)});
}

// Holds a piece of the surface and a bound of its distance: a tile, a block of a finest tile's cells, or one cell, whose
// distance is exact.
struct Piece {
  double distance_m = 0;
  lod::TileTree::Index index = 0;                // of the tile
  std::shared_ptr<const SurfaceTile> tile = {};  // null: the whole tile
  int b = 0;                                     // the block has 2^b x 2^b cells
  int i = 0;
  int j = 0;
  bool is_exact = false;

  bool operator<(const Piece& other) const { return distance_m > other.distance_m; }  // the nearest first
};

class Search {
 public:
  Search(const Surface& surface, const glm::dvec3& place_m, double exaggeration)
      : surface_(surface),
        tree_(surface.planet().tree()),
        place_(place_m),
        place_radius_m_(glm::length(place_m)),
        up_(place_m / place_radius_m_),
        exaggeration_(exaggeration) {
    for (int face = 0; face < mars::kFaces; ++face) add_tile(static_cast<lod::TileTree::Index>(face));
  }

  // Opens the nearest piece again and again, until that is a cell.
  double run() {
    while (true) {
      const Piece piece = pieces_.top();
      pieces_.pop();
      if (piece.is_exact) return piece.distance_m;
      open(piece);
    }
  }

 private:
  double radius_m(double height_m) const { return surface_.planet_radius_m() + exaggeration_ * height_m; }

  // Returns the least distance to a point at an angle of at least `angle_rad` from the place, and at most `top_m` from the
  // planet's centre.
  double bound_m(double angle_rad, double top_m) const {
    if (angle_rad >= 0.5 * mars::kPi) return place_radius_m_;
    if (place_radius_m_ * std::cos(angle_rad) <= top_m)
      return place_radius_m_ * std::sin(std::max(angle_rad, 0.0));
    const double half = std::sin(0.5 * std::max(angle_rad, 0.0));
    return std::sqrt((place_radius_m_ - top_m) * (place_radius_m_ - top_m) +
                     4 * place_radius_m_ * top_m * half * half);
  }

  void add_tile(lod::TileTree::Index index) {
    const lod::TileInfo& info = tree_[index];
    const mars::Cap cap = lod::bounding_cap(info.key);
    Piece piece;
    piece.distance_m =
        bound_m(mars::angle_between_rad(up_, cap.centre) - cap.radius_rad, radius_m(info.max_height_m));
    piece.index = index;
    pieces_.push(std::move(piece));
  }

  glm::dvec3 direction(const Piece& of, int i, int j) const {
    return mars::chart_direction(tree_[of.index].key.face, of.tile->lines.u[static_cast<std::size_t>(i)],
                                 of.tile->lines.v[static_cast<std::size_t>(j)]);
  }
  glm::dvec3 post(const Piece& of, int i, int j) const {
    return direction(of, i, j) * radius_m(of.tile->data.posts.at(i, j));
  }

  void add_block(const Piece& of, int b, int i, int j) {
    Piece piece = of;
    piece.b = b;
    piece.i = i;
    piece.j = j;
    if (b == 0) {
      const glm::dvec3 low = post(of, i, j);
      const glm::dvec3 high = post(of, i + 1, j + 1);
      piece.distance_m = std::sqrt(std::min(squared_distance(place_, low, post(of, i + 1, j), high),
                                            squared_distance(place_, low, high, post(of, i, j + 1))));
      piece.is_exact = true;
    } else {
      const int n = 1 << b;
      const int half = n / 2;
      const glm::dvec3 middle = direction(of, i * n + half, j * n + half);
      double reach_rad = 0;
      for (const int y : {j * n, (j + 1) * n})
        for (const int x : {i * n, (i + 1) * n})
          reach_rad = std::max(reach_rad, mars::angle_between_rad(middle, direction(of, x, y)));
      const SurfaceTile& tile = *of.tile;
      const int side = tile.data.posts.intervals >> b;
      const float top_m =
          tile.block_max[static_cast<std::size_t>(b - 1)][static_cast<std::size_t>(j * side + i)];
      piece.distance_m =
          bound_m(mars::angle_between_rad(up_, middle) - reach_rad, radius_m(static_cast<double>(top_m)));
    }
    pieces_.push(std::move(piece));
  }

  void open(const Piece& piece) {
    if (piece.tile != nullptr) {
      for (const int y : {0, 1})
        for (const int x : {0, 1}) add_block(piece, piece.b - 1, 2 * piece.i + x, 2 * piece.j + y);
      return;
    }
    const lod::TileInfo& info = tree_[piece.index];
    if (info.has_children) {
      const lod::TileTree::Index first = tree_.first_child(piece.index);
      for (lod::TileTree::Index child = 0; child < 4; ++child) add_tile(first + child);
      return;
    }
    Piece whole;
    whole.index = piece.index;
    whole.tile = surface_.tile(info.key, exaggeration_);
    add_block(whole, static_cast<int>(whole.tile->block_max.size()), 0, 0);
  }

  const Surface& surface_;
  const lod::TileTree& tree_;
  glm::dvec3 place_;
  double place_radius_m_;
  glm::dvec3 up_;
  double exaggeration_;
  std::priority_queue<Piece> pieces_;
};

}  // namespace

double distance_to_ground_m(const Surface& surface, const glm::dvec3& place_m, double exaggeration) {
  if (glm::length(place_m) == 0 || surface.is_below(place_m, exaggeration)) return 0;
  return Search(surface, place_m, exaggeration).run();
}

}  // namespace paging
