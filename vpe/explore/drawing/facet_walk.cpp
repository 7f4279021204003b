#include "vpe/explore/drawing/facet_walk.h"

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "lod/tree/posts.h"
#include "mars/geodesy/cube.h"

namespace vpe::explore {

namespace {

using Outline = std::vector<glm::dvec2>;  // in a chart

struct ChartBox {
  glm::dvec2 low;
  glm::dvec2 high;
};

// Returns the part of an outline (of dvec2 or dvec3) where a linear function is at least 0 (Sutherland and
// Hodgman 1974). `meet` makes the point between two where the function vanishes. Pieces are joined along the
// border.
template <class Point, class Value, class Meet>
std::vector<Point> clipped(std::span<const Point> outline, const Value& value, const Meet& meet) {
  std::vector<Point> out;
  out.reserve(outline.size() + 4);
  for (std::size_t n = 0; n < outline.size(); ++n) {
    const Point& a = outline[n];
    const Point& b = outline[n + 1 == outline.size() ? 0 : n + 1];
    const double at_a = value(a);
    const double at_b = value(b);
    if (at_a >= 0) out.push_back(a);
    // From the same end in both directions, so that both sides of the border get the same point.
    if ((at_a < 0) != (at_b < 0)) out.push_back(at_a < 0 ? meet(a, b, at_a, at_b) : meet(b, a, at_b, at_a));
  }
  return out;
}

// Cuts an outline by the chart line x[axis] = at.
std::pair<Outline, Outline> halves(const Outline& outline, int axis, double at) {
  const auto meet = [axis, at](const glm::dvec2& a, const glm::dvec2& b, double, double) {
    glm::dvec2 p = a + (b - a) * ((at - a[axis]) / (b[axis] - a[axis]));
    p[axis] = at;
    return p;
  };
  // The point is made from the end below the line in both halves.
  const auto meet_above = [&meet](const glm::dvec2& a, const glm::dvec2& b, double x, double y) {
    return meet(b, a, y, x);
  };
  const std::span<const glm::dvec2> all(outline);
  return {clipped(
              all, [axis, at](const glm::dvec2& p) { return at - p[axis]; }, meet_above),
          clipped(
              all, [axis, at](const glm::dvec2& p) { return p[axis] - at; }, meet)};
}

double signed_area(const Outline& outline) {
  double twice = 0;
  for (std::size_t n = 2; n < outline.size(); ++n) {
    const glm::dvec2 a = outline[n - 1] - outline[0];
    const glm::dvec2 b = outline[n] - outline[0];
    twice += a.x * b.y - a.y * b.x;
  }
  return twice / 2;
}

// Returns true if every edge runs along the border of the box.
bool runs_along(const Outline& outline, const ChartBox& box) {
  for (std::size_t n = 0; n < outline.size(); ++n) {
    const glm::dvec2& a = outline[n];
    const glm::dvec2& b = outline[n + 1 == outline.size() ? 0 : n + 1];
    const bool is_on_border = (a.x == b.x && (a.x == box.low.x || a.x == box.high.x)) ||
                              (a.y == b.y && (a.y == box.low.y || a.y == box.high.y));
    if (!is_on_border) return false;
  }
  return true;
}

int winding_of(const Outline& outline, const ChartBox& box) {
  const glm::dvec2 size = box.high - box.low;
  return static_cast<int>(std::lround(signed_area(outline) / (size.x * size.y)));
}

// Returns a polygon's part on a face, in its chart.
Outline on_face(std::span<const glm::dvec3> polygon, mars::Face face) {
  const mars::FaceAxes& axes = mars::face_axes(face);
  std::vector<glm::dvec3> part(polygon.begin(), polygon.end());
  const std::array<glm::dvec3, 4> borders{axes.right, -axes.right, axes.up, -axes.up};
  const auto coordinate = [&axes](const glm::dvec3& p, int axis) {
    return glm::dot(axis == 0 ? axes.right : axes.up, p) / glm::dot(axes.out, p);
  };
  for (const glm::dvec3& side : borders) {
    part = clipped(
        std::span<const glm::dvec3>(part),
        [&](const glm::dvec3& p) { return glm::dot(axes.out, p) - glm::dot(side, p); },
        [](const glm::dvec3& a, const glm::dvec3& b, double at_a, double at_b) {
          return glm::normalize(a * std::abs(at_b) + b * std::abs(at_a));
        });
  }
  Outline outline;
  outline.reserve(part.size());
  for (const glm::dvec3& p : part) {
    glm::dvec2 xy{coordinate(p, 0), coordinate(p, 1)};
    for (int axis = 0; axis < 2; ++axis)
      if (std::abs(std::abs(xy[axis]) - 1) < 1e-14 || std::abs(xy[axis]) > 1)
        xy[axis] = std::copysign(1.0, xy[axis]);
    outline.push_back(xy);
  }
  return outline;
}

class Walk {
 public:
  Walk(const paging::Surface& surface, int level, FacetVisitor& visitor, const std::stop_token& stop)
      : surface_(surface), tree_(surface.planet().tree()), level_(level), visitor_(visitor), stop_(stop) {}

