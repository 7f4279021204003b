// Lines and points of vector layers over an image that is too large to be in memory at once, as one eye sees them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "vpe/base/parallel.h"
#include "vpe/core/appearance/overlays.h"
#include "vpe/overlay/draped_lines.h"
#include "vpe/overlay/features/feature_painter.h"
#include "vpe/overlay/features/layer_use.h"
#include "vpe/overlay/overlay.h"
#include "vpe/overlay/sprites.h"

namespace vpe::overlay {

// Holds the place of a label: of a point, or of the middle of the longest run of a line that is seen.
struct LabelAnchor {
  std::uint32_t feature = 0;
  glm::dvec2 at_px{0, 0};
  double distance_m = 0;
  double radius_px = 0;  // that the label keeps clear
};

// Drapes all lines once, and keeps their runs with two bytes a point. Where these take more than the memory allows, the runs of
// some columns are kept, and lines are draped again for others. Pixels are drawn in squares of the image: they depend neither on
// the division into regions nor on the number of threads. One thread at a time; the sights must allow several.
//
// Typical usage:
//   PanoramaLines lines(layers, make_sight, hidden, pool, bytes);
//   for (ImageRegion& region : regions) lines.composite(region);
class PanoramaLines {
 public:
  // Makes the sight of one thread.
  using MakeSight = std::function<std::unique_ptr<GroundSight>()>;

  // Keeps references to the layers and the pool.
  PanoramaLines(const std::vector<SceneLayer>& layers, MakeSight make_sight, core::HiddenLines hidden,
                base::ThreadPool& pool, std::size_t memory_bytes);

  // Draws lines and points over a region; each layer over those below it. Throws what the sights and Canvas throw.
  void composite(const ImageRegion& region);

  // Return what is seen anywhere in the image, by layer. `use` has no areas.
  const std::vector<LayerUse>& use();
  const std::vector<std::vector<LabelAnchor>>& anchors();

  // Returns how often the lines were draped.
  int passes() const { return passes_; }

 private:
  struct Run {
    std::uint32_t feature = 0;
    bool is_hidden = false;
    float distance_m = 0;
    glm::dvec2 first_px{0, 0};
    glm::dvec2 low_px{0, 0};  // of all that it covers
    glm::dvec2 high_px{0, 0};
    std::size_t begin = 0;  // of its steps
    std::uint32_t steps = 0;
  };
  struct Step {
    std::int8_t x, y;  // in parts of a pixel
  };
  struct Marker {
    std::uint32_t feature = 0;
    glm::dvec2 at_px{0, 0};
    double distance_m = 0;
    double radius_px = 0;  // with its rim
  };
  struct Kept {  // of a layer
    std::vector<Run> runs;
    std::vector<Step> steps;
    std::vector<Marker> markers;
  };
  struct Window {
    double left_px = 0;
    double right_px = -1;
  };
  struct Draped;

  void drape(double left_px, double least_right_px);
  void keep(std::size_t layer, const DrapedRun& run);
  void add_run(std::size_t layer, const DrapedRun& run, std::size_t begin, std::size_t end);
  void shrink(double least_right_px);
  bool meets(double low_px, double high_px, double left_px, double right_px) const;
  std::size_t bytes() const;
  FeaturePainter painter(std::size_t layer) const;
  DrapedRun restore(const Kept& kept, const Run& run, double shift_px) const;

  const std::vector<SceneLayer>& layers_;
  MakeSight make_sight_;
  core::HiddenLines hidden_;
  base::ThreadPool& pool_;
  std::size_t memory_bytes_;
  GroundSight::Frame frame_;
  std::vector<Kept> kept_;
  std::vector<LayerUse> use_;
  std::vector<std::vector<LabelAnchor>> anchors_;
  std::vector<std::map<std::uint32_t, double>> lengths_;  // of the longest runs
  std::vector<std::map<std::uint32_t, LabelAnchor>> found_;
  Window window_;
  int passes_ = 0;
};

}  // namespace vpe::overlay
