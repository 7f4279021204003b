// The table and Figs 6 to 8 of Vyatkin and Dolgovesov 2002, measured here with the caster of relief.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "vpe/report/page.h"

namespace vpe::app {

struct ReliefPaperPlan {
  int rounds = 9;         // of each time. Larger: steadier medians
  bool is_short = false;  // without bicubic maps
};

struct ReliefPaper {
  report::Section section;
  std::vector<report::Table> tables;
};

// Draws the same hills from maps of the paper's resolutions, with 512 x 512 pixels on one thread: bilinear and bicubic
// heights, each exactly and with a tolerance of half a pixel, in interleaved rounds of processor time. Writes the images of the table and of
// the figures into `folder`. Calls `step` before each image that is timed. Throws core::FileError, and what `step` throws.
ReliefPaper measure_relief_paper(const ReliefPaperPlan& plan, const std::filesystem::path& folder,
                                 const std::function<void()>& step);

// Returns how often measure_relief_paper() calls `step`.
int count_steps(const ReliefPaperPlan& plan);

}  // namespace vpe::app
