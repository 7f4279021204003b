// From ranges near a pixel to the range at its centre: a ray is met with the facet at its hint, then with the
// facet at what that gave, until the facet stays the same.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "mars/geodesy/cube.h"
#include "vpe/voxel/cast/height_grid.h"

namespace vpe::voxel {

// The facets of one lattice. Posts in float or, about the camera's foot, in double.
struct Facets {
  std::uint64_t id = 0;  // of the lattice
  mars::Face face = mars::Face::kPlusX;
  HeightGridFrame frame;
  LineFamily family = LineFamily::kColumns;
  const HeightGridLines<float>* lines = nullptr;
  const HeightGridLines<double>* exact_lines = nullptr;  // used where set
};

class FacetSource {
 public:
  virtual ~FacetSource() = default;
  // The lattice over or under a place. Valid until the next call.
  virtual const Facets& at(const glm::dvec3& place_m) = 0;
};

// Rays of neighbouring pixels, evenly apart: direction of pixel k is first + k step, of any length.
struct RayRow {
  glm::dvec3 camera_m;
  double radius_m = 0;  // of the sphere
  glm::dvec3 first;
  glm::dvec3 step;
  int count = 0;
};

// range[k]: where ray k meets S between the hints a[k] and b[k], ranges of samples on either side of the pixel,
// of which it lies share[k] of the way from a to b. As exact as the facets' posts, then rounded to float.
// Infinite where both hints are. Pixels whose hints do not belong to one surface, and those that find no facet,
// are appended to `open` and left as the nearer hint. The two sources see the same lattices; each is asked by
// turns of its own.
void refine_row(const RayRow& row, const float* a, const float* b, const float* share, FacetSource& source,
                FacetSource& exact_source, float* range, std::vector<int>& open);

// Hints from a row of samples: pixel k lies at first + k step, in samples; a and b are its neighbours there.
void hints_from_row(const float* samples, int sample_count, double first, double step, int count, float* a,
                    float* b, float* share);

// Hints from rows of samples, one a pixel: pixel k lies at stretch[k] y + shift[k] of samples[k * lines ...].
void hints_from_columns(const float* samples, int lines, const float* off_axis_magnification,
                        const float* shift, float y, int count, float* a, float* b, float* share);

}  // namespace vpe::voxel
