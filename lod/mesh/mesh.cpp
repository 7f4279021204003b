#include "lod/mesh/mesh.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <string>

#include "lod/mesh/greedy.h"

namespace lod {

void check_borders(const BorderPosts& borders, int intervals) {
  for (const std::vector<int>& kept : borders) {
    const bool ascending = std::is_sorted(kept.begin(), kept.end(), std::less_equal<>());
    if (!ascending || kept.size() < 2 || kept.front() != 0 || kept.back() != intervals) {
      throw std::invalid_argument("mesh_greedy: border posts must ascend from 0 to " +
                                  std::to_string(intervals));
    }
  }
}

TileMesh canonical_mesh(int intervals, const std::vector<std::uint32_t>& posts,
                        const std::vector<std::array<std::uint32_t, 3>>& triangles) {
  const auto side = static_cast<std::uint32_t>(intervals) + 1;
  TileMesh mesh;
  mesh.intervals = intervals;
  mesh.vertices.reserve(posts.size());
  std::vector<std::uint16_t> index(static_cast<std::size_t>(side) * side);
  for (const std::uint32_t post : posts) index[post] = 1;
  for (std::uint32_t post = 0; post < side * side; ++post) {
    if (index[post] == 0) continue;
    index[post] = static_cast<std::uint16_t>(mesh.vertices.size());
    mesh.vertices.push_back({static_cast<std::uint16_t>(post % side), static_cast<std::uint16_t>(post / side)});
  }
  // Two counting sorts: by the second vertex, then by the first. No two triangles have both in this order.
  std::vector<std::uint64_t> rotated;
  rotated.reserve(triangles.size());
  std::vector<std::uint32_t> end_by_second(mesh.vertices.size() + 1);
  std::vector<std::uint32_t> end_by_first(mesh.vertices.size() + 1);
  for (const std::array<std::uint32_t, 3>& t : triangles) {
    const std::uint64_t a = index[t[0]];
    const std::uint64_t b = index[t[1]];
    const std::uint64_t c = index[t[2]];
    const std::uint64_t least =
        std::min(std::min(a << 32 | b << 16 | c, b << 32 | c << 16 | a), c << 32 | a << 16 | b);
    rotated.push_back(least);
    ++end_by_second[(least >> 16 & 0xFFFF) + 1];
    ++end_by_first[(least >> 32) + 1];
  }
  std::partial_sum(end_by_second.begin(), end_by_second.end(), end_by_second.begin());
  std::partial_sum(end_by_first.begin(), end_by_first.end(), end_by_first.begin());
  std::vector<std::uint64_t> packed(rotated.size());
  for (const std::uint64_t t : rotated) packed[end_by_second[t >> 16 & 0xFFFF]++] = t;
  for (const std::uint64_t t : packed) rotated[end_by_first[t >> 32]++] = t;
  mesh.triangles.reserve(3 * rotated.size());
  for (const std::uint64_t t : rotated) {
    for (const int shift : {32, 16, 0}) mesh.triangles.push_back(static_cast<std::uint16_t>(t >> shift));
  }
  return mesh;
}

struct Mesher::Scratch {
  GreedyMesher<OpenMeshTopology> greedy;
};

Mesher::Mesher() : scratch_(std::make_unique<Scratch>()) {}
Mesher::~Mesher() = default;
Mesher::Mesher(Mesher&&) noexcept = default;
Mesher& Mesher::operator=(Mesher&&) noexcept = default;

TileMesh Mesher::mesh(const Posts& posts, const BorderPosts& borders, double tolerance_m, double radius_m) {
  return scratch_->greedy.mesh(posts, borders, tolerance_m, radius_m);
}

TileMesh Mesher::refine(const BorderPosts& borders, double tolerance_m) {
  return scratch_->greedy.refine(borders, tolerance_m);
}

TileMesh mesh_greedy(const Posts& posts, const BorderPosts& borders, double tolerance_m, double radius_m) {
  return Mesher().mesh(posts, borders, tolerance_m, radius_m);
}

TileMesh mesh_full(int intervals) {
  constexpr int kMost = 128;
  if (intervals < 1 || intervals > kMost) {
    throw std::invalid_argument("mesh_full: 1 to " + std::to_string(kMost) + " intervals, not " +
                                std::to_string(intervals));
  }
  const int side = intervals + 1;
  TileMesh mesh;
  mesh.intervals = intervals;
  for (int j = 0; j < side; ++j) {
    for (int i = 0; i < side; ++i) {
      mesh.vertices.push_back({static_cast<std::uint16_t>(i), static_cast<std::uint16_t>(j)});
    }
  }
  for (int j = 0; j < intervals; ++j) {
    for (int i = 0; i < intervals; ++i) {
      const int a = j * side + i;
      for (const int v : {a, a + 1, a + side + 1, a, a + side + 1, a + side}) {
        mesh.triangles.push_back(static_cast<std::uint16_t>(v));
      }
    }
  }
  return mesh;
}

std::vector<double> vertex_heights(const TileMesh& mesh, const Posts& posts) {
  std::vector<double> heights;
  heights.reserve(mesh.vertices.size());
  for (const MeshVertex& vertex : mesh.vertices) heights.push_back(posts.at(vertex.i, vertex.j));
  return heights;
}

}  // namespace lod
