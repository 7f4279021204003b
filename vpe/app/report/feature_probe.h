// One scene in a process of its own, so that its memory and its start can be told from others'.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "vpe/app/report/feature_scenes.h"
#include "vpe/report/features.h"

namespace vpe::app {

struct ProbeRequest {
  std::string program;  // to run; its version may differ
  std::string scene;
  std::string backend;
  std::string planet;
  std::string pose;  // LON,LAT,HEIGHT,YAW,PITCH
  std::string size;
  std::string statistics_file;
  int memory_mb = 1024;
  int threads = 0;
  int frames = 5;
};

// Over the terrain at a place; throws UsageError for another form.
core::View feature_view(const std::string& pose, const std::string& size,
                        const std::shared_ptr<const paging::PlanetFile>& planet);

// Draws the scene in this process and prints {"finished_s", "peak_mb", "frame_s", "processor_s",
// "resident_mb"}: finished_s is when the first image was finished, on the clock that all processes share.
void run_probe(const ProbeRequest& order);

// The same in a child process. Throws std::runtime_error with what the child said.
report::SceneCost probe(const ProbeRequest& order);

}  // namespace vpe::app
