// The triangles of section 7 of Wan, Qu and Kaufman (1999) beside the rays of that paper on a planet, measured here.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <vector>

#include "vpe/report/page.h"

namespace vpe::app {

struct TrianglesPaperPlan {
  int rounds = 9;                                   // of each time. Larger: steadier medians
  std::size_t memory_bytes = std::size_t{1} << 30;  // for all renderers together
};

struct TrianglesPaper {
  report::Section section;
  std::vector<report::Table> tables;
};

// Draws made-up terrain of 513 x 513 posts on a planet, 500 x 400 pixels at a pitch of -30 degrees, by all of its triangles
// without occlusion culling, and by single-threaded rays: accurate (rays.mode=volume), approximate (boundary) and exact. The
// planet file lies in `folder` while it is needed. Without OpenGL the row of triangles is empty, and the section says why. Calls
// `step` before each image that is timed. Throws core::FileError, what renderers throw, and what `step` throws.
TrianglesPaper measure_triangles_paper(const TrianglesPaperPlan& plan, const std::filesystem::path& folder,
                                       const std::function<void()>& step);

// Returns how often measure_triangles_paper() calls `step` where there is OpenGL.
int count_triangles_steps(const TrianglesPaperPlan& plan);

}  // namespace vpe::app
