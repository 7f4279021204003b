// Rectangles of a panorama's image as surfaces of directions, and how finely they are cut for projective texturing.
//
// A panorama on the graphics pipeline is an environment map on a faceted surface around the camera (Hitchner 1992, 2.5.2,
// footnote): a cylinder, a sphere or planes. The rasteriser interpolates places of the image linearly over each triangle
// of the surface, so that a pixel shows a place whose direction differs a little from its own. cuts_of() bounds that angle.
//
// All functions are pure and may be called from any thread. Maps must pass panorama::check().
#pragma once

#include <glm/vec3.hpp>

#include "panorama/projection.h"

namespace vpe::overlook {

// Describes a rectangle of the map's image, in pixels. With facets it lies on one of them.
struct Rectangle {
  double left = 0;
  double top = 0;
  double right = 0;
  double bottom = 0;
};

// Returns a vector towards what the image shows at (x, y), in the panorama's frame (east, north, up); not of unit length.
// `facet`: that of the rectangle, from facet_of(). Along x and y it is linear but for the azimuth of cylinders and both
// angles of equirectangular images.
glm::dvec3 direction_vector(const panorama::PanoramaMap& map, int facet, double x, double y);

// Returns the facet that a column lies on; 0 for images without facets.
int facet_of(const panorama::PanoramaMap& map, double x);

// Describes the directions of a rectangle: all are within radius_rad of the unit vector `axis`.
struct Cap {
  glm::dvec3 axis{0, 1, 0};
  double radius_rad = 0;
};
Cap cap_of(const panorama::PanoramaMap& map, int facet, const Rectangle& rectangle);

// Returns the largest sides of a rectangle as angles: along the horizon and upwards.
glm::dvec2 sides_rad(const panorama::PanoramaMap& map, int facet, const Rectangle& rectangle);

// Counts the cells that a rectangle is cut into; each is drawn as two triangles.
struct Cuts {
  int across = 1;
  int down = 1;
};

// Returns a bound of the angle between the direction of a pixel and that of the place which it shows, for a rectangle in
// `cuts`. With steps a of azimuth and b of elevation, s and c the largest sine and cosine of an elevation:
//   cylinder         c (s + a) a^2 / 8 / (1 - a^2 / 8)
//   equirectangular  (s c a^2 + s a b + (a^2 + b^2)^1.5) / 4 / (1 - (a^2 + b^2) / 4)
//   facets           0
// They follow from the error of linear interpolation over a triangle: half the square of the radius of the circle around
// it times the largest second derivative, of which only the part across the line of sight counts.
double largest_shift_rad(const panorama::PanoramaMap& map, const Rectangle& rectangle, const Cuts& cuts);

// Returns the fewest cuts, with about square cells, whose bound is at most allowed_rad > 0.
Cuts cuts_of(const panorama::PanoramaMap& map, const Rectangle& rectangle, double allowed_rad);

}  // namespace vpe::overlook
