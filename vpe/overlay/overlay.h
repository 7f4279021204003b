// What is drawn over a finished image to read it by: lines, names, legend, scale, arrow, title, time.
//
// Everything is made from the image's view and range image alone, on the CPU: no OpenGL, no clock, no
// globals. Sizes follow the shorter side of the image; nothing is drawn outside of it, and no text over
// another. Furniture that does not fit is left out: title at the top, legend lower right, scale bar lower left,
// arrow upper right, time lower centre, all of it clear of a compass at an edge. Text is UTF-8; bytes that are
// none show as U+FFFD. An image's part (View::part) is laid out like an image of its own.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "mars/geodesy/sphere.h"
#include "mars/sources/source.h"
#include "vpe/core/appearance/appearance.h"
#include "vpe/core/appearance/gazetteer.h"
#include "vpe/core/appearance/overlays.h"
#include "vpe/core/image/image.h"
#include "vpe/core/view.h"

namespace vpe::overlay {

// Straight (not premultiplied) alpha, of the image's size; without pixels when there is nothing to draw.
// Where alpha is 0 so are the colours.
using Layer = core::Image<core::Rgba>;

struct Scene {
  core::View view;
  std::span<const float> range_m;  // core::Frame::range_m; needed where needs_range() says so
  double radius_m = mars::kMarsRadius_m;
  core::Appearance appearance;  // its exaggeration, and for the legend
  double shift_px = 0;          // by which the ground in the image may be off (core::Certificate); for contours
  bool has_imagery = true;      // mode textured shows imagery
  double time_s = 0;
  // North and up of the compass at the camera; left out: those of the ground below it.
  std::optional<mars::LocalFrame> frame;
  std::span<const core::Place> places;  // of Overlays::names; earlier ones win
  // Metres above the sphere of a place on the ground, without exaggeration. Left out: 0.
  std::function<double(const core::Place&)> height_m;
};

// Whether anything is to be drawn. If not, neither draw() nor its caller does any work.
bool any(const core::Overlays& overlays);

// Whether draw() looks at the range image.
bool needs_range(const core::Overlays& overlays);

// Throws std::invalid_argument for a range image of another size, std::runtime_error when the library of
// vectors and text fails. Any thread; height_m is called on that of the caller.
//
// graticule: where the ground's longitude and latitude are multiples of the step, to within a pixel. Automatic
//   steps put 4 to 10 lines of each kind into the middle nine tenths of the ground in the image.
// contours: the same for metres above the sphere without exaggeration; every fifth one heavier and labelled.
//   They are those of the ground as drawn, whose elevations may be off by shift_px * range / focal length:
//   lines fade where that is more than half of their distance in metres, and are gone where it is all of it.
//   Automatic steps are 1, 2, 5 times a power of ten, and large enough for that in the nearer half of the
//   ground.
// Neither runs across an edge where near ground hides far ground. Lines closer together than 5 px (at 720 rows)
// fade, and are gone at 2.
// legend: only when the appearance shows elevation, slope or aspect as colours.
// scale_bar: a length at the ground in the image's centre, across the line of sight; absent when there is
// sky. north_arrow: of the ground in the centre, on a disc that lies on the ground, tilted to 30 degrees at
// least to
//   be read; of the ground below the camera when there is sky. Absent at the very poles.
// names: hidden where the ground in the image, in all of the 3 x 3 pixels about the place, is nearer than the
//   place by more than kHiddenShare of its distance, or is sky; and where the place's diameter is known and
//   less than 4 px (at 720 rows).
// compass: marks (vpe/overlay/compass.h) along an edge, where the azimuths of the image's middle row are in
// that
//   row, or along the line of elevation 0. Absent at the very poles, and where the middle row comes within 2
//   degrees of the zenith or nadir.
inline constexpr double kHiddenShare = 0.01;
Layer draw(const core::Overlays& overlays, const Scene& scene);

// What shows of a pixel below another.
base::Rgb blend(const core::Rgba& over, base::Rgb below);

// Lays it over an image of the same number of pixels; an empty layer changes nothing. Throws
// std::invalid_argument.
void composite(const Layer& layer, std::vector<base::Rgb>& image);

}  // namespace vpe::overlay
