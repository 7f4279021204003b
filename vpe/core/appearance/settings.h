// The settings registry: all properties of an image that `--set KEY=VALUE`, a flight's `set` and the panels of
// the window can change.
//
// settings.cpp declares each key once, with its type, range, unit and meaning; the default is the initial value
// of the member in SettingsValues. The drawing code reads the plain struct SettingsValues.
//
// Typical usage:
//   Settings settings;
//   if (const std::string problem = settings.assign("sun.azimuth=90"); !problem.empty()) report(problem);
//   draw(settings.values().sun_azimuth_deg);
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "vpe/core/appearance/appearance.h"
#include "vpe/core/appearance/overlays.h"
#include "vpe/core/registry/level_table.h"

namespace vpe::core {

// The measure that selects the level of a tile (lod/control.h).
enum class LodMetric {
  kError,     // its screen-space error
  kDistance,  // only its distance and place in the image, by the level control functions of Hitchner 1992
};

// The method by which the ray backend finds the ground.
enum class RayMode {
  kExact,         // intersects the reference surface exactly
  kMultires,      // intersects cells about as wide as a pixel, far away
  kReference,     // follows each ray by itself in fixed steps, as the papers do: the baseline of comparisons
  kPerturbation,  // intersects smooth patches through the posts of the reference surface, in place of flat facets
  kDiscrete,      // samples one voxel at each grid line of a column's path (Cohen-Or 1996)
  kVolume,        // samples volumes of densities that are made of the posts (Wan, Qu and Kaufman 1999)
  kBoundary,      // the same, up to the first cell of a volume that its surface passes
};

// The heights between posts with RayMode::kPerturbation.
enum class RayPatch {
  kBicubic,   // with slopes that go on from cell to cell
  kBilinear,  // without a step, but with a crease at each line of posts
};

// The columns of an image with RayMode::kDiscrete.
enum class RayColumns {
  kSectors,  // vertical planes, whatever the pitch and roll
  kLines,    // parallel lines of pixels, each taken as a vertical plane
};

// The ray whose range a pixel of a perspective image has with RayMode::kExact and kMultires.
enum class RaySample {
  kAuto,   // kNearest where images have several samples a pixel and in windows whose camera moves, else kPixel
  kPixel,  // the pixel's own ray
  kNearest,  // that of the nearest column
};

// The densities of a volume with RayMode::kVolume and kBoundary.
enum class RayVolumeFilter {
  kNone,      // full or empty
  kGaussian,  // smoothed by a Gaussian
  kBox,       // by the distance from the ground
};

enum class Occlusion { kAuto, kOff, kOn };

// Limits of rays.cell, rays.ratio, rays.spacing, rays.fovea and rays.volume.step.
struct RayLimits {
  static constexpr double kLeastCell_px = 1.0 / 64;
  static constexpr double kMostCell_px = 64;
  static constexpr double kLeastRatio = 1.0 / 16;
  static constexpr double kMostRatio = 64;
  static constexpr double kLeastSpacing_px = 0.25;
  static constexpr double kMostSpacing_px = 4;
  static constexpr double kLeastFovea = 0.05;
  static constexpr double kMostFovea = 0.95;
  static constexpr double kLeastVolumeStep = 0.05;
  static constexpr double kMostVolumeStep = 2;
};

// The values of all settings. The keys of the inherited members are in settings.cpp too.
struct SettingsValues : Appearance, Overlays {
  // Largest screen-space error of a drawn tile. Smaller: finer, slower; 0: the reference surface itself. At 1
  // the error is not visible in a still image.
  double lod_tolerance_px = 1;
  // Upper limit of the triangles of a frame; 0: none. Smaller: coarser where the tolerance asks for more.
  int lod_triangles = 0;
  LodMetric lod_metric = LodMetric::kError;
  // Levels by distance: scale / x + offset, or the table where it has rows. Used with LodMetric::kDistance.
  // Larger values give finer tiles.
  double lod_distance_scale_m = 1e6;
  double lod_distance_offset = 3;
  double lod_distance_weight = 1;
  LevelTable lod_distance_table;
  // Levels by distance from the image centre, in halves of the image's height. The weight 0 switches them off.
  double lod_centre_scale = 0.25;
  double lod_centre_offset = -1;
  double lod_centre_weight = 0;
  LevelTable lod_centre_table;
  double lod_interest_weight = 1;  // factor on the levels of regions of interest
  // Weigh what a budget takes, by where tiles are: away from the image centre and from regions of interest, at the
  // centre, in such regions (lod/control.h). 1: all lose alike; larger: they lose more levels; 0: none.
  double degrade_distance = 1;
  double degrade_centre = 1;
  double degrade_interest = 1;
  // Time of a frame while the camera moves; 0: no limit. Smaller: smoother motion, coarser images.
  double lod_frame_ms = 0;
  Occlusion occlusion = Occlusion::kAuto;
  RayMode ray_mode = RayMode::kExact;
  RayPatch ray_patch = RayPatch::kBicubic;
  // RayMode::kMultires: largest distance between a cell and the surface, in the image. Smaller: finer, slower.
  double ray_cell_px = 1;
  // RayMode::kExact, kMultires, perspective: kNearest is faster, and pixels show rays up to half a spacing away.
  RaySample ray_sample = RaySample::kAuto;
  // RayMode::kExact, kMultires, perspective: distance of columns in the image. Smaller: finds narrower ridges, slower.
  double ray_spacing_px = 1;
  // RayMode::kMultires, perspective: the share of each side of the image, about its middle, that has a ray for each
  // pixel; the rest has half as many columns and rows. Smaller: faster, less is sharp. nullopt: all of the image.
  std::optional<double> ray_fovea;
  // RayMode::kDiscrete: largest width of a voxel in the image, in pixels. Smaller: sharper, slower in proportion.
  double ray_ratio = 1;
  bool ray_blend = false;  // RayMode::kDiscrete: levels of heights and colours fade into each other by distance
  // RayMode::kDiscrete: rays in each pixel, one above the other, which share the walk of their column. More: smoother where the
  // ground is seen at a grazing angle.
  int ray_vertical = 1;
  RayColumns ray_columns = RayColumns::kSectors;
  RayVolumeFilter ray_volume_filter = RayVolumeFilter::kGaussian;
  // RayMode::kVolume, kBoundary: interval of samples, in voxels. Smaller: narrower ridges are met, slower.
  double ray_volume_step = 0.6;
  // RayMode::kVolume: tiles nearer than this are cast by densities, the others by boundary cells. Smaller: faster, rougher.
  // nullopt: all by densities.
  std::optional<double> ray_volume_near_m;
  std::string scene;         // path of a scene file (objects/files/scene_file.h); "": no objects
  int samples = 1;           // colour samples in each pixel; more: smoother edges, slower
  bool smooth_edges = true;  // smooths stair steps where there is one sample in each pixel

