// Table 1, Figs 6 and 7 and the times of section 7 of Wan, Qu and Kaufman (1999), measured here.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "vpe/report/page.h"

namespace vpe::app {

struct TerrainPaperPlan {
  std::vector<int> threads;  // ascending, the first is 1
  int rounds = 9;            // of each time. Larger: steadier medians
  bool is_short = false;     // 3 rolls instead of 10
};

struct TerrainPaper {
  report::Section section;
  std::vector<report::Table> tables;
};

// Draws invented terrain of 512 x 512 x 64 voxels with a photograph, 500 x 400 pixels, at a pitch of -30 degrees, in interleaved
// rounds. Writes the images of both figures, of their difference and of a rolled view into `folder`. Calls `step` before
// each image that is timed. Throws core::FileError, and what `step` throws.
TerrainPaper measure_terrain_paper(const TerrainPaperPlan& plan, const std::filesystem::path& folder,
                                   const std::function<void()>& step);

// Returns how often measure_terrain_paper() calls `step`.
int count_steps(const TerrainPaperPlan& plan);

}  // namespace vpe::app
