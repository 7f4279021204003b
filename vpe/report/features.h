// Costs of features that a scene can do without: used, not used, and not compiled in.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "vpe/report/table.h"

namespace vpe::report {

// Costs of one process that drew a scene. nullopt: not measured.
struct SceneCost {
  std::optional<double> peak_mb;      // of the process
  std::optional<double> startup_s;    // from starting the process to the first finished image
  std::optional<double> frame_s;      // median, with all tiles loaded
  std::optional<double> processor_s;  // of all threads for such a frame
  std::optional<double> resident_mb;  // counted by the renderer: payloads of tiles on CPU and GPU
};

// Returns the median of each figure over interleaved processes, nullopt where none has it.
SceneCost median_cost(std::span<const SceneCost> rounds);

struct FeatureCost {
  std::string feature;
  std::string backend;
  std::string compared;  // the scene without the feature, such as "bare"
  SceneCost off;
  SceneCost on;
  SceneCost never;                    // of a program built without it, in the scene without it
  std::optional<double> frame_ratio;  // on to off, in interleaved rounds of one process
  std::optional<double> never_ratio;  // processor time of frames, off to never, of interleaved processes
  std::string note;                   // such as why it cannot be left out of the program
};

// Returns a row for each feature and backend: feature, backend, compared, then peak_mb, startup_s, frame_ms,
// processor_ms and resident_mb each _off, _on, _never; frame_ratio, never_ratio, note.
Table feature_table(std::span<const FeatureCost> costs);

}  // namespace vpe::report
