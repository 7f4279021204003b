// Draws the strips of a panorama that are not there yet.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "paging/surface/surface.h"
#include "panorama/panorama_plan.h"
#include "vpe/app/cli/progress.h"
#include "vpe/app/panorama/panorama_files.h"
#include "vpe/app/panorama/panorama_overlays.h"
#include "vpe/app/panorama/panorama_recipe.h"
#include "vpe/core/frame.h"

namespace vpe::app {

// Seconds of this run.
struct PanoramaTimes {
  double start = 0;    // until the first piece is asked for: planet file, plan, OpenGL
  double paging = 0;   // polygons: waiting for tiles; rays load them while they cast and shade
  double casting = 0;  // rays: ranges; polygons: choosing and drawing
  double shading = 0;  // rays: colours; polygons: reading back
  double planes = 0;
  double encoding = 0;  // packing, writing, joining
};

// The worst of all pieces.
struct PanoramaFigures {
  double geometric_error_m = 0;
  double shift_bound_px = 0;
  std::int64_t tiles_substituted = 0;
  std::int64_t tiles_missing = 0;

  void add(const PanoramaFigures& other);
};

// Of memory_mb for all, what a renderer may take beside the strip that is drawn; and the planes' share of that.
int renderer_memory_mb(const PanoramaJob& job, int memory_mb);
int planes_memory_mb(const PanoramaJob& job, int memory_mb);

class PanoramaMaker {
 public:
  using MakeRenderer = std::function<std::unique_ptr<core::Renderer>(int memory_mb)>;

  // `request` has the settings, sun and interest; its view is not used. `fingerprint` is of everything that the
  // strips depend on. References are kept.
  PanoramaMaker(const PanoramaJob& job, const PanoramaRecipe& recipe, const core::DrawRequest& request,
                std::string fingerprint, std::shared_ptr<const paging::PlanetFile> planet,
                MakeRenderer make_renderer, PanoramaOverlays& overlays, base::ThreadPool& pool, int memory_mb);

  // All strips, kept or made. Throws Interrupted, saying what is kept, and what renderers and writers throw.
  std::vector<panorama::StripFile> run(ProgressLine& line, PanoramaTimes& times);

  int kept() const { return kept_; }
  int made() const { return made_; }
  const PanoramaFigures& figures() const { return figures_; }
  const std::vector<std::string>& failures() const { return failures_; }

 private:
  struct Canvas;

  std::filesystem::path strip_path(std::size_t n) const;
  std::optional<panorama::StripFile> keep(std::size_t n);
  panorama::StripFile make(std::size_t n, ProgressLine& line, PanoramaTimes& times);
  void draw(const panorama::Piece& piece, const panorama::Strip& strip, Canvas& canvas, PanoramaTimes& times);
  void lay_overlays(Canvas& canvas);
  void draw_eyes(const panorama::Strip& strip, Canvas& canvas, const std::function<void(double)>& show,
                 PanoramaTimes& times);
  panorama::PoseOnSphere pose_on_sphere() const;
  void add_image(panorama::StripWriter& writer, const StripLayout& layout, const Canvas& canvas) const;
  void add_plane(panorama::StripWriter& writer, const StripLayout& layout, const Canvas& canvas,
                 panorama::Plane plane) const;
  // Pixels of one row of the strip from a column on, as the format has them.
  using FillRow =
      std::function<void(std::int64_t column, std::int64_t row, std::int64_t count, std::uint8_t* out)>;
  void add_tiles(panorama::StripWriter& writer, const StripLayout& layout, const Canvas& canvas,
                 const panorama::SampleFormat& format, const FillRow& fill) const;

  const PanoramaJob& job_;
  const PanoramaRecipe& recipe_;
  const core::DrawRequest& request_;
  std::string fingerprint_;
  std::shared_ptr<const paging::PlanetFile> planet_;
  MakeRenderer make_renderer_;
  PanoramaOverlays& overlays_;
  base::ThreadPool& pool_;
  int memory_mb_;
  int margin_px_ = 0;
  std::unique_ptr<core::Renderer> renderer_;
  std::unique_ptr<paging::Surface> surface_;
  std::vector<base::Rgb> colour_;  // a strip's, used again by the next
  std::vector<std::string> failures_;
  PanoramaFigures figures_;
  int kept_ = 0;
  int made_ = 0;
};

}  // namespace vpe::app
