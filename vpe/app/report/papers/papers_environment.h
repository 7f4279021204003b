// Figures of merit of Hitchner (1992), Virtual Planetary Exploration, measured here.
#pragma once

#include <filesystem>
#include <functional>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "mars/geodesy/pose.h"
#include "paging/planet/planet_file.h"
#include "vpe/report/page.h"

namespace vpe::app {

struct EnvironmentPaperPlan {
  mars::Pose pose;           // its pitch and roll are not used
  glm::dvec3 sun{};          // core::DrawRequest::sun
  std::vector<int> threads;  // ascending; the last one counts
  int rounds = 9;            // of each time. Larger: steadier medians
  bool is_short = false;     // a sixteenth of the panorama's pixels
  std::size_t memory_bytes = std::size_t{1} << 30;
};

struct EnvironmentPaper {
  report::Section section;
  std::vector<report::Table> tables;
};

// Draws a panorama of 8 facets by the ray backend from the plan's place on its last
// number of threads, writes it into `folder`, and turns a view of it about the vertical. With plan.is_short the panorama has a
// sixteenth of the pixels, and the published time is divided by 16. Calls `step` before each image that is timed. Throws
// core::FileError, what renderers throw, and what `step` throws.
EnvironmentPaper measure_environment_paper(const EnvironmentPaperPlan& plan,
                                           const std::shared_ptr<const paging::PlanetFile>& planet,
                                           const std::filesystem::path& folder,
                                           const std::function<void()>& step);

// Returns how often measure_environment_paper() calls `step`.
int count_environment_steps(const EnvironmentPaperPlan& plan);

}  // namespace vpe::app
