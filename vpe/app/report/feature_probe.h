// Measures one scene in a process of its own, so that its memory and start-up are not mixed with others'.
#pragma once

#include <memory>
#include <string>

#include "vpe/app/report/feature_scenes.h"
#include "vpe/report/features.h"

namespace vpe::app {

struct ProbeRequest {
  std::string program;  // executable; may be of another version
  std::string scene;
  core::Backend backend = core::Backend::kPolygon;
  std::string planet;
  std::string pose;  // LON,LAT,HEIGHT,YAW,PITCH
  std::string size;
  std::string statistics_file;
  int memory_mb = 1024;
  int threads = 0;
  int frames = 5;  // after the first one; more: a more reliable median
};

// Returns the view of a camera above the terrain at a place. Throws UsageError for a malformed pose or size.
core::View feature_view(const std::string& pose, const std::string& size,
                        const std::shared_ptr<const paging::PlanetFile>& planet);

// Draws the scene in this process and prints {"finished_s", "peak_mb", "frame_s", "processor_s",
// "resident_mb"}. finished_s is when the first image was finished, on the clock that all processes share.
void run_probe(const ProbeRequest& request);

// Runs the same in a child process. Throws std::runtime_error with the child's messages.
report::SceneCost probe(const ProbeRequest& request);

}  // namespace vpe::app
