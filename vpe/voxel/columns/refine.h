// Refinement: moves ranges from samples near a pixel to the pixel's own ray.
//
// Stage of the pipeline (vpe/voxel/ray_renderer.h): after the columns of a perspective image. SectorCaster
// takes the two samples on either side of each pixel as hints (hints_from_row(), hints_from_columns()).
// refine_block() intersects the pixel's ray with the facet at its hint, then with the facet at that place, until
// the facet stays the same. What it cannot resolve SectorCaster casts as single rays (the retrace of Wan 1999,
// section 4). The functions are compiled for several instruction sets in refine_kernel.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "mars/geodesy/cube.h"
#include "vpe/voxel/columns/height_grid.h"

namespace vpe::voxel {

// Describes the facets of one height grid. Posts are in float or, below the camera, in double.
struct Facets {
  std::uint64_t id = 0;  // of the height grid
  mars::Face face = mars::Face::kPlusX;
  HeightGridFrame frame;
  LineFamily family = LineFamily::kColumns;
  const HeightGridLines<float>* lines = nullptr;
  const HeightGridLines<double>* exact_lines = nullptr;  // used where set
};

// Provides the facets of any place.
class FacetSource {
 public:
  virtual ~FacetSource() = default;
  // Returns the height grid over or under a point. The reference is valid until the next call.
  virtual const Facets& at(const glm::dvec3& place_m) = 0;
};

// The most columns and rows of a block of pixels.
inline constexpr int kRayBlockColumns = 128;
inline constexpr int kRayBlockRows = 32;

// Describes the rays of a block of pixels.
struct RayBlock {
  glm::dvec3 camera_m;
  double radius_m = 0;  // of the sphere
  glm::dvec3 first;     // of row 0 and column 0, of any length
  glm::dvec3 step;      // from column to column
  glm::dvec3 down;      // from row to row
  int columns = 0;      // at most kRayBlockColumns
  int rows = 0;         // at most kRayBlockRows
  // Returns the direction of a pixel's ray, of any length.
  glm::dvec3 ray(int row, int column) const {
    return first + static_cast<double>(column) * step + static_cast<double>(row) * down;
  }
};

// Provides the hints of a block.
class BlockHints {
 public:
  virtual ~BlockHints() = default;
  // Sets the hints of all pixels of a row: ranges of the samples on either side of pixel k, which lies share[k] of the way from a[k]
  // to b[k].
  virtual void get(int row, float* a, float* b, float* share) = 0;
};

// Names a pixel of a block, with its hints.
struct UnresolvedPixel {
  int row = 0;
  int column = 0;
  float a = 0;
  float b = 0;
};

// Writes to range[row stride + column] where a pixel's ray meets the surface between its hints. The result is as exact as the
// facets' posts, rounded to float, and infinite where both hints are. Pixels whose hints belong to different
// surfaces, and pixels that find no facet, keep the nearer hint and are appended to `unresolved`.
//
// A ray whose hints are apart and that misses the surface of the nearer one may still meet a crest there. It is searched for ground
// up to what it meets behind or the end of the height grid, at places half a post apart at first, at their facets; what is narrower
// is passed over.
//
// Pixels of a block share vectors, so the last bits of one may depend on what else is in its block, but on nothing beside it.
//
// `source` and `exact_source` must provide the same height grids; they are two because the kernel alternates
// between posts in float and in double, and each source remembers its last grid. Throws what they and `hints` throw.
void refine_block(const RayBlock& block, BlockHints& hints, FacetSource& source, FacetSource& exact_source,
                  float* range, std::ptrdiff_t stride, std::vector<UnresolvedPixel>& unresolved);

// Describes the rays of neighbouring pixels: the direction of pixel k is first + k step, of any length.
struct RayRow {
  glm::dvec3 camera_m;
  double radius_m = 0;  // of the sphere
  glm::dvec3 first;
  glm::dvec3 step;
  int count = 0;
};

// Does for a row of any length what refine_block() does: hints of pixel k are a[k], b[k] and share[k], and its range is range[k].
void refine_row(const RayRow& row, const float* a, const float* b, const float* share, FacetSource& source,
                FacetSource& exact_source, float* range, std::vector<int>& unresolved);

// Finds the hints of `count` pixels in one row of at least two samples: pixel k lies at position first + k step among the
// samples, between a[k] and b[k]. A pixel beyond the samples lies at the outermost one.
void hints_from_row(const float* samples, int sample_count, double first, double step, int count, float* a,
                    float* b, float* share);

// Finds the hints of `count` pixels in as many rows of samples: pixel k lies at position scale[k] y + shift[k]
// of the row samples[k * lines ...].
void hints_from_columns(const float* samples, int lines, const float* scale, const float* shift, float y,
                        int count, float* a, float* b, float* share);

// Writes to index[k] which sample of row k of samples[k * lines ...] is the nearest to pixel k: with a scale and a shift for each
// pixel, side by side in `maps`, that at (scale s + shift - first_line) per_spacing, rounded.
void nearest_in_columns(int lines, const double* maps, double s, double first_line, double per_spacing,
                        int count, std::int32_t* index);

}  // namespace vpe::voxel
