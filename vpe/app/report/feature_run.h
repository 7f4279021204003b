// What `vpe report features` measures: every scene and backend, in processes of their own and in turns within
// one.
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
  ProbeRequest order;   // but for program, scene and backend
  std::string against;  // another program; empty: none
  int rounds = 9;       // of frames
  int starts = 3;       // of each process
};

// One scene and backend, and what was measured of it.
struct FeatureRow {
  const FeatureScene* scene = nullptr;
  std::string backend;
  report::SceneCost cost;           // of this program's processes
  report::SceneCost never;          // of the other's, where it is asked
  std::vector<double> processor_s;  // of a frame, a process each
  std::vector<double> never_processor_s;
  report::Timing interleaved;
  std::optional<double> rest_ratio;  // image to the same without what no stage of it counts
};

// The rows that this program can draw of a planet, with nothing measured.
std::vector<FeatureRow> feature_rows(bool has_imagery);

// How many processes measure_processes() will start.
int count_processes(const FeaturePlan& plan, const std::vector<FeatureRow>& rows);

// `step` is called before each process, and may throw. Throws what probe() throws.
void measure_processes(const FeaturePlan& plan, std::vector<FeatureRow>& rows,
                       const std::function<void()>& step);

// Frames of all scenes of a backend in turns, each with a renderer of its own. On the context's thread.
void measure_frames(const FeaturePlan& plan, std::vector<FeatureRow>& rows, const std::string& backend,
                    const std::shared_ptr<gl::Context>& context,
                    const std::shared_ptr<const paging::PlanetFile>& planet);

// What each thing costs: its scene against the one without it.
std::vector<report::FeatureCost> feature_costs(const std::vector<FeatureRow>& rows, bool has_other);

}  // namespace vpe::app
