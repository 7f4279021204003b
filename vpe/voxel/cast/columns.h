// Columns: half-planes through the planet's axis of the camera, cast many at once.
//
// With the camera E = |E| U, a column is the half-plane of U and a unit azimuth vector A (A . U = 0). For a point
// p of any length sigma = A . p, C = U . p and z = C - |E| w |p| (w |p|: over its inverse radius) make every
// ray of elevation e in it the straight line z = tan(e) sigma (docs/rays.md). Going outward, the steepest z /
// sigma so far is the floating horizon: the rows below it are resolved, lowest first, each by the first edge of
// S that reaches it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>

#include "vpe/voxel/cast/height_grid.h"

namespace vpe::voxel {

inline constexpr int kMaxLanes = 16;

// Slopes tan(e) of an image's rows, rising with the row.
enum class RowKind : std::uint8_t {
  kEven,    // slope = (row - centre) step
  kTable,   // from a table; rows are about even in elevation
  kSector,  // slope = (a0 + a1 row) / (b0 + b1 row), for each column its own
};

struct Rows {
  RowKind kind = RowKind::kEven;
  int count = 0;
  double centre = 0;
  double step = 0;
  const float* slope = nullptr;  // count + 1 entries, the last infinite
  const double* slope_exact = nullptr;
  const float* length = nullptr;  // sqrt(1 + slope^2); not for fans
  double first_elevation = 0;     // of row 0, radians
  double elevation_step = 0;
};

// Where all columns stand. Vectors are body-fixed.
struct ColumnCamera {
  glm::dvec3 up{0, 0, 1};
  double distance_m = 0;  // |E|
  double radius_m = 0;    // of the sphere
  double ground_m = 0;    // radius of S below the camera, as exaggerated; less than |E|
};

// State of up to kMaxLanes neighbouring columns. Rows [row, row_end) of a column are not resolved yet; a
// resolved run of rows that one facet shows begins with its first row's inverse horizontal distance in
// `start[row * kMaxLanes + lane]`, which falls by `gain` per unit of slope; start is 0 elsewhere.
struct ColumnGroup {
  int columns = 0;
  alignas(64) double azimuth[3][kMaxLanes];  // A, in the axes of the face at hand
  alignas(64) double normal[3][kMaxLanes];   // A x U, likewise
  alignas(64) double sector_a0[kMaxLanes];
  alignas(64) double sector_a1[kMaxLanes];
  alignas(64) double sector_b0[kMaxLanes];
  alignas(64) double sector_b1[kMaxLanes];
  alignas(64) float row[kMaxLanes];      // whole numbers
  alignas(64) float row_end[kMaxLanes];  // likewise; 0 for lanes beyond `columns`
  float* start = nullptr;                // rows * kMaxLanes, at a multiple of 64 bytes
  float* gain = nullptr;
  double least_slope = 0;  // of all rows that are not resolved; infinite when there are none
  // The run that expand_rows() is in.
  alignas(64) float run_start[kMaxLanes];
  alignas(64) float run_gain[kMaxLanes];
  alignas(64) float run_slope[kMaxLanes];
};

// What the kernel reads of one lattice; made when asked for.
class HeightGridSource {
 public:
  virtual ~HeightGridSource() = default;
  virtual const HeightGridLines<float>& lines(LineFamily family) = 0;
  virtual const HeightGridLines<double>& exact_lines(LineFamily family) = 0;
};

// Walks all columns through one lattice and resolves rows. The group must have gone through everything before
// it, as seen from the camera. up: of the camera, in the face's axes. Lines within kExactLines of the camera's foot are
// read in double, where needs_exact() says so. Every crossing with an edge counts, so that facets are exact but
// for rounding (RangeCaster::range_error). Results of a column do not depend on the others of its group.
void walk_grid(const HeightGridFrame& frame, HeightGridSource& source, const ColumnCamera& camera,
               const glm::dvec3& up, const Rows& rows, ColumnGroup& group);
inline constexpr int kExactLines = 24;

// Whether the camera is so low that the cells about its foot need double.
bool needs_exact(const HeightGridFrame& frame, const ColumnCamera& camera);

// Sets least_slope from the rows that are left.
void update_least_slope(const Rows& rows, ColumnGroup& group);

// Writes ranges (float, from the camera; infinity where no ground was met) of rows [first, last) for all columns:
// out[(row - first) * stride + lane], and clears `start` for them. Rows are taken from 0 upward, in as many
// calls as one likes. last <= rows.count.
void expand_rows(const Rows& rows, ColumnGroup& group, int first, int last, float* out, std::ptrdiff_t stride);

// Copies rows of floats; strides count floats and may be negative. stream: past the caches, for images that
// would not stay in them.
void copy_rows(const float* from, std::ptrdiff_t from_stride, float* to, std::ptrdiff_t to_stride, int columns,
               int rows, bool stream);

// Columns that are cast at once on this machine, at most kMaxLanes; and the name of its vector unit.
int column_lanes();
const char* column_target();

}  // namespace vpe::voxel
