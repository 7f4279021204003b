// What the triangles of a mesh share, found by position: files often give each triangle corners of its own.
//
// Typical usage:
//   const std::vector<std::uint32_t> places = weld(mesh);
//   const std::vector<EdgeUse> uses = edge_uses(mesh, places);  // those of an edge follow each other
#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "objects/model/mesh.h"

namespace objects {

// Returns, for each vertex, the first vertex at the same position. Pure.
std::vector<std::uint32_t> weld(const Mesh& mesh);

// A side of a triangle, from corner k to the next one.
struct EdgeUse {
  std::uint32_t low = 0;  // the two places, the smaller first
  std::uint32_t high = 0;
  std::uint32_t triangle = 0;
  std::uint8_t corner = 0;
  bool is_forward = true;  // from low to high
};

// Returns the sides of all triangles that have three places, ordered by place and then by triangle. Pure.
std::vector<EdgeUse> edge_uses(const Mesh& mesh, const std::vector<std::uint32_t>& places);

// Calls visit(first, last) for each edge: the range of its uses.
template <class Visit>
void for_each_edge(const std::vector<EdgeUse>& uses, const Visit& visit) {
  for (std::size_t first = 0; first < uses.size();) {
    std::size_t last = first + 1;
    while (last < uses.size() && uses[last].low == uses[first].low && uses[last].high == uses[first].high)
      ++last;
    visit(first, last);
    first = last;
  }
}

// Sets that are joined step by step. A set is named by its smallest member.
class JoinedSets {
 public:
  explicit JoinedSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::size_t find(std::size_t n) {
    while (parent_[n] != n) n = parent_[n] = parent_[parent_[n]];
    return n;
  }
  void join(std::size_t a, std::size_t b) {
    a = find(a);
    b = find(b);
    if (a < b) parent_[b] = a;
    if (b < a) parent_[a] = b;
  }

 private:
  std::vector<std::size_t> parent_;
};

}  // namespace objects
