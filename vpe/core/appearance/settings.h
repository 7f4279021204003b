// The settings registry: everything about how an image is drawn that `--set KEY=VALUE`, a flight's `set` and
// `vpe settings` can name. Each key is declared once (settings.cpp) with its type, range, default, unit and
// meaning; the drawing code reads the plain struct SettingsValues.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "vpe/core/appearance/appearance.h"
#include "vpe/core/appearance/level_table.h"
#include "vpe/core/appearance/overlays.h"

namespace vpe::core {

// What decides how fine a tile is drawn (lod/control.h).
enum class LodMetric {
  kError,     // its projected error, in pixels
  kDistance,  // its distance and place in the image alone, as in 1992
};

// What is shown of how the image is made.
enum class Inspect {
  kNone,
  kBorders,  // lines along the borders of tiles
  kLevels,   // tiles tinted by their level (vpe/core/appearance/inspect.h)
};

// How the ray backend looks for the ground.
enum class RayMode {
  kExact,     // the exact surface
  kMultires,  // cells about as wide as a pixel, far away
  kPlain,     // each ray by itself in fixed steps, as in the papers: what the others are measured against
};

enum class Occlusion { kAuto, kOff, kOn };

// Of rays.cell.
struct RayLimits {
  static constexpr double kLeastCell_px = 1.0 / 64;
  static constexpr double kMostCell_px = 64;
};

struct SettingsValues : Appearance, Overlays {
  double lod_tolerance_px = 1;
  int lod_triangles = 0;
  LodMetric lod_metric = LodMetric::kError;
  double lod_distance_scale_m = 1e6;
  double lod_distance_offset = 3;
  double lod_distance_weight = 1;
  LevelTable lod_distance_table;
  double lod_centre_scale = 0.25;
  double lod_centre_offset = -1;
  double lod_centre_weight = 0;
  LevelTable lod_centre_table;
  double lod_interest_weight = 1;
  double lod_frame_ms = 0;
  Occlusion occlusion = Occlusion::kAuto;
  RayMode ray_mode = RayMode::kExact;
  double ray_cell_px = 1;
  int samples = 1;
  bool smooth_edges = true;
  Inspect inspect = Inspect::kNone;

  bool operator==(const SettingsValues&) const = default;
};

enum class SettingType { kNumber, kInteger, kChoice, kTable, kText };

// What `vpe settings` shows of a key.
struct SettingInfo {
  std::string_view key;
  SettingType type = SettingType::kNumber;
  double min = 0;  // numbers and integers, both ends allowed
  double max = 0;
  std::vector<std::string_view> choices;  // words allowed, for kChoice
  std::string grammar;                    // what is allowed, for kTable and kText
  std::string default_text;
  std::string_view unit;  // empty for pure numbers and words
  std::string_view meaning;
};

// A value of every key. Regular type; functions of one object follow the usual const rule for threads.
class Settings {
 public:
  // All keys in the order in which people should read them.
  static std::span<const SettingInfo> list();

  // Sets one key from text. Returns what is wrong, empty when all is well; on an error nothing changes.
  // An unknown key's error names the keys that are spelled nearly so, a bad value's error what is allowed.
  [[nodiscard]] std::string set(std::string_view key, std::string_view text);

  // The same from "KEY=VALUE".
  [[nodiscard]] std::string assign(std::string_view assignment);

  // The value as text that set() reads back to the same bits; nothing for an unknown key.
  std::optional<std::string> get(std::string_view key) const;

  const SettingsValues& values() const { return values_; }

  bool operator==(const Settings&) const = default;

 private:
  SettingsValues values_;
};

}  // namespace vpe::core
