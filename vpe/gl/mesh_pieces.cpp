#include "vpe/gl/mesh_pieces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numeric>

namespace vpe::gl {

namespace {

// Beside OpenGL's own work a piece costs some tests of planes, and a draw call where its neighbours are not seen.
constexpr std::size_t kLeastPiece = 128;  // triangles
constexpr int kMostRows = 8;

// Part of the distances by which a drawn corner may be away from its place: a few times 2^-24 each for its storage, that
// of the tile's place and the vertex stage.
constexpr double kPlaceError = 2e-6;

// The square of a triangle, by the sum of its corners.
int square_of(const lod::TileMesh& mesh, std::size_t triangle, int rows) {
  int i = 0;
  int j = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const lod::MeshVertex& v = mesh.vertices[mesh.triangles[3 * triangle + k]];
    i += v.i;
    j += v.j;
  }
  const auto row = [&](int sum) { return std::min(rows - 1, sum * rows / (3 * mesh.intervals)); };
  return row(j) * rows + row(i);
}

// A box relative to the camera, along axes of its own.
struct Box {
  glm::dvec3 low;
  glm::dvec3 high;
  double reach() const {
    const glm::dvec3 far = glm::max(glm::abs(low), glm::abs(high));
    return far.x + far.y + far.z;
  }
};

bool is_outside(const Box& box, const glm::dvec3& inwards, double slack_m) {
  const glm::dvec3 most = glm::max(inwards * box.low, inwards * box.high);
  return most.x + most.y + most.z < -slack_m;
}

// What a sphere hides from a camera outside of it is convex: a cone beyond the plane through its horizon. So a box is
// hidden if its corners are.
bool is_beyond_horizon(const Box& box, const glm::dvec3& camera_m, double tangent2, double slack_m) {
  const double camera_r = glm::length(camera_m);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 p((corner & 1) != 0 ? box.high.x : box.low.x, (corner & 2) != 0 ? box.high.y : box.low.y,
                       (corner & 4) != 0 ? box.high.z : box.low.z);
    // How far towards the planet's centre, times the camera's radius.
    const double inwards = -glm::dot(p, camera_m) - slack_m * camera_r;
    const double away = glm::length(p) + slack_m;
    if (!(inwards > tangent2) || !(inwards * inwards > tangent2 * away * away)) return false;
  }
  return true;
}

}  // namespace

PieceFrame piece_frame(const glm::dvec3& origin_m) {
  const double r = glm::length(origin_m);
  const glm::dvec3 out = r > 0 ? origin_m / r : glm::dvec3(0, 0, 1);
  const glm::dvec3 least = std::abs(out.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 right = glm::normalize(glm::cross(least, out));
  return {origin_m, glm::dmat3(right, glm::cross(out, right), out)};
}

int piece_rows(std::size_t triangles) {
  int rows = 1;
  while (rows < kMostRows && triangles >= 4 * kLeastPiece * static_cast<std::size_t>(rows * rows)) rows *= 2;
  return rows;
}

void order_by_pieces(lod::TileMesh& mesh) {
  const int rows = piece_rows(mesh.triangle_count());
  if (rows == 1) return;
  std::vector<int> square(mesh.triangle_count());
  for (std::size_t t = 0; t < square.size(); ++t) square[t] = square_of(mesh, t, rows);
  std::vector<std::uint32_t> order(square.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return square[a] < square[b]; });
  std::vector<std::uint16_t> sorted;
  sorted.reserve(mesh.triangles.size());
  for (const std::uint32_t t : order) {
    const auto first = mesh.triangles.begin() + 3 * static_cast<std::ptrdiff_t>(t);
    sorted.insert(sorted.end(), first, first + 3);
  }
  mesh.triangles = std::move(sorted);
}

std::vector<MeshPiece> mesh_pieces(const lod::TileMesh& mesh, std::span<const glm::vec3> positions_m,
                                   const PieceFrame& frame) {
  const glm::dmat3 to_frame = glm::transpose(frame.axes);
  std::vector<glm::vec3> places;
  places.reserve(positions_m.size());
  for (const glm::vec3& p : positions_m) places.emplace_back(to_frame * glm::dvec3(p));
  const int rows = piece_rows(mesh.triangle_count());
  std::vector<MeshPiece> pieces;
  int last = -1;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const auto begin = static_cast<std::uint32_t>(3 * t);
    const int square = square_of(mesh, t, rows);
    if (square != last) {
      const glm::vec3& first = places[mesh.triangles[begin]];
      pieces.push_back({{begin, begin}, first, first});
    }
    last = square;
    MeshPiece& piece = pieces.back();
    piece.range.end = begin + 3;
    for (std::uint32_t k = begin; k < begin + 3; ++k) {
      piece.low_m = glm::min(piece.low_m, places[mesh.triangles[k]]);
      piece.high_m = glm::max(piece.high_m, places[mesh.triangles[k]]);
    }
  }
  return pieces;
}

void seen_ranges(std::span<const MeshPiece> pieces, const PieceFrame& frame, const PieceView& view,
                 std::vector<IndexRange>& ranges) {
  const glm::dmat3 to_frame = glm::transpose(frame.axes);
  const glm::dvec3 to_origin_m = to_frame * (frame.origin_m - view.frustum.camera_m);
  const glm::dvec3 camera_m = to_frame * view.frustum.camera_m;
  std::array<glm::dvec3, 5> inwards;
  const auto planes = static_cast<std::size_t>(view.frustum.count);
  for (std::size_t k = 0; k < planes; ++k) inwards[k] = to_frame * view.frustum.normals[k];
  const double r2 = glm::dot(camera_m, camera_m);
  const double tangent2 = r2 - view.horizon.occluder_m * view.horizon.occluder_m;
  const std::size_t before = ranges.size();
  for (const MeshPiece& piece : pieces) {
    const Box box{to_origin_m + glm::dvec3(piece.low_m), to_origin_m + glm::dvec3(piece.high_m)};
    const double slack_m = kPlaceError * (glm::length(to_origin_m) + box.reach());
    const auto outside = [&](const glm::dvec3& plane) { return is_outside(box, plane, slack_m); };
    if (std::any_of(inwards.begin(), inwards.begin() + static_cast<std::ptrdiff_t>(planes), outside)) continue;
    if (view.horizon.hides && is_beyond_horizon(box, camera_m, tangent2, slack_m)) continue;
    if (ranges.size() > before && ranges.back().end == piece.range.begin) {
      ranges.back().end = piece.range.end;
    } else {
      ranges.push_back(piece.range);
    }
  }
}

}  // namespace vpe::gl
