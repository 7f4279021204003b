// Composite level control (Hitchner 1992, section 3.3): the number of levels of detail that a tile should have,
// as the weighted sum of three functions. All functions are pure.
//
//   distance   scale / x + offset, x = metres from the camera to the nearest point of the tile's terrain
//   centre     scale / x + offset, x = distance from the image centre in halves of the image's height
//   interest   the sum of the levels of the regions that contain the tile
//
// The first two may be lookup tables instead (vpe::core::LevelTable). With the metric kDistance, the functions
// select the level alone: the paper's LOD number is the integer part of weight * distance + weight * centre +
// weight * interest, truncated once, after the sum. It counts levels: a tile of level n has the LOD number n +
// 1, because levels count from 0 and the coarsest tile has one level of detail. With the metric kError, a
// tile's screen-space error counts as 2^(weight * centre + weight * interest) times itself; the distance is
// already part of that error and is not used.
//
// A tile is not a point, so its best point counts: the one nearest to the camera, the one nearest to the
// centre; a finer region counts if the tile touches it, a coarser region only if it contains the whole tile. So
// no point gets less detail than the functions give it, and parts of a tile that deserve less get it when the
// tile is refined.
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

// One function of x. Larger values of scale, offset and weight give finer tiles.
struct ControlFunction {
  double scale = 0;             // >= 0, in the unit of x
  double offset = 0;            // levels
  double weight = 0;            // >= 0; 0: the function is not evaluated
  vpe::core::LevelTable table;  // replaces scale and offset if it has rows
  double x_factor =
      1;  // > 0, factor on x; a time budget raises that of the distance, which makes tiles coarser
  bool operator==(const ControlFunction&) const = default;
};

// Returns the levels at x, not weighted. Infinite at x = 0 if the scale is not 0.
double levels(const ControlFunction& function, double x);

// A circle on the planet as a cap of directions.
struct ControlRegion {
  glm::dvec3 centre{1, 0, 0};
  double chord2 = 0;  // squared chord of its radius
  int levels = 0;
  bool operator==(const ControlRegion&) const = default;
};
ControlRegion control_region(const vpe::core::InterestRegion& region, double planet_radius_m);

// Returns the sum of the levels of all regions at a tile.
int interest_levels(std::span<const ControlRegion> regions, const mars::ChartRect& rect);

// Weights of what a budget takes: by how many of the levels that it takes tiles become coarser, according to where
// they are (the preference weightings of Hitchner 1992, section 3.3.4). With weights of 1 all lose alike, with 0 a
// tile loses nothing. `centre` holds at the image centre and fades into `distance` up to half an image height from it;
// `interest` holds in regions that ask for more levels.
struct DegradeWeights {
  double distance = 1;  // >= 0, as the next
  double centre = 1;
  double interest = 1;
  bool operator==(const DegradeWeights&) const = default;
};

// Returns true if all tiles lose alike.
inline bool is_even(const DegradeWeights& weights) { return weights == DegradeWeights(); }

// Describes the control of one view. The default has no effect: metric kError, weights and regions that do
// nothing.
struct LevelControl {
  vpe::core::LodMetric metric = vpe::core::LodMetric::kError;
  ControlFunction distance;
  ControlFunction centre;
  double interest_weight = 1;
  std::vector<ControlRegion> regions;
  DegradeWeights degrade;
  double coarsening = 1;  // >= 1, what a time budget takes at weight 1: a factor on errors, or on distances
  bool operator==(const LevelControl&) const = default;
};

// The centre of the field of view: the direction straight ahead of the full image, so that the parts of an
// image agree; not the middle of a shifted image. In flat images the distance from it is the distance in the
// image, infinite at 90 degrees; in panoramas it is the angle divided by half the vertical field of view.
struct CentreOfView {
  glm::dvec3 camera_m{0, 0, 0};
  glm::dvec3 forward{1, 0, 0};  // unit
  bool flat = true;
  double half_height = 1;  // tangent of half the vertical field of view; in panoramas that half, radians
};
CentreOfView centre_of_view(const vpe::core::View& view);

// Returns the least angle between forward and the directions from the camera to the points of a volume, in
// radians, with an error of at most 1e-7. Returns 0 for a camera inside and where forward meets the volume.
double least_angle_rad(const CentreOfView& centre, const cull::BoundingHexahedron& volume);

// Returns the distance from the centre at an angle, in halves of the image's height.
double centre_distance(const CentreOfView& centre, double angle_rad);

// The value of one function at a tile.
struct ControlTerm {
  double x = 0;       // metres, or halves of the image's height; 0 for regions
  double levels = 0;  // not weighted; 0 if the weight is 0
  double weight = 0;
  double weighted() const { return weight == 0.0 ? 0.0 : weight * levels; }
};
struct ControlTerms {
  ControlTerm distance;
  ControlTerm centre;
  ControlTerm interest;
  double centre_angle_rad = 0;
  double degrade_weight = 1;  // of the tile, between the weights of LevelControl::degrade
  double sum = 0;             // of the terms that the metric uses; may be infinite
};

// The properties of a tile that the functions use.
struct ControlInput {
  cull::BoundingHexahedron volume;
  mars::ChartRect rect;
  double min_distance_m = 0;
};

// Evaluates the functions at a tile. With `evaluate_all` it also computes the x of functions without weight.
ControlTerms control_terms(const LevelControl& control, const CentreOfView& centre, const ControlInput& input,
                           bool evaluate_all = false);

// Returns the factor on the coarsening of LevelControl that a tile's weight makes: 1 where all lose alike.
double degrade_factor(const LevelControl& control, double degrade_weight);

// Returns true if the metric is kError, the sum is 0 everywhere, and all tiles lose alike.
bool is_neutral(const LevelControl& control);

// Metric kError: returns the levels by which a tile's error counts more, at most kMaxShift either way.
inline constexpr double kMaxShift = vpe::core::InterestLimits::kMaxLevels;
double level_shift(double sum);

// Metric kDistance: returns the paper's LOD number of a sum, 1 .. kMaxLevel + 1. The wanted level is one less.
int wanted_level_count(double sum);

// Return the paper's LOD number of a tile (its level + 1), and of one of its meshes. Inner tiles have one mesh.
// The full grid of a finest tile has the number of the tile; its coarser meshes count as fractions of a level,
// so that budgets can stop between them.
inline int level_count(const TileKey& key) { return key.level + 1; }
double level_count(const TileKey& key, int variant, int variants);

// Throws std::invalid_argument for numbers out of range.
void check(const LevelControl& control);

}  // namespace lod
