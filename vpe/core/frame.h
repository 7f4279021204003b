// A finished picture: colour and range, and the interface of what draws it.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "mars/source.h"
#include "vpe/core/certificate.h"
#include "vpe/core/interest.h"
#include "vpe/core/settings.h"
#include "vpe/core/view.h"

namespace vpe::core {

inline constexpr float kSkyRange = std::numeric_limits<float>::infinity();

// Row 0 is the top; rows follow each other without gaps.
struct Frame {
  int width = 0;
  int height = 0;
  std::vector<mars::Rgb> colour;  // width * height
  std::vector<float> range_m;     // width * height when asked for, else empty; eye to surface; kSkyRange = sky
};

// Counts of one frame (design: every frame reports).
struct FrameStats {
  int tiles_visited = 0;
  int tiles_culled_frustum = 0;
  int tiles_culled_horizon = 0;
  int tiles_drawn = 0;
  int tiles_missing = 0;
  std::int64_t triangles = 0;  // of the drawn meshes, skirts not counted
  std::int64_t skirt_triangles = 0;
  std::int64_t bytes_resident = 0;  // CPU and GPU payloads held
  std::vector<int> tiles_by_level;  // index 0 = level 0
  double select_ms = 0;
  double load_ms = 0;
  double draw_ms = 0;
  double read_ms = 0;
};

struct DrawRequest {
  View view;
  SettingsValues settings;
  glm::dvec3 sun{1, 0, 0};  // unit, body-fixed, towards the sun (mars::sun_direction)
  bool want_range = false;
  std::vector<InterestRegion> interest;  // where regions overlap, their levels add up
  // >= 1: what is given up for speed (lod/frame_budget.h, lod/look_and_wait.h). The tolerance counts times
  // this, in rule hitchner every distance. 1 in single pictures and films.
  double coarsening = 1;
};

struct DrawResult {
  Frame frame;
  FrameStats stats;
  Certificate certificate;
};

class Renderer {
 public:
  virtual ~Renderer() = default;
  // Draws with complete data (waits for it). One caller at a time, on the thread that made the renderer.
  // Throws std::runtime_error with what, why, and what to do.
  virtual DrawResult draw(const DrawRequest& request) = 0;
};

}  // namespace vpe::core
