// Overlays of panoramas of any size: compass, names with leaders and distances, title, legend. The layout is
// computed once from directions alone. Any region of the image can then be drawn independently.
//
// Sizes: a length of 1 px at 720 rows is panorama_unit() pixels. That is the image's shorter side / 720, but at
// most 1/3200 of the columns of 360 degrees (letters of names are then 1.6 degrees high), and at most
// kMaxPanoramaUnit. Letters are therefore 10 to 84 pixels high in images of any size.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

#include "vpe/core/appearance/appearance.h"
#include "vpe/core/appearance/overlays.h"
#include "vpe/overlay/features/layers_legend.h"
#include "vpe/overlay/sprites.h"

namespace vpe::overlay {

inline constexpr double kMaxPanoramaUnit = 6;

struct PanoramaName {
  std::string name;
  double azimuth_deg = 0;
  double elevation_deg = 0;
  double distance_m = 0;  // in a straight line
  double diameter_m = 0;  // 0 = unknown
};

// Holds the label of a feature of a vector layer.
struct PanoramaLabel {
  std::string text;
  glm::dvec2 at_px{0, 0};
  double radius_px = 0;  // of what stands there
  Font font{14, false};
  Ink ink{1, 1, 1, 1};
};

struct PanoramaScene {
  std::int64_t width_px = 0;
  std::int64_t height_px = 0;
  std::int64_t full_circle_px = 0;  // columns of 360 degrees
  double left_azimuth_deg = 0;
  double span_deg = 360;
  double px_per_deg = 1;  // of azimuth on the horizon, where there are the fewest
  double horizon_px = 0;  // row of elevation 0
  // Returns the position of a direction in the image, or nullopt if the image does not show it. For a direction
  // on the seam of a full circle either edge may be returned.
  std::function<std::optional<glm::dvec2>(double azimuth_deg, double elevation_deg)> place;
  core::Appearance appearance;  // for the legend
  bool has_imagery = true;
  std::vector<PanoramaName> names;       // visible ones, in any order
  std::vector<PanoramaLabel> labels;     // earlier ones have priority
  std::vector<LegendRow> layers_legend;  // of Overlays::layers_legend
};

double panorama_unit(const PanoramaScene& scene);

// Returns which of the overlays cannot be drawn over a panorama, with the reason, or "" if all can.
std::string not_for_panoramas(const core::Overlays& overlays);

// Lays out all overlays but the features of vector layers themselves (features/panorama_lines.h, area_pixels.h). No text
// lies over another, nor over a leader or dot. Throws std::runtime_error if Cairo fails.
//
// - compass: as in other images. Along an edge or the horizon, marks are in the columns that their azimuths
//   have on the horizon.
// - names: places that appear larger come first, then those of unknown size by distance; places under 4 px (at
//   720 rows) are left out. Each has a dot, a vertical leader, and its text in the first of several rows above
//   that has room, or below if none above has. Rows that cover figures of a compass along the horizon are tried
//   last. At the ends of an image of less than 360 degrees texts move inwards.
// - title: at the top in the middle. legend: lower right. Legend of layers: upper left, or where there is room.
// - labels: beside their places, after names, as far as there is room.
SpriteLayer lay_out_panorama(const core::Overlays& overlays, const PanoramaScene& scene);

}  // namespace vpe::overlay
