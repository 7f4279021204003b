// Evaluates the surface of the embedded Mars, block by block: measured ground and detail below its resolution.
//
// At the posts of the data the detail is zero: each group of relief is made zero there by subtracting its own value,
// faded over kPinnedReach_m; craters keep clear of posts; what is shorter fades out beside them. Its mean over the area
// of a post is zero too: the mean of what is longer than kMeanDetail_m is found by sampling and subtracted, and what is
// shorter has no mean by construction. Beyond about 60 degrees of latitude, where posts are narrower than high, areas of several posts
// of a row stand for one.
#pragma once

#include <functional>
#include <span>

#include "mars/embedded/block.h"
#include "mars/embedded/craters.h"
#include "mars/embedded/ground.h"
#include "mars/embedded/octaves.h"
#include "mars/embedded/relief.h"

namespace mars::embedded {

inline constexpr double kFinestDetail_m = 0.0625;
// Means are taken of the detail that posts of this spacing show.
inline constexpr double kMeanDetail_m = 256.0;

// Returns the spacing rounded down to a power of two, at least kFinestDetail_m and at most 2^20 m. It decides
// which detail is included.
double detail_spacing_m(double spacing_m);

struct Surface {
  Ground ground;
  Octaves octaves;
  CraterSum craters;
  Relief relief;
  alignas(64) Lane<float> detail_m;   // height of the detail
  alignas(64) Lane<double> height_m;  // measured height and detail
};

// Receives the surface of a block and, for each of its directions, its index in the input.
using SurfaceSink = std::function<void(const Block&, std::span<const std::uint32_t> index, const Surface&)>;

// Selects what evaluate_all() computes. Where a spacing shows no detail (kCoarsestRelief_m and more) only the measured
// heights, the places on the ground and the number of octaves are set.
enum class Wanted {
  kHeights,              // all
  kHeightsWithoutMeans,  // means are not subtracted; they are found by it
  kColours               // all but the heights: what colour() reads
};

// Splits any directions into compact blocks, finds their craters and evaluates them.
void evaluate_all(const MeasuredMars& mars, std::span<const glm::dvec3> directions, double spacing_m, Simd simd,
                  Wanted wanted, const SurfaceSink& sink);

}  // namespace mars::embedded
