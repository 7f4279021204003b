// Views that draw a round panorama of two eyes, one eye each.
//
// By definition (stereo_eyes.h) every column has its own eyes, base_m apart across its azimuth, and the base
// fades beyond 45 degrees of elevation. A View has one camera, so a piece uses the eye of its middle column and
// a base between those of its rows. The displacements in the image that this causes bound the size of a piece:
//
//   Columns. At angle a from the middle column the eye is off by d = base sin(a / 2), nearly all of it along
//   the line of sight, and by (base / 2)(1 - cos a) to the side. For ground at range r, r cos(e) of it
//   horizontal, rows move by at most
//     cylinder         f tan|e| d / (r cos e - d)
//     equirectangular  f sin|e| d / (r - d)
//   and columns by f (base / 2)(1 - cos a) / (r cos e - d); f in pixels a radian (cylinder: a unit of tangent).
//   With a = width / (2 f), the first is about base width tan|e| / (4 r cos e). This does not depend on f: a
//   piece has the same number of columns at every resolution.
//   Rows. A base that is off by b moves columns by f (b / 2) / (r cos e).
//
// A piece is as large as keeps each of the three within its bound, for ground at the nearest range less half a
// base, because an eye can be that much nearer. So every pixel is within 0.15 pixels, in each direction, of
// where its own eyes see its content. Rows err in opposite directions at both ends of a piece, and a faded base
// at both ends of a band; columns err to the same side at both ends. Steps between neighbouring pieces are at
// most kStereoStep_px. A piece of one column and one row has the exact eye.
//
// Each eye has the vertical of its own place, because ground can be cast quickly along it. Compared with
// parallel verticals, columns move by f tan|e| base / (2 |eye|), in opposite directions for both eyes; at
// infinite range the horizon coincides exactly. Where this would exceed kStereoTilt_px, axes are parallel, and
// every pixel needs a cast of its own.
//
// All functions are pure and may be called from any thread.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "panorama/panorama_plan.h"
#include "panorama/stereo_eyes.h"
#include "vpe/core/stereo.h"

namespace panorama {

inline constexpr double kStereoStep_px = 0.25;      // between neighbouring pieces
inline constexpr double kStereoRowsOff_px = 0.125;  // displacement of rows
inline constexpr double kStereoSideOff_px = 0.05;   // displacement of columns
inline constexpr double kStereoFadeOff_px = 0.1;    // displacement of columns by the base of other rows
inline constexpr double kStereoTilt_px = 0.05;  // displacement of columns by verticals that are not parallel
// Limits the base, relative to the nearest ground's range. A larger base shows that ground at angles more than
// 11 degrees apart, which cannot be viewed comfortably, and pieces would shrink to single pixels.
inline constexpr double kMostBase = 0.2;

struct EyePair {
  vpe::core::StereoLayout layout = vpe::core::StereoLayout::kSideBySide;
  // Distance between the eyes: > 0, at most kMostBase nearest_m. Larger: more depth, smaller pieces, slower.
  double base_m = 0;
  std::optional<double> nearest_m;  // range of the nearest ground in the image; absent: sky alone
  // Widest gap, pixels, between pixels of the right eye's image that are carried from the left one. Absent: drawn in full.
  std::optional<double> carried_gap_px = std::nullopt;
};

// Returns an empty text when the pair can be drawn, else what is wrong with it and what is allowed.
std::string check(const EyePair& eyes);

// Describes the pixels of a file.
struct ImageSize {
  std::int64_t width_px = 0;
  std::int64_t height_px = 0;
};
// Returns the size of two images of the map's size beside or above each other, or of one in red-cyan.
ImageSize size_of_pair(const PanoramaMap& map, vpe::core::StereoLayout layout);

// Describes rows that are cut in the same way.
struct StereoBand {
  std::int64_t y = 0;
  int height = 0;
  int columns = 1;    // of a piece, a power of 2 and at most PlanLimits::kTile_px
  double base_m = 0;  // differs from every row's own by what kStereoFadeOff_px allows
};
// Returns the bands of a round map, from the top, without gaps.
std::vector<StereoBand> stereo_bands(const PanoramaMap& map, const EyePair& eyes);

// Returns the pieces of columns [strip.x, strip.x + strip.width) of an eye's image, in that image's pixels,
// without gaps or overlaps. `bands` are those of the map and the pair.
std::vector<Piece> eye_pieces_of(const PanoramaMap& map, const Viewpoint& viewpoint,
                                 const std::vector<StereoBand>& bands, Eye eye, const Strip& strip);

// Returns the pieces of a strip of the file, in the file's pixels. In red-cyan the pieces of both eyes overlap:
// first come all of the left eye, then as many of the right.
std::vector<Piece> pair_pieces_of(const PanoramaMap& map, const Viewpoint& viewpoint, const EyePair& eyes,
                                  const Strip& strip);

}  // namespace panorama
