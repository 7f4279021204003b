// The tables and Fig. 8 of the stereo paper (Wan, Zhang, Kaufman, Qu 2000), measured here.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "paging/planet/planet_file.h"
#include "vpe/core/frame.h"
#include "vpe/report/page.h"

namespace vpe::app {

struct StereoPaperPlan {
  core::View view;        // of the middle between both eyes
  glm::dvec3 sun{};       // core::DrawRequest::sun
  double eye_base_m = 0;  // 0: a thirtieth of the distance to the nearest ground of the view
  std::vector<int> threads;
  int rounds = 5;  // of each time. Larger: steadier medians
  std::size_t memory_bytes = std::size_t{1} << 30;
};

struct StereoPaper {
  report::Section section;
  std::vector<report::Table> tables;
  double eye_base_m = 0;
};

// Measures by rays: the left eye in full, and the right eye carried and in full, with light and shadows, and with imagery.
// Writes the six images of Fig. 8 of both into `folder`. Calls `step` before each part. Throws what renderers throw.
StereoPaper measure_stereo_paper(const StereoPaperPlan& plan,
                                 const std::shared_ptr<const paging::PlanetFile>& planet,
                                 const std::filesystem::path& folder, const std::function<void()>& step);

// Returns how often measure_stereo_paper() calls `step`.
int count_steps(const StereoPaperPlan& plan);

}  // namespace vpe::app
