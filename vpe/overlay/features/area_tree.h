// Finds the areas whose extent holds a place.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

namespace vpe::overlay {

// Holds extents in degrees of longitude and latitude, sorted into a tree of boxes. Any number of threads may read it.
class AreaTree {
 public:
  // Longitudes of an extent may be any turns away; one that is 360 degrees wide or more holds all longitudes.
  struct Extent {
    glm::dvec2 low_deg;
    glm::dvec2 high_deg;
  };
  static constexpr double kLargestPad_deg = 1;

  AreaTree() = default;
  explicit AreaTree(std::span<const Extent> extents);

  // Puts the numbers of the extents that come within `pad_deg` (at most kLargestPad_deg) of a place into `found`, ascending,
  // each once.
  void find(glm::dvec2 place_deg, double pad_deg, std::vector<std::uint32_t>& found) const;
  std::size_t bytes() const { return leaves_.capacity() * sizeof(Leaf) + nodes_.capacity() * sizeof(Node); }

 private:
  struct Leaf {
    Extent extent;
    std::uint32_t number = 0;
  };
  struct Node {
    Extent extent;
    std::uint32_t begin = 0;  // of its leaves
    std::uint32_t end = 0;
    std::uint32_t right = 0;  // its second child; the first one follows it; 0: none
  };
  void build(std::uint32_t begin, std::uint32_t end);

  std::vector<Leaf> leaves_;
  std::vector<Node> nodes_;
};

}  // namespace vpe::overlay
