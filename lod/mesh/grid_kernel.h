// Bounds of the distances between a row of posts and the coarse facets over it, in vectors. Internal to lod; use
// lod/mesh/grid_meter.h.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace lod {

// The planes of one facet of each cell, at the columns of a strip of cells: the value where the strip begins and the slope
// along v, of depth and of length.
struct StripPlanes {
  std::vector<double> depth, depth_dv;
  std::vector<double> length, length_dv;
};

// A strip of coarse cells along u with the fine columns of each cell from its western to its eastern line, so that lines
// between cells occur twice. All arrays have `count` entries, a multiple of kStripStep.
struct GridStrip {
  std::size_t count = 0;
  std::vector<double> x;  // the place of a column in its cell, 0 to 1
  StripPlanes low;        // facets below the diagonals of cells
  StripPlanes high;       // facets above them

  // Makes room for some columns; entries beyond them are depths and lengths of 1, as those of a row must be.
  void resize(std::size_t columns);
};
inline constexpr std::size_t kStripStep = 4;

// A row of fine posts at the columns of a strip.
struct StripRow {
  const double* depth;
  const double* length;
  double dv;      // from where the strip begins
  double y;       // in cells
  double margin;  // posts this close to the diagonal, in cells, count with both facets
};

// The largest differences of a row relative to the lengths of directions: D of depths, L of lengths, and
// |D| depth_weight + |L|.
struct StripDifferences {
  double depth = 0;
  double length = 0;
  double both = 0;
};

// Returns bounds of the differences, up to rounding of 1e-15.
StripDifferences strip_differences(const GridStrip& strip, const StripRow& row, double depth_weight);

}  // namespace lod
