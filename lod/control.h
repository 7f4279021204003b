// Composite level control (Hitchner 1992, section 3.3): how many levels of detail a tile should have, as the
// weighted sum of three functions. Pure functions.
//
//   distance   scale / x + offset, x = metres from the camera to the nearest point of the tile's terrain
//   centre     scale / x + offset, x = distance from the image's centre in halves of the image's height
//   interest   the sum of the levels of the regions that the tile is in
//
// The first two may be lookup tables instead (vpe::core::LevelTable). Rule hitchner draws a tile whose number
// (1 = the roots, one more a level down) is the integer part of weight * distance + weight * centre + weight *
// interest, taken once, of the sum. Rule error counts a tile's projected error 2^(weight * centre + weight *
// interest) times; distance is in the projection already and does not count again.
//
// A tile is no point. It is taken at its best place: nearest to the camera, nearest to the centre, in each finer
// region that it touches, in a coarser region only when it lies in it as a whole. So no place gets less than
// the functions give it, and parts of a tile that deserve less get it when it is refined.
#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "cull/bounding_region.h"
#include "lod/tree/tile_key.h"
#include "vpe/core/appearance/settings.h"
#include "vpe/core/interest.h"
#include "vpe/core/view.h"

namespace lod {

struct ControlFunction {
  double scale = 0;             // >= 0, in the unit of x
  double offset = 0;            // levels
  double weight = 0;            // >= 0; 0: the function is not evaluated
  vpe::core::LevelTable table;  // in place of scale and offset when it has rows
  double x_factor = 1;          // > 0; x counts this many times: what a time budget turns
};

// Not weighted. Infinite at x = 0 when the scale is not 0.
double levels(const ControlFunction& function, double x);

// A circle on the planet as a cap of directions.
struct ControlRegion {
  glm::dvec3 centre{1, 0, 0};
  double chord2 = 0;  // squared chord of its radius
  int levels = 0;
};
ControlRegion control_region(const vpe::core::InterestRegion& region, double planet_radius_m);

// Levels of all regions at a tile, added up.
int interest_levels(std::span<const ControlRegion> regions, const mars::ChartRect& rect);

// Without any effect by default: rule error, and weights and regions that do nothing.
struct LevelControl {
  vpe::core::LodMetric rule = vpe::core::LodMetric::kError;
  ControlFunction distance;
  ControlFunction centre;
  double interest_weight = 1;
  std::vector<ControlRegion> regions;
};

// Where the centre of the field of view is: the direction straight ahead of the full image, so that the parts
// of an image agree; not the middle of a shifted one. In flat images the distance from it is that in the
// image, infinite 90 degrees off; in panoramas the angle over half the vertical field of view.
struct CentreOfView {
  glm::dvec3 camera_m{0, 0, 0};
  glm::dvec3 forward{1, 0, 0};  // unit
  bool flat = true;
  double half_height = 1;  // tangent of half the vertical field of view; in panoramas that half, radians
};
CentreOfView centre_of_view(const vpe::core::View& view);

// Least angle between forward and the directions from the camera to the points of a volume, radians, right within
// 1e-7; 0 for a camera inside and where forward meets the volume.
double least_angle_rad(const CentreOfView& centre, const cull::BoundingHexahedron& volume);

// Distance from the centre at an angle, in halves of the image's height.
double centre_distance(const CentreOfView& centre, double angle_rad);

// What control found for a tile.
struct ControlTerm {
  double x = 0;       // metres; halves of the height; regions have none
  double levels = 0;  // not weighted; 0 when the weight is
  double weight = 0;
  double weighted() const { return weight == 0.0 ? 0.0 : weight * levels; }
};
struct ControlTerms {
  ControlTerm distance;
  ControlTerm centre;
  ControlTerm interest;
  double centre_angle_rad = 0;
  double sum = 0;  // of what the rule counts; may be infinite
};
struct ControlPlace {
  cull::BoundingHexahedron volume;
  mars::ChartRect rect;
  double min_distance_m = 0;
};
// evaluate_all: also the x of functions without weight.
ControlTerms control_terms(const LevelControl& control, const CentreOfView& centre, const ControlPlace& place,
                           bool evaluate_all = false);

// Whether the sum is 0 in rule error, everywhere.
bool is_neutral(const LevelControl& control);

// Rule error: levels that a tile's error counts more, at most this many either way.
inline constexpr double kMaxShift = vpe::core::InterestLimits::kMaxLevels;
double level_shift(double sum);

// Rule hitchner: the LOD number wanted, 1 .. kMaxLevel + 1.
int wanted_lod(double sum);

// The number of 1992 of a tile, and of its mesh. Inner tiles have one mesh. A finest tile's data in full is its
// full grid; its coarser meshes count as parts of a level, so that budgets can stop between.
inline int lod_number(const TileKey& key) { return key.level + 1; }
double lod_number(const TileKey& key, int variant, int variants);

// Throws std::invalid_argument for numbers out of range.
void check(const LevelControl& control);

}  // namespace lod
