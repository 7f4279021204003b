// Images that stand in the world: rectangles and domes, placed on a planet.
//
// Typical usage:
//   PosterImage image{std::make_shared<const TexturePyramid>(texture), width_px, height_px};
//   const PlacedPoster poster = place_entry(entry, image, planet_radius_m, ground_radius_m);
#pragma once

#include <functional>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>

#include "mars/geodesy/pose.h"
#include "objects/files/poster_entry.h"
#include "objects/model/texture_pyramid.h"
#include "objects/posters/panorama_formula.h"
#include "objects/scene/place.h"

namespace objects {

// Says where a panorama shows a direction.
struct PanoramaPlace {
  glm::dvec2 uv{0, 0};  // 0 to 1 across and down the image
  double texel_sr = 0;  // solid angle of a texel there, steradians
};
// Returns the place of a direction (unit; east, north, up), or nullopt where the panorama does not show it. Any thread may
// call it.
using PanoramaLookup = std::function<std::optional<PanoramaPlace>(const glm::dvec3& direction)>;

// Holds the pixels of an image, and of a panorama what it shows.
struct PosterImage {
  std::shared_ptr<const TexturePyramid> texture;
  int width_px = 0;
  int height_px = 0;
  PanoramaLookup lookup = {};   // of panoramas
  bool is_full_circle = false;  // the right edge of a panorama follows its left one
  std::optional<PanoramaFormula> formula =
      std::nullopt;  // that of lookup(), where there is one: domes are drawn faster
};

// Describes an image at its place. Immutable; any thread may read it.
struct PlacedPoster {
  PosterForm form = PosterForm::kPane;
  PosterImage image;
  double opacity = 1;
  // Gives the middle of a rectangle, or of a dome, body-fixed. Of billboards: the middle of the lower edge.
  glm::dvec3 middle_m{0, 0, 0};
  // Axes of a rectangle: right and up as a viewer before it sees them, forward away from this viewer. Of domes: east, up and
  // north. Of billboards only `up` counts.
  mars::Axes axes;
  double width_m = 0;
  double tall_m = 0;
  double radius_m = 0;  // of domes
  double fade_m = 0;
  bool is_cylinder = false;
  bool replaces_ground = false;
};

// Returns an entry at its place, which must be set. Places above the ground are above ground_radius_m(). Pure.
PlacedPoster place_entry(const PosterEntry& entry, PosterImage image, double planet_radius_m,
                         const GroundRadius& ground_radius_m);

// Returns the share, 0 to 1, with which a dome is seen from a distance of its middle: 1 up to half of fade_m, 0 from fade_m on,
// with a continuous slope between. Pure.
double dome_share(double distance_m, double fade_m);

}  // namespace objects