  bool face(mars::Face face, const Outline& outline) {
    return in_tile(static_cast<lod::TileTree::Index>(face), outline, {{-1, -1}, {1, 1}});
  }
  bool whole(lod::TileTree::Index index, int winding) {
    const lod::TileInfo& info = tree_[index];
    if (stop_.stop_requested()) return false;
    if (info.has_children && info.key.level < level_) {
      const lod::TileTree::Index first = tree_.first_child(index);
      for (lod::TileTree::Index n = 0; n < 4; ++n)
        if (!whole(first + n, winding)) return false;
      return true;
    }
    const auto tile = surface_.tile(info.key);
    const int side = tile->data.posts.intervals;
    visitor_.block(*tile, 0, side, 0, side, winding);
    return true;
  }

 private:
  bool in_tile(lod::TileTree::Index index, const Outline& outline, const ChartBox& box) {
    if (outline.size() < 3) return true;
    const lod::TileInfo& info = tree_[index];
    if (runs_along(outline, box)) {
      const int winding = winding_of(outline, box);
      return winding == 0 || whole(index, winding);
    }
    if (stop_.stop_requested()) return false;
    if (!info.has_children || info.key.level >= level_) {
      const auto tile = surface_.tile(info.key);
      in_block(*tile, {0, tile->data.posts.intervals}, {0, tile->data.posts.intervals}, outline);
      return true;
    }
    const glm::dvec2 middle{surface_.middle_line(info.key.level, info.key.i),
                            surface_.middle_line(info.key.level, info.key.j)};
    const lod::TileTree::Index first = tree_.first_child(index);
    const auto [west, east] = halves(outline, 0, middle.x);
    const auto [south_west, north_west] = halves(west, 1, middle.y);
    const auto [south_east, north_east] = halves(east, 1, middle.y);
    return in_tile(first, south_west, {box.low, middle}) &&
           in_tile(first + 1, south_east, {{middle.x, box.low.y}, {box.high.x, middle.y}}) &&
           in_tile(first + 2, north_west, {{box.low.x, middle.y}, {middle.x, box.high.y}}) &&
           in_tile(first + 3, north_east, {middle, box.high});
  }

  // Columns and rows are intervals of the tile's grid lines.
  void in_block(const paging::SurfaceTile& tile, std::pair<int, int> columns, std::pair<int, int> rows,
                const Outline& outline) {
    if (outline.size() < 3) return;
    const auto line_u = [&tile](int i) { return tile.lines.u[static_cast<std::size_t>(i)]; };
    const auto line_v = [&tile](int j) { return tile.lines.v[static_cast<std::size_t>(j)]; };
    const ChartBox box{{line_u(columns.first), line_v(rows.first)},
                       {line_u(columns.second), line_v(rows.second)}};
    if (runs_along(outline, box)) {
      if (const int winding = winding_of(outline, box); winding != 0)
        visitor_.block(tile, columns.first, columns.second, rows.first, rows.second, winding);
      return;
    }
    if (columns.second - columns.first == 1) return in_cell(tile, columns.first, rows.first, outline);
    const int i = (columns.first + columns.second) / 2;
    const int j = (rows.first + rows.second) / 2;
    const auto [west, east] = halves(outline, 0, line_u(i));
    const auto [south_west, north_west] = halves(west, 1, line_v(j));
    const auto [south_east, north_east] = halves(east, 1, line_v(j));
    in_block(tile, {columns.first, i}, {rows.first, j}, south_west);
    in_block(tile, {i, columns.second}, {rows.first, j}, south_east);
    in_block(tile, {columns.first, i}, {j, rows.second}, north_west);
    in_block(tile, {i, columns.second}, {j, rows.second}, north_east);
  }

