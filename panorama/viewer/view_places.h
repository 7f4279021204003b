// Computes where an image shows the pixels of a view, row by row.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "panorama/projection.h"
#include "vpe/core/view.h"

namespace panorama {

// Computes places of the rows of one view. Pure after its construction; any number of threads may share it.
//
// Places of perspective views are interpolated along a row: azimuths, and elevations of equirectangular images, are computed at every
// kStep_px-th pixel, with their slopes, and cubics lie between them. Where that is not within kMostShift_px, as beside
// the zenith and in small images, each pixel is computed alone, as are all pixels of round views.
class ViewPlaces {
 public:
  // Bounds the distance between a row's place and that of PanoramaMap::place(), in pixels of the view.
  static constexpr double kMostShift_px = 1e-4;
  static constexpr int kStep_px = 8;

  // The view's axes are in the panorama's frame (viewer.h). The map and the view must pass check().
  ViewPlaces(const PanoramaMap& map, const vpe::core::View& view);

  // Computes the places of the middles of the pixels (0, y), (1, y), ... of the view's drawn part. A row and places may lie beyond
  // the part. x is in [0, turn_px), as if the image were a full circle from its left edge on.
  void row(int y, std::span<glm::dvec2> places) const;

 private:
  struct Knot;
  Knot knot_at(const glm::dvec3& ray) const;
  bool is_bound(const Knot& begin, const Knot& end) const;
  glm::dvec2 exact(double x, double y) const;
  glm::dvec2 place(double turned_px, double rise_rad, const glm::dvec3& ray) const;

  PanoramaMap map_;
  vpe::core::View view_;
  glm::dvec2 first_px_{0, 0};        // middle of the drawn part's first pixel, from the principal point
  double focal_px_ = 0;              // of a perspective view
  double level_step_ = 0;            // horizontal length of a step of one pixel along a row
  std::vector<glm::dvec2> middles_;  // sine and cosine of the azimuths of facets' middles
};

}  // namespace panorama
