// Table 1, the pixel-to-voxel ratio and the database of Cohen-Or, Rich, Lerner and Shenkar (1996), measured here.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "vpe/report/page.h"

namespace vpe::app {

struct FlythroughPaperPlan {
  double fov_deg = 45;       // vertical
  std::vector<int> threads;  // ascending, the first is 1
  int rounds = 9;            // of each time. Larger: steadier medians
  bool is_short = false;     // fewer ratios, less terrain, smaller images
  std::size_t memory_bytes = std::size_t{1} << 30;
};

struct FlythroughPaper {
  report::Section section;
  std::vector<report::Table> tables;
};

// Builds fractal terrain of 2049 x 2049 posts 5 m apart (513 x 513 for plan.is_short) in `folder`, and removes it at the end. Draws it
// by the discrete caster (rays.mode=discrete), at three pitch angles and each number of threads, at several ratios and with each of
// its options on one thread, and exactly for comparison; all in interleaved rounds. Writes images into `folder`. Calls `step` before
// each image that is timed. Throws core::FileError, what renderers throw, and what `step` throws.
FlythroughPaper measure_flythrough_paper(const FlythroughPaperPlan& plan, const std::filesystem::path& folder,
                                         const std::function<void()>& step);

// Returns how often measure_flythrough_paper() calls `step`.
int count_steps(const FlythroughPaperPlan& plan);

}  // namespace vpe::app