  bool operator==(const SettingsValues&) const = default;
};

// Returns true if each pixel shows a single ray, so that pixels can be drawn one by one or carried to another image.
inline bool has_one_ray_a_pixel(const SettingsValues& settings) {
  return settings.samples <= 1 && (settings.ray_mode != RayMode::kDiscrete || settings.ray_vertical == 1);
}

enum class SettingType { kNumber, kInteger, kChoice, kTable, kText };

// Describes a key for lists, help texts and panels.
struct SettingInfo {
  std::string_view key;
  SettingType type = SettingType::kNumber;
  double min = 0;  // numbers and integers; both ends are allowed
  double max = 0;
  std::string_view word;                  // allowed in place of a number; empty: none
  std::vector<std::string_view> choices;  // words allowed, for kChoice
  std::string grammar;                    // what is allowed, for kTable and kText
  std::string default_text;
  std::string_view unit;  // empty for pure numbers and words
  std::string_view meaning;
};

// Holds a value of every key. Regular type. Different threads may use different objects, and the const members
// of one object.
class Settings {
 public:
  // Returns all keys by their current names, in the order in which people should read them.
  static std::span<const SettingInfo> list();

  // Sets one key from text. Accepts former names of keys and values (former_names.h). Returns "", or what is
  // wrong; then nothing changes. The message for an unknown key names the keys that are spelled nearly like it,
  // the message for a bad value what is allowed.
  [[nodiscard]] std::string set(std::string_view key, std::string_view text);

  // Does the same from "KEY=VALUE".
  [[nodiscard]] std::string assign(std::string_view assignment);

  // Returns the value as text that set() reads back to the same bits, or nullopt for an unknown key. Accepts
  // former names of keys; values have their current names.
  std::optional<std::string> get(std::string_view key) const;

  const SettingsValues& values() const { return values_; }

  bool operator==(const Settings&) const = default;

 private:
  SettingsValues values_;
};

}  // namespace vpe::core
