// Measures every scene of `vpe report features` with every backend: in processes of their own, and in
// interleaved rounds within one process.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vpe/app/report/feature_probe.h"
#include "vpe/gl/context.h"
#include "vpe/report/interleaved_timing.h"

namespace vpe::app {

struct FeaturePlan {
  ProbeRequest probe;   // without program, scene and backend
  std::string against;  // another program; empty: none
  int rounds = 9;       // of frames; more: more reliable medians
  int starts = 3;       // of each process
};

// One scene and backend with its measurements.
struct FeatureRow {
  const FeatureScene* scene = nullptr;
  core::Backend backend = core::Backend::kPolygon;
  report::SceneCost cost;           // of this program's processes
  report::SceneCost never;          // of the other program's, if it draws this scene
  std::vector<double> processor_s;  // of a frame, one for each process
  std::vector<double> never_processor_s;
  report::Timing frames;
  std::optional<double> rest_ratio;  // time of a frame, relative to the sum of its counted stages
};

// Returns the rows that this program can draw of a planet, without measurements.
std::vector<FeatureRow> feature_rows(bool has_imagery);

// Returns the number of processes that measure_processes() will start.
int count_processes(const FeaturePlan& plan, const std::vector<FeatureRow>& rows);

// Measures all rows in processes. Calls `step` before each process; it may throw to stop. Throws what probe()
// throws.
void measure_processes(const FeaturePlan& plan, std::vector<FeatureRow>& rows,
                       const std::function<void()>& step);

// Measures the rows of one backend in interleaved rounds, each row with a renderer of its own. Call it on the
// context's thread.
void measure_frames(const FeaturePlan& plan, std::vector<FeatureRow>& rows, core::Backend backend,
                    const std::shared_ptr<gl::Context>& context,
                    const std::shared_ptr<const paging::PlanetFile>& planet);

// Returns the cost of each feature: its scene compared with the one without it.
std::vector<report::FeatureCost> feature_costs(const std::vector<FeatureRow>& rows, bool has_other);

}  // namespace vpe::app
