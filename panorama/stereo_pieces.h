// A round panorama of two eyes as Views, each with one eye.
//
// By definition (stereo_eyes.h) every column has its own eyes, base_m apart across its azimuth, and the base
// fades beyond 45 degrees of elevation. A View has one eye, so a piece has the eye of its middle column and of
// a base between those of its rows. What that moves in the image bounds the size of a piece:
//
//   Columns. At angle a from the middle column the eye is d = base sin(a / 2) from where it belongs, nearly all
//   of it along the line of sight, and (base / 2)(1 - cos a) to the side. For ground at range r, r cos(e) of it
//   horizontal, rows move by at most
//     cylinder         f tan|e| d / (r cos e - d)
//     equirectangular  f sin|e| d / (r - d)
//   and columns by f (base / 2)(1 - cos a) / (r cos e - d); f in pixels a radian (cylinder: a unit of tangent).
//   With a = width / (2 f), the first is about base width tan|e| / (4 r cos e): it does not depend on f, and a
//   piece has as many columns whatever the size of the image.
//   Rows. A base off by b moves columns by f (b / 2) / (r cos e).
//
// A piece is as large as leaves each of the three within its bound, for ground at the range of the nearest less
// half a base, as an eye can be so much nearer. So every pixel is within 0.15 pixels, each way, of where its
// own eyes see what it shows. Rows err in opposite senses at both ends of a piece, a faded base at both ends of
// a band, and what columns err to the side is alike at both ends: steps between neighbouring pieces are at most
// kStereoStep_px. A piece of one column and one row has the eye by definition.
//
// Each eye's vertical is that of its own place, as that is what ground is cast along fast. Compared with
// parallel verticals, columns move by f tan|e| base / (2 |eye|), in opposite senses for both eyes: of what is
// infinitely far, the horizon coincides exactly. Where this would exceed kStereoTilt_px, axes are parallel, at
// the cost of a cast of its own for every pixel.
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

inline constexpr double kStereoStep_px = 0.25;
inline constexpr double kStereoRowsOff_px = 0.125;
inline constexpr double kStereoSideOff_px = 0.05;
inline constexpr double kStereoFadeOff_px = 0.1;
inline constexpr double kStereoTilt_px = 0.05;
// Eyes farther apart than this part of the nearest ground's range see it more than 11 degrees apart, which
// nobody can look at, and pieces would shrink to single pixels.
inline constexpr double kMostBase = 0.2;

struct EyePair {
  vpe::core::StereoLayout layout = vpe::core::StereoLayout::kSideBySide;
  double base_m = 0;                // > 0, at most kMostBase nearest_m
  std::optional<double> nearest_m;  // range of the nearest ground in the image; nothing: sky alone
};

// Empty when the pair can be drawn, else what is wrong with it and what is allowed.
std::string check(const EyePair& eyes);

// Pixels of the file: two images of the map's size beside or above each other, or one in red-cyan.
struct ImageSize {
  std::int64_t width_px = 0;
  std::int64_t height_px = 0;
};
ImageSize size_of_pair(const PanoramaMap& map, vpe::core::StereoLayout layout);

// Rows that are cut alike.
struct StereoBand {
  std::int64_t y = 0;
  int height = 0;
  int columns = 1;    // of a piece, a power of 2 and at most PlanLimits::kTile_px
  double base_m = 0;  // within what kStereoFadeOff_px allows of every row's own
};
// From the top, without gaps. Of a round map.
std::vector<StereoBand> stereo_bands(const PanoramaMap& map, const EyePair& eyes);

// The pieces of columns [strip.x, strip.x + strip.width) of an eye's image, in that image's pixels; without
// gaps or overlaps. `bands` are those of map and eyes.
std::vector<Piece> eye_pieces_of(const PanoramaMap& map, const PoseOnSphere& stand,
                                 const std::vector<StereoBand>& bands, Eye eye, const Strip& strip);

// The same of a strip of the file, in the file's pixels. Of red-cyan, both eyes' pieces lie over each other:
// first all of the left eye, then as many of the right.
std::vector<Piece> pair_pieces_of(const PanoramaMap& map, const PoseOnSphere& stand, const EyePair& eyes,
                                  const Strip& strip);

}  // namespace panorama