  void in_cell(const paging::SurfaceTile& tile, int i, int j, const Outline& outline) {
    const lod::Posts& posts = tile.data.posts;
    const auto column = static_cast<std::size_t>(i);
    const auto row = static_cast<std::size_t>(j);
    const glm::dvec2 low{tile.lines.u[column], tile.lines.v[row]};
    const glm::dvec2 size = glm::dvec2{tile.lines.u[column + 1], tile.lines.v[row + 1]} - low;
    const auto depth = [&](int a, int b) {
      return lod::inverse_depth(tile.lines.u[column + static_cast<std::size_t>(a)],
                                tile.lines.v[row + static_cast<std::size_t>(b)], posts.at(i + a, j + b),
                                surface_.planet_radius_m());
    };
    const double w00 = depth(0, 0);
    const double w10 = depth(1, 0);
    const double w01 = depth(0, 1);
    const double w11 = depth(1, 1);
    const auto beyond_diagonal = [&](const glm::dvec2& p) {
      return (p.x - low.x) / size.x - (p.y - low.y) / size.y;
    };
    const auto meet = [](const glm::dvec2& a, const glm::dvec2& b, double at_a, double at_b) {
      return a + (b - a) * (at_a / (at_a - at_b));
    };
    for (const bool is_lower : {true, false}) {
      const double sign = is_lower ? 1 : -1;
      const Outline part = clipped(
          std::span<const glm::dvec2>(outline), [&](const glm::dvec2& p) { return sign * beyond_diagonal(p); },
          meet);
      if (part.size() < 3) continue;
      const double ws = is_lower ? w10 - w00 : w11 - w01;
      const double wt = is_lower ? w11 - w10 : w01 - w00;
      piece_m_.clear();
      for (const glm::dvec2& p : part) {
        const double w = w00 + ws * (p.x - low.x) / size.x + wt * (p.y - low.y) / size.y;
        piece_m_.push_back(mars::cube_point(posts.key.face, p.x, p.y) / w);
      }
      visitor_.part(tile, i, j, piece_m_);
    }
  }

  const paging::Surface& surface_;
  const lod::TileTree& tree_;
  int level_;
  FacetVisitor& visitor_;
  const std::stop_token& stop_;
  std::vector<glm::dvec3> piece_m_;
};

class Counter {
 public:
  Counter(const paging::PlanetFile& planet, int level, double most)
      : tree_(planet.tree()), level_(level), most_(most), cells_(planet.meta().tile.intervals()) {
    cells_ *= cells_;
  }
  double count() const { return count_; }

  void in_tile(lod::TileTree::Index index, const Outline& outline, const ChartBox& box) {
    if (outline.size() < 3 || count_ > most_) return;
    const lod::TileInfo& info = tree_[index];
    if (runs_along(outline, box)) {
      if (winding_of(outline, box) != 0) whole(index);
      return;
    }
    if (!info.has_children || info.key.level >= level_) {
      const glm::dvec2 size = box.high - box.low;
      count_ += cells_ * std::abs(signed_area(outline)) / (size.x * size.y);
      return;
    }
    const glm::dvec2 middle{mars::face_line(2 * std::int64_t{info.key.i} + 1, info.key.level + 1),
                            mars::face_line(2 * std::int64_t{info.key.j} + 1, info.key.level + 1)};
    const lod::TileTree::Index first = tree_.first_child(index);
    const auto [west, east] = halves(outline, 0, middle.x);
    const auto [south_west, north_west] = halves(west, 1, middle.y);
    const auto [south_east, north_east] = halves(east, 1, middle.y);
    in_tile(first, south_west, {box.low, middle});
    in_tile(first + 1, south_east, {{middle.x, box.low.y}, {box.high.x, middle.y}});
    in_tile(first + 2, north_west, {{box.low.x, middle.y}, {middle.x, box.high.y}});
    in_tile(first + 3, north_east, {middle, box.high});
  }

 private:
  void whole(lod::TileTree::Index index) {
    if (count_ > most_) return;
    const lod::TileInfo& info = tree_[index];
    if (!info.has_children || info.key.level >= level_) {
      count_ += cells_;
      return;
    }
    for (lod::TileTree::Index n = 0; n < 4; ++n) whole(tree_.first_child(index) + n);
  }

  const lod::TileTree& tree_;
  int level_;
  double most_;
  double cells_;  // of a tile
  double count_ = 0;
};

}  // namespace

bool walk_facets(const paging::Surface& surface, std::span<const glm::dvec3> polygon, int level,
                 FacetVisitor& visitor, const std::stop_token& stop) {
  Walk walk(surface, level, visitor, stop);
  for (int f = 0; f < mars::kFaces; ++f) {
    const auto face = static_cast<mars::Face>(f);
    if (!walk.face(face, on_face(polygon, face))) return false;
  }
  return true;
}

bool walk_all_facets(const paging::Surface& surface, int level, FacetVisitor& visitor,
                     const std::stop_token& stop) {
  Walk walk(surface, level, visitor, stop);
  for (lod::TileTree::Index face = 0; face < mars::kFaces; ++face)
    if (!walk.whole(face, 1)) return false;
  return true;
}

double count_cells(const paging::PlanetFile& planet, std::span<const glm::dvec3> polygon, int level,
                   double most) {
  Counter counter(planet, level, most);
  for (int f = 0; f < mars::kFaces; ++f)
    counter.in_tile(static_cast<lod::TileTree::Index>(f), on_face(polygon, static_cast<mars::Face>(f)),
                    {{-1, -1}, {1, 1}});
  return counter.count();
}

}  // namespace vpe::explore
