#include "paging/live/stitched_grid.h"

#include <algorithm>

namespace paging {

namespace {

constexpr int kStep = 2;

// Collects triangles by their posts.
class GridTriangles {
 public:
  explicit GridTriangles(int intervals) : side_(intervals + 1) {}

  void add(const std::array<lod::MeshVertex, 3>& triangle) { triangles_.push_back(triangle); }

  lod::TileMesh mesh() const {
    std::vector<int> numbers(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_), -1);
    for (const auto& triangle : triangles_)
      for (const lod::MeshVertex& v : triangle) numbers[post(v)] = 0;
    lod::TileMesh mesh;
    mesh.intervals = side_ - 1;
    for (int j = 0; j < side_; ++j) {
      for (int i = 0; i < side_; ++i) {
        const lod::MeshVertex v{static_cast<std::uint16_t>(i), static_cast<std::uint16_t>(j)};
        if (numbers[post(v)] < 0) continue;
        numbers[post(v)] = static_cast<int>(mesh.vertices.size());
        mesh.vertices.push_back(v);
      }
    }
    std::vector<std::array<std::uint16_t, 3>> faces;
    for (const auto& triangle : triangles_) {
      std::array<std::uint16_t, 3> face{};
      for (std::size_t c = 0; c < 3; ++c) face[c] = static_cast<std::uint16_t>(numbers[post(triangle[c])]);
      std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
      faces.push_back(face);
    }
    std::sort(faces.begin(), faces.end());
    for (const auto& face : faces) mesh.triangles.insert(mesh.triangles.end(), face.begin(), face.end());
    return mesh;
  }

 private:
  std::size_t post(const lod::MeshVertex& v) const {
    return static_cast<std::size_t>(v.j) * static_cast<std::size_t>(side_) + v.i;
  }

  int side_;
  std::vector<std::array<lod::MeshVertex, 3>> triangles_;
};

// Fills the strip between a border and the line of posts beside it: lines are parallel, so every triangle with two
// vertices on one and one on the other is sound.
void add_strip(int intervals, lod::Edge edge, const std::vector<int>& border, GridTriangles& out) {
  const bool along_j = edge == lod::Edge::kWest || edge == lod::Edge::kEast;
  const bool is_far = edge == lod::Edge::kEast || edge == lod::Edge::kNorth;
  const bool is_left =
      edge == lod::Edge::kSouth || edge == lod::Edge::kEast;  // the tile, looking along the edge
  const auto at = [&](int along, int inside) {
    const int across = is_far ? intervals - inside : inside;
    return along_j ? lod::MeshVertex{static_cast<std::uint16_t>(across), static_cast<std::uint16_t>(along)}
                   : lod::MeshVertex{static_cast<std::uint16_t>(along), static_cast<std::uint16_t>(across)};
  };
  const auto add = [&](const lod::MeshVertex& a, const lod::MeshVertex& b, const lod::MeshVertex& c) {
    if (is_left) {
      out.add({a, b, c});
    } else {
      out.add({a, c, b});
    }
  };
  const int last = intervals - kStep;
  int inner = kStep;
  for (std::size_t o = 0; o + 1 < border.size() || inner < last;) {
    const bool outer_next = inner == last || (o + 1 < border.size() && border[o + 1] <= inner + kStep);
    if (outer_next) {
      add(at(border[o], 0), at(border[o + 1], 0), at(inner, kStep));
      ++o;
    } else {
      add(at(border[o], 0), at(inner + kStep, kStep), at(inner, kStep));
      inner += kStep;
    }
  }
}

// Returns true for a border of every second post.
bool is_plain(const std::vector<int>& border, int intervals) {
  if (border.size() != static_cast<std::size_t>(intervals / kStep) + 1) return false;
  return std::ranges::all_of(border, [](int along) { return along % kStep == 0; });
}

}  // namespace

lod::TileMesh stitched_grid(int intervals, const lod::BorderPosts& borders) {
  GridTriangles out(intervals);
  const bool is_grid =
      std::ranges::all_of(borders, [&](const auto& border) { return is_plain(border, intervals); });
  const int first = is_grid ? 0 : kStep;
  const auto at = [](int i, int j) {
    return lod::MeshVertex{static_cast<std::uint16_t>(i), static_cast<std::uint16_t>(j)};
  };
  for (int j = first; j < intervals - first; j += kStep) {
    for (int i = first; i < intervals - first; i += kStep) {
      out.add({at(i, j), at(i + kStep, j), at(i + kStep, j + kStep)});
      out.add({at(i, j), at(i + kStep, j + kStep), at(i, j + kStep)});
    }
  }
  for (const lod::Edge edge : lod::kEdges) {
    if (is_grid) break;
    add_strip(intervals, edge, borders[static_cast<std::size_t>(edge)], out);
  }
  return out.mesh();
}

}  // namespace paging
