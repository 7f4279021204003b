// Compares two range images of a view, and judges pixels where they differ by exact casts.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "paging/surface/surface.h"
#include "vpe/core/view.h"

namespace bench {

inline constexpr double kAgree = 1e-4;  // relative range

// Describes a pixel where the ray backend differs from an exact cast.
struct WrongPixel {
  int x = 0, y = 0;
  double ours_m = 0, theirs_m = 0, exact_m = 0;
};

struct Agreement {
  std::int64_t pixels = 0;
  std::int64_t hits = 0;               // in both
  std::int64_t hit_miss = 0;           // a hit in one, sky in the other
  std::int64_t far = 0;                // hits in both that differ by more than kAgree
  double p50 = 0, p99 = 0, p9999 = 0;  // of the relative difference of hits in both
  // Numbers of judged pixels where the ray backend, Embree, both or neither are within kAgree of an exact cast.
  std::int64_t judged = 0;
  std::int64_t ours_right = 0, theirs_right = 0, both_right = 0, none_right = 0;
  std::vector<WrongPixel> ours_wrong;  // among the judged pixels
};

// Compares the images, and judges at most `max_judged` of the differing pixels, chosen evenly. Throws
// paging::PlanetError for unreadable tiles.
Agreement compare(const vpe::core::View& view, std::span<const float> ours_m, std::span<const float> theirs_m,
                  const paging::Surface& surface, std::int64_t max_judged = 400);

// Returns one line for the table.
std::string to_text(const Agreement& agreement);

}  // namespace bench
