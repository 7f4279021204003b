// The contract of both backends: a DrawRequest goes into a Renderer, a DrawResult with its Frame comes out.
//
// Typical usage:
//   const std::unique_ptr<Renderer> renderer = voxel::make_ray_renderer(paging::PlanetFile::open("mars.vpe"));
//   DrawRequest request;
//   request.view = view;
//   request.settings = settings.values();
//   request.sun = sun;
//   request.want_range = true;
//   const DrawResult result = renderer->draw(request);
//   write_image("out.png", result.frame.colour, result.frame.width, result.frame.height);
//   if (!result.missing.empty()) warn(result.missing.front().why);
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vpe/base/rgb.h"
#include "vpe/core/appearance/settings.h"
#include "vpe/core/certificate.h"
#include "vpe/core/ground_parts.h"
#include "vpe/core/interest.h"
#include "vpe/core/object_track.h"
#include "vpe/core/view.h"

namespace vpe::core {

inline constexpr float kSkyRange = std::numeric_limits<float>::infinity();

// Holds the drawn part of an image, row by row, row 0 at the top.
struct Frame {
  int width = 0;
  int height = 0;
  std::vector<base::Rgb> colour;  // width * height; empty if the request does not want it
  // Distance from the camera to the surface along the ray, metres; kSkyRange for sky. width * height if the
  // request wants it, else empty.
  std::vector<float> range_m;
};

// Counts and times of one frame.
struct FrameStats {
  int tiles_visited = 0;
  int tiles_culled_frustum = 0;
  int tiles_culled_horizon = 0;
  int tiles_culled_occlusion = 0;  // hidden behind nearer ground
  int tiles_drawn = 0;
  int tiles_missing = 0;                // selected for this view, but not loaded and so not drawn
  int tiles_substituted = 0;            // drawn in place of missing ones
  std::int64_t triangles = 0;           // of the drawn meshes, without skirts
  std::int64_t triangles_in_sight = 0;  // of these, in pieces that are in the image and not behind the horizon
  std::int64_t skirt_triangles = 0;
  std::int64_t bytes_resident = 0;  // payloads in CPU and GPU memory
  std::vector<int> tiles_by_level;  // index 0 = level 0
  std::int64_t pages_wanted = 0;    // requested from the loaders, not begun at the end of the frame
  std::int64_t pages_loading = 0;
  std::int64_t pages_uploaded = 0;  // for this frame
  std::int64_t pages_evicted = 0;
  double select_ms = 0;   // selecting tiles; by rays: casting
  double occlude_ms = 0;  // for occlusion culling; part of load_ms
  double load_ms = 0;     // waiting for loaders, and uploading
  double draw_ms = 0;
  double read_ms = 0;  // reading the image back from the GPU
};

struct DrawRequest;

// Describes how a frame treats tiles that are not loaded yet.
struct PagingRequest {
  // True: the frame waits for all tiles of its view, so that its image does not depend on earlier frames; for
  // images and films. False: the frame is drawn at once with loaded tiles, coarser ones where finer ones are
  // missing; for windows.
  bool wait = true;
  // Longest wait; then the loaded tiles are drawn. Shorter: frames may be incomplete. By rays: the time that may be
  // spent with reading.
  double timeout_s = std::numeric_limits<double>::infinity();
  // Longest wait of a frame that does not wait otherwise, where the exaggeration or the kind of shading has changed
  // since the last frame, so that no loaded tile fits. Larger: the change is seen later, with the same tiles; 0: at
  // once, with coarse ones.
  double change_wait_s = 0;
  // Time for uploads in a frame that does not wait; one tile is uploaded in any case. Smaller: steadier frame
  // times, later refinement.
  double upload_ms = 4;  // of triangles
  // Views where the camera is expected soon, nearest first. Their tiles are loaded after all tiles of the view
  // itself. Does not affect a complete frame.
  std::vector<View> upcoming;
  // Hint: the next request, if known. The renderer may start it early; a wrong hint only wastes work.
  std::shared_ptr<const DrawRequest> next;
};

// Describes an image to draw.
struct DrawRequest {
  View view;
  SettingsValues settings;
  glm::dvec3 sun{1, 0, 0};  // unit, body-fixed, towards the sun (mars::sun_direction)
  bool want_range = false;  // also returns Frame::range_m
  // Also returns Frame::range_m where the backend has it at hand anyway, within a thousandth of what the image shows: by
  // rays always; by triangles for colours with one sample a pixel that are no lines. Else it stays empty. For images that
  // are moved to another camera (vpe/warp); no certificate uses it.
  bool want_rough_range = false;
  double time_s = 0;  // of the flight; decides where objects that move are
  // Says how the flight moves objects of the scene; null: it does not.
  std::shared_ptr<const std::vector<ObjectTrack>> tracks;
  // Is added to the ground or cut out of it; null: nothing. Drawn in rays.mode=volume and boundary without coarsening
  // (voxel::draws_ground_parts()); the certificate then includes the bound of its error. Other images do not show it.
  std::shared_ptr<const GroundParts> ground_parts;
  // False: Frame::colour stays empty, and nothing is loaded for it; the certificate does not know the share of
  // nodata. For ranges at another accuracy than that of the image.
  bool want_colour = true;
  // If set, tiles are selected and culled for this view, but drawn as `view` sees them. Shows culling from
  // outside: ground that cull_view cannot see is absent.
  std::optional<View> cull_view;
  std::vector<InterestRegion> interest;  // where regions overlap, their levels add up
  // Factor, >= 1, on the tolerance (metric error) or on all distances (metric distance). Larger: coarser,
  // faster. 1 in single images and films; windows raise it while the camera moves (lod/frame_budget.h,
  // lod/progressive_refinement.h).
  double coarsening = 1;
  // True: with the metric error, coarsening makes triangles at most one level coarser than they are without it.
  bool keeps_levels = false;
  PagingRequest paging;
};

// A tile that the view needs and that was not drawn.
struct MissingTile {
  std::string tile;
  std::string why;
  bool is_unreadable = false;  // false: was not loaded in time, for instance below an unreadable tile
};

struct DrawResult {
  Frame frame;
  FrameStats stats;
  Certificate certificate;
  // True if nothing is being loaded that would change the image of this view or, in frames that do not wait, stand in
  // for the ground beside it.
  bool settled = true;
  std::vector<MissingTile> missing;   // empty if the image is complete
  std::vector<std::string> failures;  // tiles that cannot be read; a renderer reports each once
  // Gives a distance from the camera within which there is no object, in the image or beside it.
  double clear_of_objects_m = std::numeric_limits<double>::infinity();
  bool shows_see_through = false;  // an object in the image may be semi-transparent: pixels show several ranges
};

// Draws images of one planet. gl::make_polygon_renderer() makes one that draws triangle meshes with OpenGL,
// voxel::make_ray_renderer() one that casts rays on the CPU. Both draw the same reference surface.
class Renderer {
 public:
  virtual ~Renderer() = default;

  // Draws one image. A tile that cannot be read, or is not loaded in time, is replaced by its nearest ancestor that
  // is there, and listed as missing; the certificate holds for what was drawn. Has one caller at a time, on the
  // thread that made the renderer. Throws std::runtime_error with what failed, why, and what to do; also where not
  // even a root can be read.
  virtual DrawResult draw(const DrawRequest& request) = 0;
};

}  // namespace vpe::core
