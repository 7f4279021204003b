// Draws the strips of a panorama that do not exist yet.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "paging/surface/surface.h"
#include "panorama/image/strip_file.h"
#include "vpe/app/cli/folder_lock.h"
#include "vpe/app/cli/progress.h"
#include "vpe/app/panorama/carried_eye.h"
#include "vpe/app/panorama/panorama_overlays.h"
#include "vpe/app/panorama/panorama_plan.h"
#include "vpe/app/panorama/panorama_request.h"
#include "vpe/core/frame.h"

namespace vpe::app {

// Seconds of this run.
struct PanoramaTimes {
  double start = 0;    // until the first piece is requested: planet file, plan, OpenGL
  double paging = 0;   // polygons: waiting for tiles; rays load them while they cast and shade
  double casting = 0;  // rays: ranges, and all of an eye that is carried; polygons: selecting and drawing
  double shading = 0;  // rays: colours; polygons: reading back
  double layers = 0;
  double encoding = 0;  // packing, writing, joining
};

// The worst values of all pieces.
struct PanoramaFigures {
  double geometric_error_m = 0;
  double shift_bound_px = 0;
  std::int64_t tiles_substituted = 0;
  std::int64_t tiles_missing = 0;

  void add(const PanoramaFigures& other);
};

// Return the shares of memory_mb that the renderer, and the surface behind the auxiliary layers, may take
// beside the strip that is drawn.
int renderer_memory_mb(const PanoramaRequest& request, const PanoramaPlan& plan, int memory_mb);
int layers_memory_mb(const PanoramaRequest& request, const PanoramaPlan& plan, int memory_mb);

// Draws strips by any renderer, one after another, and keeps each in a file as soon as it is complete. A run
// that was interrupted continues with the strips it has.
//
// Typical usage:
//   PanoramaMaker maker(request, plan, {draw_request, fingerprint, planet, make_renderer, memory_mb}, overlays,
//                       pool);
//   const auto strips = maker.run(progress_line, times);
class PanoramaMaker {
 public:
  using MakeRenderer = std::function<std::unique_ptr<core::Renderer>(int memory_mb)>;

  struct Scene {
    core::DrawRequest draw_request;  // settings, sun and interest; its view is not used
    std::string fingerprint;         // of everything that the strips depend on (panorama_plan.h)
    std::shared_ptr<const paging::PlanetFile> planet;
    MakeRenderer make_renderer;  // called when the first strip has to be drawn
    int memory_mb = 0;           // for everything
  };

  // Keeps the references.
  PanoramaMaker(const PanoramaRequest& request, const PanoramaPlan& plan, Scene scene,
                PanoramaOverlays& overlays, base::ThreadPool& pool);

  // Returns all strips from left to right, those of an earlier run and new ones. Throws Interrupted with the number of strips that
  // are kept, std::runtime_error if another process makes the image, and what renderers and writers throw.
  std::vector<panorama::StripFile> run(ProgressLine& line, PanoramaTimes& times);

  int kept() const { return kept_; }  // strips of an earlier run
  int made() const { return made_; }
  const PanoramaFigures& figures() const { return figures_; }
  const std::vector<std::string>& failures() const { return failures_; }  // tiles that could not be read

 private:
  struct Canvas;

  std::filesystem::path strip_path(std::size_t n) const;
  std::optional<panorama::StripFile> keep(std::size_t n);
  panorama::StripFile make(std::size_t n, ProgressLine& line, PanoramaTimes& times);
  void prepare();
  panorama::StripFile write(std::size_t n, const Canvas& canvas, PanoramaTimes& times);
  core::DrawResult draw_piece(const panorama::Piece& piece, bool want_range, Canvas& canvas,
                              PanoramaTimes& times);
  void draw(const panorama::Piece& piece, const panorama::Strip& strip, Canvas& canvas, PanoramaTimes& times);
  void add_figures(std::size_t n, const PanoramaFigures& figures);
  bool is_carried_beside() const;
  std::vector<std::size_t> order() const;
  std::vector<panorama::Strip> left_columns_for(const panorama::Strip& strip) const;
  core::Frame draw_left(const panorama::Strip& columns, Canvas& canvas, const std::function<void(double)>& show,
                        PanoramaTimes& times);
  RightEye carry(const core::Frame& left, const panorama::Strip& strip, Canvas& canvas,
                 const std::function<void(double)>& show, PanoramaTimes& times);
  void draw_carried(const panorama::Strip& strip, Canvas& canvas, const std::function<void(double)>& show,
                    PanoramaTimes& times);
  void draw_carried_beside(const panorama::Strip& strip, Canvas& canvas,
                           const std::function<void(double)>& show, PanoramaTimes& times);
  void draw_eyes(const panorama::Strip& strip, Canvas& canvas, const std::function<void(double)>& show,
                 PanoramaTimes& times);
  void lay_overlays(Canvas& canvas);
  void fill_areas(core::Frame& frame, const std::vector<panorama::Piece>& pieces);
  void drape_columns(panorama::Eye eye, std::int64_t x, std::int64_t width, std::vector<base::Rgb>& pixels,
                     std::int64_t stride, std::int64_t begin);
  int memory_mb() const;
  StripLayout layout(std::size_t n) const;
  panorama::Viewpoint viewpoint() const;
  void add_image(panorama::StripWriter& writer, const StripLayout& layout, const Canvas& canvas) const;
  void add_layer(panorama::StripWriter& writer, const StripLayout& layout, const Canvas& canvas,
                 panorama::Plane layer) const;
  // Writes pixels of one row of the strip from a column on, in the layer's format.
  using FillRow =
      std::function<void(std::int64_t column, std::int64_t row, std::int64_t count, std::uint8_t* out)>;
  void add_tiles(panorama::StripWriter& writer, const StripLayout& layout, const Canvas& canvas,
                 const panorama::SampleFormat& format, const FillRow& fill) const;

  const PanoramaRequest& request_;
  const PanoramaPlan& plan_;
  Scene scene_;
  PanoramaOverlays& overlays_;
  base::ThreadPool& pool_;
  int margin_px_ = 0;
  std::unique_ptr<FolderLock> lock_;  // of the strips' folder, during and after run()
  std::unique_ptr<core::Renderer> renderer_;
  std::unique_ptr<paging::Surface> surface_;
  std::vector<base::Rgb> colour_;        // of one strip; the next one reuses it
  std::unique_ptr<CarriedEye> carrier_;  // where the right eye is carried
  LeftColumns left_;                     // for strips of the right eye
  double left_bound_px_ = 0;             // of strips with parts of the left image, side by side
  std::vector<std::string> failures_;
  PanoramaFigures figures_;
  int kept_ = 0;
  int made_ = 0;
};

}  // namespace vpe::app
