// A tree of caps of the sphere that finds those near a direction or a cap.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "mars/sources/source.h"

namespace relief {

// Immutable: any number of threads may use it.
class CapTree {
 public:
  CapTree() = default;
  explicit CapTree(std::span<const mars::Cap> caps);

  // Sets `found` to the indices of caps, in ascending order: of all that have a point in common with the cap, and of some
  // others near it. A cap of radius 0 is a direction.
  void find(const mars::Cap& cap, std::vector<std::uint32_t>& found) const;

 private:
  struct Box {
    glm::dvec3 low;
    glm::dvec3 high;
  };
  struct Node {
    Box box;
    std::uint32_t first =
        0;  // of a leaf: into order_; else: the first child; the second one follows at `second`
    std::uint32_t second = 0;
    std::uint32_t count = 0;  // of caps; 0: no leaf
  };

  std::uint32_t build(std::uint32_t first, std::uint32_t end);

  std::vector<Box> boxes_;  // of the caps
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace relief
