// Guards that a build of its own can switch off, one a run, to see that a test fails for it: a guard without
// such a test can be lost unseen. Only in builds with VPE_MUTATIONS; in all others mutated() is the constant
// false and leaves no code. docs/numerics.md lists the guards, why they are there, and the tests
// (tests/stability/mutants.sh runs them).
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
  kLowestOccluder,  // what hides is a sphere below all terrain, not the datum
  kFacetSagitta,    // flat facets lie below the posts that they are drawn through
  kSkirtNeighbour,  // a skirt covers the neighbour's error too
  kSecondOrder,     // what exaggeration makes of a facet's harmonic mean
  kCellVariation,   // error terms hold between the vertices at which they are measured
  kErrorsNest,      // a file whose errors grow downwards is refused
  kBorderPosts,     // border posts lie on the coarser neighbour's edge
  kShortWay,        // angles are interpolated through 180 degrees
  kFaceOrder,       // a ray meets the faces of the cube in its own order
  kNearOrigin,      // vertices are relative to a post near the camera, where rounding would show
  kReversedDepth,   // depth runs from 1 at the near plane to 0, where floats are dense
  kMissingHeights,  // no height that is none is ever stored
};

inline constexpr std::array<std::string_view, 12> kGuardNames{
    "lowest-occluder", "facet-sag", "skirt-neighbour", "second-order", "cell-variation", "errors-nest",
    "border-posts",    "short-way", "face-order",      "near-origin",  "reversed-depth", "missing-heights"};

#ifdef VPE_MUTATIONS
// Whether $VPE_MUTATION names this guard. Ends the program for a name that is none.
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
