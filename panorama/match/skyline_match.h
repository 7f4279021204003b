// The attitude of a photograph from its skyline, or why it is not found.
//
// An answer is given only where it is sure: enough columns with sky, a skyline with enough relief, a likeness that is
// not chance, no second attitude that is nearly as good, and a standard deviation that is small. All functions are pure
// and may be called from any thread; results do not depend on it.
//
// Typical usage:
//   const SkyLine line = find_sky_line(image);
//   const SkylineMatch match = match_skyline(line, {image.width, image.height, {}}, profile, {});
//   if (match.found()) use(match.pose); else tell(match.reason);
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "panorama/match/yaw_search.h"

namespace panorama {

// Holds what a sure answer is; match_skyline() enforces the limits given here.
struct MatchOptions {
  // Vertical field of view, degrees, 1 to 150; 0: it is found. Not used with a map.
  double fov_deg = 0;
  // Share of the columns that must have sky, 0.05 to 1. Smaller: more answers, less sure ones.
  double least_columns = 0.3;
  // Least robust standard deviation of the skyline about a straight one, pixels, 0.5 to 1000.
  double least_relief_px = 2;
  // Sigmas that must lie within the tolerances, 1 to 10. Larger: fewer answers, surer ones.
  double sigmas = 2.5;
  double yaw_tolerance_deg = 0.1;        // 1e-4 to 10
  double attitude_tolerance_deg = 0.05;  // of pitch and roll, 1e-4 to 10
  YawSearchOptions search = {};
};

enum class MatchFailure : std::uint8_t {
  kNone,
  kFewColumns,
  kLittleRelief,
  kNoLikeness,  // the best attitude is no better than chance
  kAmbiguous,
  kUncertain,
};

// Returns a word for each, such as "ambiguous"; "found" for kNone.
const char* to_string(MatchFailure failure);

// Holds the best attitude, and whether it is sure. Where columns or relief are too few, the pose is empty.
struct SkylineMatch {
  MatchFailure failure = MatchFailure::kNone;
  std::string reason;         // a sentence without its full stop; empty when found
  PhotoPose pose;             // yaw in [0, 360)
  PhotoPose sigma;            // standard deviations, from leaving out blocks of columns
  double residual_px = 0;     // robust standard deviation
  double residual_deg = 0;    // the same, in the middle of the image
  double within = 0;          // share of the points that lie within 3 of them
  double relief_px = 0;       // robust standard deviation of the photograph's skyline about a straight one
  double likeness = 0;        // logarithm of how much better than chance the fit is; see kLeastLikeness
  double second_yaw_deg = 0;  // of the next best attitude
  double lead = 0;            // by how much its loss (0 to 1) is larger
  std::vector<double> residuals_px;  // of the points, in their order

  bool found() const { return failure == MatchFailure::kNone; }
};

// Bounds SkylineMatch::likeness from below: the logarithm of the likelihood of the shape's waves (shape_likeness() of
// fit_spread.h) less that of the number of attitudes tried. It is no probability: one of 60 unrelated skylines was more
// like than this (docs/design/matching.md), and was refused as ambiguous.
inline constexpr double kLeastLikeness = 7;
// Bounds SkylineMatch::lead, and its ratio to its own standard deviation over blocks of columns.
inline constexpr double kLeastLead = 0.1;
inline constexpr double kLeastLeadSigmas = 3;

// Finds the attitude. Throws std::invalid_argument for options outside of their limits, and for a shape without pixels.
SkylineMatch match_skyline(const SkyLine& line, const PhotoShape& shape, const SkylineProfile& profile,
                           const MatchOptions& options = {});

}  // namespace panorama
