// Interface between a window, which requests images, and the program, which draws them with a backend.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "paging/planet/planet_file.h"
#include "relief/spec.h"
#include "scripts/ground_tracks.h"
#include "vpe/core/appearance/palette.h"
#include "vpe/core/backend.h"
#include "vpe/core/frame.h"
#include "vpe/core/image/image.h"
#include "vpe/core/stereo.h"
#include "vpe/overlay/layer_files.h"
#include "vpe/warp/image_grid.h"

namespace vpe::window {

// A context of OpenGL that shares textures with a display's. For one thread at a time.
class DrawContext {
 public:
  virtual ~DrawContext() = default;
  // Makes it current on this thread. Throws std::runtime_error.
  virtual void make_current() = 0;
  // Leaves this thread without a current context.
  virtual void release() = 0;
};

// Says where triangles are drawn.
struct DrawPlace {
  // Lives longer than the painter; null: the painter makes a context of its own. The first request of a painter decides.
  DrawContext* context = nullptr;
  bool needs_gpu = false;  // the context is of no use where OpenGL runs on the CPU
  unsigned texture = 0;    // OpenGL's name of one that the image is drawn into; 0: pixels are wanted
  void* unused = nullptr;  // GLsync, which is passed once the display no longer draws the texture
};

struct ImageRequest {
  std::uint64_t number = 0;  // of the window's requests, ascending
  core::Backend backend = core::Backend::kPolygon;
  bool is_auto = false;  // nobody named the backend: it keeps to the tolerance
  core::DrawRequest draw;
  bool is_full = true;          // not made coarser, nor smaller, to save time
  double px_per_screen_px = 1;  // of the image, along a side
  std::optional<core::StereoLayout> stereo;
  double eye_base_m = 0;     // with stereo; > 0
  double convergence_m = 0;  // with stereo; where both images coincide; 0: infinitely far
  double flight_time_s = 0;  // for the overlay of that name
  // How the flight that is followed changes the ground, at flight_time_s; null: it does not.
  std::shared_ptr<const scripts::GroundTracks> ground;
  // Reliefs that change the ground after that; null: none.
  std::shared_ptr<const std::vector<relief::ReliefSpec>> reliefs;
  // The vector files of draw.settings, by path; null: the painter reads them.
  std::shared_ptr<const overlay::LayersByFile> layers;
  std::optional<double> logged_s;  // its time in the log while a session is recorded
  bool keeps_ranges = false;       // also returns DrawnImage::range_m where there is one grid
  // The image is larger than its view by so many pixels on each side (core::with_margin), for a camera that turns on
  // until it is shown; not with stereo.
  glm::ivec2 margin_px{0, 0};
  // Also draws the planet that this one is compared with (paging::PlanetFile::earlier()), by the same request; not with
  // stereo, and nothing without such a planet.
  bool with_earlier = false;
  DrawPlace place;
};

// Holds the result of a request.
struct DrawnImage {
  ImageRequest request;
  core::RgbImage image;  // with its margin; in stereo of another size than the view; empty after an error
  // The image is in the texture of the request, and `image` has its size but no pixels.
  bool is_in_texture = false;
  void* drawn =
      nullptr;  // GLsync, which is passed once the texture is drawn; the painter's until the next request
  // Without its pixels. In stereo its figures are those of the left eye, and its certificate is that of the eye with the
  // larger bound.
  core::DrawResult result;
  // The image of each eye, with its margin, as a grid that follows the camera; none unless the request wants rough ranges
  // and there are some.
  std::vector<warp::ImageGrid> grids;
  // The same of the earlier planet, if the request asks for it and there is one.
  core::RgbImage earlier;
  std::vector<warp::ImageGrid> earlier_grids;
  std::vector<float> range_m;  // of its pixels, as core::Frame::range_m; empty unless the request keeps it
  std::shared_ptr<const paging::PlanetFile>
      changed;                               // with the ground that the image shows; null: as it is in the file
  std::optional<core::PaletteEnds> palette;  // the ends taken from a view, where the settings say so
  double seconds = 0;
  std::string error;  // empty if the image was drawn
};

// Draws images. Is used by the thread on which it was created.
class Painter {
 public:
  virtual ~Painter() = default;
  // Throws what renderers throw.
  virtual DrawnImage paint(const ImageRequest& request) = 0;
};

using MakePainter = std::function<std::unique_ptr<Painter>()>;

}  // namespace vpe::window
