// Overlays of finished images: lines, names, legend, scale bar, north arrow, title, time and compass.
//
// Everything is made on the CPU from the image's view and range image alone: no OpenGL, no clock, no globals.
// Sizes follow the shorter side of the image. Nothing is drawn outside of the image, and no text over other
// text. Symbols that do not fit are left out: title at the top, legend lower right, scale bar lower left, arrow
// upper right, time lower centre, all of them clear of a compass at an edge. Text is UTF-8; invalid bytes show
// as U+FFFD. A part of an image (View::part) is laid out like an image of its own.
//
// Typical usage:
//   if (overlay::any(settings)) {
//     request.want_range = overlay::needs_range(settings);
//     ...                                   // draw the frame
//     overlay::Scene scene{...};            // view, range image, appearance
//     overlay::composite(overlay::draw(settings, scene), image.pixels);
//   }
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <memory>
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

// Holds straight (not premultiplied) alpha, with the size of the image; has no pixels if there is nothing to
// draw. Colours are 0 where alpha is 0.
using Layer = core::Image<core::Rgba>;

// Ranges of the same view at another accuracy than the image's.
struct FinerRanges {
  std::span<const float> range_m;  // of the size of the image
  double shift_px = 0;             // possible shift of their terrain in the image
};

// Holds the time of the sun at a place.
struct SolarTime {
  double true_time_h = 0;  // local true solar time
  double solar_longitude_deg = 0;
};

class GroundFeatures;

// Holds vector features and how much they cover.
struct SceneLayer {
  std::shared_ptr<const GroundFeatures> features;  // not null
  double opacity = 1;                              // 0 to 1
};

struct Scene {
  core::View view;
  std::span<const float> range_m;  // core::Frame::range_m; required if needs_range()
  double radius_m = mars::kMarsRadius_m;
  core::Appearance appearance;  // for exaggeration and legend
  double shift_px = 0;          // possible shift of the terrain in the image (core::Certificate); for contours
  // Ranges that contours are taken from; nullopt: from the image's own. They are used where the image shows the
  // same ground, so lines end at the silhouettes of the image to within its shift.
  std::optional<FinerRanges> contours;
  bool has_imagery = true;  // mode textured shows imagery
  double time_s = 0;
  std::optional<SolarTime> solar;  // of TimeCode::kSolar; nullopt: none is written
  // North and up of the compass at the camera; nullopt: those of the ground below the camera.
  std::optional<mars::LocalFrame> frame;
  std::span<const core::Place> places;  // of Overlays::names; earlier ones have priority
  // Returns the height of a place on the ground above the sphere, metres, without exaggeration. Empty: 0.
  std::function<double(const core::Place&)> height_m;
  // Returns the same in a unit direction. Empty: a place whose centre is hidden has no name.
  std::function<double(const glm::dvec3&)> ground_m;
  // Of Overlays::layers, the lowest first. They need ground_m.
  std::vector<SceneLayer> layers;
  // Returns whether the terrain in a direction is synthetic, nullopt where that is not known. Empty: nothing is tinted.
  std::function<std::optional<bool>(const glm::dvec3&)> is_synthetic;
};

// The colour over synthetic ground. Ground of Mars has no blue of its own.
inline constexpr core::Rgba kSyntheticTint{40, 130, 255, 110};

// Returns true if anything is to be drawn. If not, neither draw() nor its caller does any work.
bool any(const core::Overlays& overlays);

// Returns true if draw() reads the range image.
bool needs_range(const core::Overlays& overlays);

// A place is hidden if the terrain in the image is nearer than the place by more than this share of its
// distance.
inline constexpr double kHiddenShare = 0.01;

// Draws the overlays. Throws std::invalid_argument for a range image of another size, and std::runtime_error if
// Cairo fails. May be called from any thread; height_m is called on the caller's thread.
//
// - graticule: lines where longitude and latitude of the terrain are multiples of the step, to within a pixel.
//   Automatic steps put 4 to 10 lines of each kind into the middle nine tenths of the terrain in the image.
// - contours: likewise for elevations, metres above the sphere without exaggeration. Every fifth line is
//   heavier and labelled. The lines are those of the terrain as drawn, or of Scene::contours, whose elevations
//   may be wrong by shift_px * range / focal length. Lines fade where that is more than half of their distance
// in metres, and
//   disappear where it is all of it. Automatic steps are 1, 2, 5 times a power of ten, and large enough for
//   that in the nearer half of the terrain.
// - Neither crosses an edge where near terrain hides far terrain. Lines closer together than 5 px (at 720 rows)
//   fade, and disappear at 2.
// - legend: only if the appearance shows elevation, slope or aspect as colours.
// - layers: areas, lines and points of each layer, the lowest first; labels beside points, and at the longest part of a line that
//   is seen, as far as there is room beside the other overlays.
// - layers_legend: an entry for each different style that the image shows (vpe/overlay/features/layers_legend.h), at the upper
//   left, or where there is room.
// - scale_bar: a length on the terrain at the image's centre, across the line of sight; absent if the centre
//   shows sky.
// - north_arrow: direction at the image's centre, on a disc that lies on the terrain but is tilted by at least
//   30 degrees, to be readable. If the centre shows sky, the direction below the camera. Absent at the poles.
// - names: a point is hidden if, in all of the 3 x 3 pixels about it, the image shows sky or terrain that is
//   nearer than the point by more than kHiddenShare of its distance. A name stands at the place's centre; if that
//   is hidden or outside, at the highest visible one of core::points_within(). Names are left out if there is
//   none, and if the place's diameter is known and less than 4 px (at 720 rows).
// - compass: marks (vpe/overlay/compass.h) along an edge, at the columns that their azimuths have in the
//   image's middle row, or along the line of elevation 0. Absent at the poles, and if the middle row comes
//   within 2 degrees of the zenith or nadir.
Layer draw(const core::Overlays& overlays, const Scene& scene);

// Composites one pixel over another.
base::Rgb blend(const core::Rgba& over, base::Rgb below);

// Composites a layer over an image with the same number of pixels. An empty layer changes nothing. Throws
// std::invalid_argument for another number of pixels.
void composite(const Layer& layer, std::vector<base::Rgb>& image);

}  // namespace vpe::overlay
