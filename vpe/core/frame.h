// A finished image: colour and range, and the interface of what draws it.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mars/sources/source.h"
#include "vpe/core/appearance/settings.h"
#include "vpe/core/certificate.h"
#include "vpe/core/interest.h"
#include "vpe/core/view.h"

namespace vpe::core {

inline constexpr float kSkyRange = std::numeric_limits<float>::infinity();

// Row 0 is the top; rows follow each other without gaps.
struct Frame {
  int width = 0;
  int height = 0;
  std::vector<base::Rgb> colour;  // width * height
  std::vector<float> range_m;  // width * height when asked for, else empty; camera to surface; kSkyRange = sky
};

// Counts of one frame (design: every frame reports).
struct FrameStats {
  int tiles_visited = 0;
  int tiles_culled_frustum = 0;
  int tiles_culled_horizon = 0;
  int tiles_culled_occlusion = 0;  // hidden behind nearer ground
  int tiles_drawn = 0;
  int tiles_missing = 0;       // wanted for this view, but not drawn
  int tiles_substituted = 0;   // drawn in place of what is missing
  std::int64_t triangles = 0;  // of the drawn meshes, skirts not counted
  std::int64_t skirt_triangles = 0;
  std::int64_t bytes_resident = 0;  // CPU and GPU payloads held
  std::vector<int> tiles_by_level;  // index 0 = level 0
  std::int64_t pages_wanted = 0;    // asked of the loaders and not begun when the frame was done
  std::int64_t pages_loading = 0;
  std::int64_t pages_uploaded = 0;  // for this frame
  std::int64_t pages_evicted = 0;
  double select_ms = 0;
  double occlude_ms = 0;  // finding what nearer ground hides; part of load_ms
  double load_ms = 0;     // waiting for loaders, and uploading
  double draw_ms = 0;
  double read_ms = 0;
};

struct DrawRequest;

// How a frame deals with tiles that are not there yet.
struct PagingRequest {
  // True: the frame waits for all that its view needs, so that its image does not depend on what was drawn
  // before. False: it is drawn at once with what is there, in full cover from the first frame on.
  bool wait = true;
  double timeout_s = std::numeric_limits<double>::infinity();  // of waiting; then what is there is drawn
  double upload_ms = 4;  // time for new tiles in a frame that does not wait; one is taken in any case
  // Where the camera is expected soon, nearest first: loaded after all that the view itself needs. Never changes
  // what is drawn of a complete frame.
  std::vector<View> upcoming;
  // What is drawn next, where that is known: may be begun while this frame is drawn. When something else comes
  // next, that work was in vain, no more.
  std::shared_ptr<const DrawRequest> next;
};

struct DrawRequest {
  View view;
  SettingsValues settings;
  glm::dvec3 sun{1, 0, 0};  // unit, body-fixed, towards the sun (mars::sun_direction)
  bool want_range = false;
  // Tiles are chosen and culled for this view, and drawn as `view` sees them: to look at culling from outside.
  // What this view cannot see is not there. Nothing: for `view`.
  std::optional<View> cull_view;
  std::vector<InterestRegion> interest;  // where regions overlap, their levels add up
  // >= 1: what is given up for speed (lod/frame_budget.h, lod/progressive_refinement.h). The tolerance counts times
  // this, in rule hitchner every distance. 1 in single images and films.
  double coarsening = 1;
  PagingRequest paging;
};

// A tile that the view needs and that was not drawn.
struct MissingTile {
  std::string tile;
  std::string why;
};

struct DrawResult {
  Frame frame;
  FrameStats stats;
  Certificate certificate;
  bool settled = true;                // nothing is under way that would change this view's image
  std::vector<MissingTile> missing;   // empty when the image is complete
  std::vector<std::string> failures;  // of tiles that cannot be read, each told once by a renderer
};

class Renderer {
 public:
  virtual ~Renderer() = default;
  // Tiles that cannot be read are drawn as their nearest readable ancestor, and are missing. One caller at a
  // time, on the thread that made the renderer. Throws std::runtime_error with what, why, and what to do.
  virtual DrawResult draw(const DrawRequest& request) = 0;
};

}  // namespace vpe::core
