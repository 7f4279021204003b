// Guards of correctness that a special build can switch off, one at a time, to prove that a test fails without
// them. A guard without such a test could be lost unnoticed.
//
// Only builds with VPE_MUTATIONS have the switches. In all others mutated() is the constant false and leaves no
// code. docs/design/numerics.md lists the guards, their reasons and their tests; tests/stability/mutants.sh
// runs them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#ifdef VPE_MUTATIONS
#include <cstdio>
#include <cstdlib>
#endif

namespace vpe::base {

enum class Guard : std::uint8_t {
  kLowestOccluder,  // the occluder is a sphere below all terrain, not the datum
  kFacetSagitta,    // flat facets lie below the posts through which they are drawn
  kSkirtNeighbour,  // a skirt covers the neighbour's error too
  kSecondOrder,     // effect of exaggeration on the harmonic mean of a facet's radii
  kCellVariation,   // error terms hold between the vertices at which they are measured
  kErrorsNest,      // a file whose errors grow downwards is refused
  kBorderPosts,     // border posts lie on the coarser neighbour's edge
  kShortWay,        // angles are interpolated through 180 degrees
  kFaceOrder,       // a ray meets the faces of the cube in its own order
  kNearOrigin,      // vertices are relative to a post near the camera, where rounding would show
  kReversedDepth,   // depth runs from 1 at the near plane to 0, where floats are dense
  kNodataHeights,   // an invalid height is never stored
};

inline constexpr std::array<std::string_view, 12> kGuardNames{
    "lowest-occluder", "facet-sagitta", "skirt-neighbour", "second-order", "cell-variation", "errors-nest",
    "border-posts",    "short-way",     "face-order",      "near-origin",  "reversed-depth", "nodata-heights"};

#ifdef VPE_MUTATIONS
// Returns true if $VPE_MUTATION names this guard. Ends the program if it names no guard.
inline bool mutated(Guard guard) {
  static const int chosen = [] {
    const char* name = std::getenv("VPE_MUTATION");
    if (name == nullptr || *name == '\0') return -1;
    for (std::size_t n = 0; n < kGuardNames.size(); ++n) {
      if (kGuardNames[n] == name) return static_cast<int>(n);
    }
    std::fprintf(stderr, "VPE_MUTATION: no guard is called '%s' (vpe/base/mutation.h)\n", name);
    std::exit(2);
  }();
  return chosen == static_cast<int>(guard);
}
#else
constexpr bool mutated(Guard) { return false; }
#endif

}  // namespace vpe::base
