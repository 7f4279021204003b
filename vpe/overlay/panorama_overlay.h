// Overlays of panoramas of any size: compass, names with leaders and distances, title, legend. Where everything
// goes is decided once, from directions alone; any part of the image then gets what falls into it.
//
// Sizes: a length of 1 px at 720 rows is panorama_unit() pixels: the image's shorter side / 720, but no more than
// a 3200th of the columns of 360 degrees (letters of names are then 1.6 degrees high), and no more than
// kMostWideUnit. So letters are 10 to 84 pixels high in images of any size.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

#include "vpe/core/appearance/appearance.h"
#include "vpe/core/appearance/overlays.h"
#include "vpe/overlay/sprites.h"

namespace vpe::overlay {

inline constexpr double kMostPanoramaUnit = 6;

struct PanoramaName {
  std::string name;
  double azimuth_deg = 0;
  double elevation_deg = 0;
  double distance_m = 0;  // straight
  double diameter_m = 0;  // 0 = not known
};

struct PanoramaScene {
  std::int64_t width_px = 0;
  std::int64_t height_px = 0;
  std::int64_t turn_px = 0;  // columns of 360 degrees
  double left_azimuth_deg = 0;
  double span_deg = 360;
  double px_per_deg = 1;  // of azimuth on the horizon, where there are the fewest
  double horizon_px = 0;  // row of elevation 0
  // Where the image shows a direction (azimuth, elevation); nothing where it does not. On the seam of a whole
  // turn either edge.
  std::function<std::optional<glm::dvec2>(double azimuth_deg, double elevation_deg)> place;
  core::Appearance appearance;  // for the legend
  bool has_imagery = true;
  std::vector<PanoramaName> names;  // those that can be seen, in any order
};

double panorama_unit(const PanoramaScene& scene);

// What of `overlays` cannot be drawn over a panorama, with the reason; empty when all can.
std::string not_for_panoramas(const core::Overlays& overlays);

// compass: as in other images. Along an edge or the horizon marks are in the columns of their azimuths on the
//   horizon.
// names: apparently larger ones first, then those of unknown size, nearest first; none under 4 px (at 720
// rows).
//   A dot where the place is, a leader straight up, and the text in the first of some rows above that has room
//   (below, when there is none above), rows over figures of a compass along the horizon last. At the ends of an
//   arc texts move inwards.
// title: at the top in the middle. legend: lower right.
// No text lies over another, nor over a leader or dot. Throws std::runtime_error when the library fails.
SpriteLayer lay_out_panorama(const core::Overlays& overlays, const PanoramaScene& scene);

}  // namespace vpe::overlay
