// Columns: half-planes through the camera's vertical, cast up to kMaxLanes at once over the posts of one tile.
//
// The method: let E = |E| U be the camera's position and A the unit azimuth vector of a column (A . U = 0). For
// a point p of any length let sigma = A . p, C = U . p and z = C - |E| w |p|, where w |p| is |p| over the
// point's radius. Then the ray of elevation e is the straight line z = tan(e) sigma. Going outward, the
// steepest z / sigma so far is the floating horizon. It resolves the image's rows from the lowest one upward:
// each row by the first edge of the reference surface that reaches it. Derivation and figures:
// docs/design/rays.md; the idea of casting columns coherently: Cohen-Or 1996, Wan 1999, section 4.
//
// Stage of the pipeline (vpe/voxel/ray_renderer.h): cast_columns() (column_batch.h) prepares a ColumnGroup,
// ColumnWalk (column_walk.h) calls walk_grid() for one tile after the other, and expand_rows() and copy_rows()
// turn the result into ranges. The functions are compiled for several instruction sets in column_kernel.cpp.
//
// Typical usage, for a group whose rows, azimuths and buffers are set:
//   update_least_slope(rows, group);
//   for (each height grid from near to far) {
//     walk_grid(frame, source, camera, up_in_face, rows, group);
//     update_least_slope(rows, group);  // group.least_slope is infinite when all rows are resolved
//   }
//   expand_rows(rows, group, 0, rows.count, out, stride);
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>

#include "vpe/voxel/columns/height_grid.h"

namespace vpe::voxel {

inline constexpr int kMaxLanes = 16;

// Selects how the slopes tan(e) of an image's rows are computed. Slopes rise with the row.
enum class RowKind : std::uint8_t {
  kEven,    // slope = (row - centre) step
  kTable,   // slope from a table; rows are about even in elevation
  kSector,  // slope = (a0 + a1 row) / (b0 + b1 row), with coefficients of each column
};

// Describes the rows that all columns of a batch share.
struct Rows {
  RowKind kind = RowKind::kEven;
  int count = 0;
  double centre = 0;
  double step = 0;
  const float* slope = nullptr;         // count + 1 entries, the last infinite
  const double* slope_exact = nullptr;  // the same in double
  const float* length = nullptr;        // sqrt(1 + slope^2); not for kSector
  double first_elevation = 0;           // of row 0, radians
  double elevation_step = 0;            // radians
  // ColumnGroup::start holds ranges from the camera, each for all rows of its run, as walk_grid_discretely() stores them.
  bool has_ranges = false;
};

// Describes the camera of all columns. Vectors are body-fixed.
struct ColumnCamera {
  glm::dvec3 up{0, 0, 1};
  double distance_m = 0;  // |E|
  double radius_m = 0;    // of the sphere
  double ground_m = 0;    // radius of the reference surface below the camera, as exaggerated; less than |E|
};

// Holds the state of up to kMaxLanes neighbouring columns. Rows [row, row_end) of a column are not resolved
// yet. A run of resolved rows that show one facet is stored at its last row: `start[row * kMaxLanes + lane * value_step()]`
// is the inverse horizontal distance there, which changes by `gain` (at most 0, same index) per unit of slope. Lower rows are
// nearer, so their inverse distances are sums of positive terms, exact but for rounding. `start` is 0 elsewhere.
struct ColumnGroup {
  alignas(64) double azimuth[3][kMaxLanes];  // A, in the axes of the current face
  alignas(64) double normal[3][kMaxLanes];   // A x U, in the axes of the current face
  alignas(64) double sector_a0[kMaxLanes];   // slope coefficients for RowKind::kSector
  alignas(64) double sector_a1[kMaxLanes];
  alignas(64) double sector_b0[kMaxLanes];
  alignas(64) double sector_b1[kMaxLanes];
  alignas(64) float row[kMaxLanes];      // whole numbers
  alignas(64) float row_end[kMaxLanes];  // whole numbers; 0 for lanes beyond `columns`
  // Rows from here on need not be resolved, and may be or not; does not change the rows before.
  alignas(64) float row_stop[kMaxLanes];
  // The run that expand_rows() has reached.
  alignas(64) float run_start[kMaxLanes];
  alignas(64) float run_gain[kMaxLanes];
  alignas(64) float run_slope[kMaxLanes];
  // For one row more than there are, at a multiple of 64 bytes. `gain` is start + 1 where value_step() is 2.
  float* start = nullptr;
  float* gain = nullptr;
  double least_slope = 0;  // of all unresolved rows before row_stop; infinite when there are none
  int columns = 0;
};

// Provides the posts of one height grid to the kernel, when it asks for them.
class HeightGridSource {
 public:
  virtual ~HeightGridSource() = default;
  virtual const HeightGridLines<float>& lines(LineFamily family) = 0;
  virtual const HeightGridLines<double>& exact_lines(LineFamily family) = 0;
};

// Walks all columns through one height grid and resolves rows. The group must have gone through everything
// nearer to the camera before. `up` is the camera's vertical in the face's axes. Lines within kExactLines of
// the point below the camera are read in double where needs_exact() says so. Every crossing with an edge
// counts, so facets are exact but for rounding (RangeCaster::range_error). A column's result does not depend on
// the other columns of its group.
void walk_grid(const HeightGridFrame& frame, HeightGridSource& source, const ColumnCamera& camera,
               const glm::dvec3& up, const Rows& rows, ColumnGroup& group);
inline constexpr int kExactLines = 24;

// Returns true if the camera is so low that the cells below it need double.
bool needs_exact(const HeightGridFrame& frame, const ColumnCamera& camera);

// Sets group.least_slope from the unresolved rows before row_stop.
void update_least_slope(const Rows& rows, ColumnGroup& group);

// Writes the ranges of rows [first, last) for all columns to out[(row - first) * stride + lane], and clears
// `start` and `gain` of these rows. Ranges are metres from the camera, infinite where no ground was met. Calls
// must take the rows from the highest resolved or wanted one downward, in any number of pieces. Requires last <=
// rows.count.
void expand_rows(const Rows& rows, ColumnGroup& group, int first, int last, float* out, std::ptrdiff_t stride);

// Copies rows of floats. Strides count floats and may be negative. `stream` writes past the caches: faster for
// images that do not stay in them, slower for small ones that are read next.
void copy_rows(const float* from, std::ptrdiff_t from_stride, float* to, std::ptrdiff_t to_stride, int columns,
               int rows, bool stream);

// Returns the number of columns that this machine casts at once, at most kMaxLanes.
int column_lanes();

// Returns how many floats a column's value in ColumnGroup::start and gain is before the next column's: 2 where both alternate, which
// ranges (Rows::has_ranges) never do, else 1.
int value_step();

// Returns the name of the instruction set that is used.
const char* column_target();

}  // namespace vpe::voxel
