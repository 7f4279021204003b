// Refinement of round images: moves ranges from the samples of a fan to the pixels' own rays.
//
// Stage of the pipeline (vpe/voxel/ray_renderer.h): after the columns of a cylindrical or equirectangular image whose camera is
// tilted. cast_by_fan() (vpe/voxel/cast/fan_caster.h) casts a fan of vertical planes (ViewFan in view_fan.h) and passes its samples
// here. What cannot be resolved it casts as single rays. refine.h does the same for perspective images, whose rows of pixels
// are rows of samples. The functions are compiled for several instruction sets in round_refine_kernel.cpp.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "vpe/voxel/columns/refine.h"

namespace vpe::voxel {

// Describes the rays of neighbouring pixels in a row of a round image.
struct RoundRow {
  glm::dvec3 camera_m;
  double radius_m = 0;  // of the sphere
  // The direction of pixel k, of unit length, is sine[k] right + cosine[k] forward + up.
  const double* sine = nullptr;
  const double* cosine = nullptr;
  glm::dvec3 right;
  glm::dvec3 forward;
  glm::dvec3 up;
  int count = 0;

  glm::dvec3 direction(int k) const { return sine[k] * right + cosine[k] * forward + up; }
};

// Holds ranges on a grid that is even in azimuth and in elevation about the camera's vertical. Angles are radians.
struct FanSamples {
  glm::dvec3 north{1, 0, 0};  // unit, of azimuth 0; azimuths grow toward `east`
  glm::dvec3 east{0, 1, 0};   // unit
  glm::dvec3 up{0, 0, 1};     // unit, the vertical
  double first_azimuth = 0;   // of column 0
  double azimuth_step = 0;
  double first_elevation = 0;  // of row 0
  double elevation_step = 0;
  int columns = 0;
  bool is_full_circle = false;     // column 0 follows the last one
  const float* range_m = nullptr;  // of row r, column c at [r columns + c]
  const int* first_row = nullptr;  // of each column: its rows [first_row, end_row) are set, at least one
  const int* end_row = nullptr;
};

// Describes a pixel that samples did not resolve: the least and the greatest range of the four samples about it.
struct OpenPixel {
  int pixel = 0;
  float near_m = 0;
  float far_m = 0;
};

// Writes to range[k] where ray k meets the surface that the samples about it show: as exact as the facets' posts, rounded to
// float, and infinite where all of them are. Pixels whose samples belong to surfaces that the ray does not meet nearby, or to
// more than two, are appended to `open`.
//
// `source` and `exact_source` must provide the same height grids, those of the samples (refine_row()). Throws what they throw.
void refine_round_row(const RoundRow& row, const FanSamples& fan, FacetSource& source,
                      FacetSource& exact_source, float* range, std::vector<OpenPixel>& open);

}  // namespace vpe::voxel
