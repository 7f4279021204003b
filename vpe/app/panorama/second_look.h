// The second eye of a view of a panorama for one eye, by the ranges of the panorama.
//
// Typical usage:
//   SecondLook second(description, budget_bytes, {.gap_px = 2});
//   const EyePair eyes = second.draw(view, [&](const core::View& wide) { return draw(panorama, wide); });
#pragma once

#include <cstddef>
#include <functional>
#include <optional>

#include "panorama/metadata/open_panorama.h"
#include "panorama/viewer/view_ranges.h"
#include "vpe/base/parallel.h"
#include "vpe/core/image/image.h"
#include "vpe/core/view.h"
#include "vpe/warp/carry.h"

namespace vpe::app {

struct SecondLookOptions {
  double eye_base_m = 0;  // 0: the nearest range of the first view / core::kNearestToBase
  double gap_px = 2;      // StereoMethod::gap_px
  int threads = 0;
};

struct EyePair {
  core::RgbImage left;
  core::RgbImage right;
  double filled_share = 0;  // of pixels that the panorama does not show, which look like what is behind them
};

// For one thread.
class SecondLook {
 public:
  // Throws std::runtime_error if the panorama has no layer "range", and vpe::base::FileError.
  SecondLook(const panorama::PanoramaDescription& description, std::size_t budget_bytes,
             const SecondLookOptions& options);

  // Returns what both eyes see of a view, whose axes are in the panorama's frame: the left one the view itself. `draw_left` draws
  // a view of the panorama, wider than this one where the right eye sees more. Parallel views: what is infinitely far coincides.
  // Throws std::runtime_error where no base can be told, since all is sky, and what draw_left() throws.
  EyePair draw(const core::View& view, const std::function<core::RgbImage(const core::View&)>& draw_left);

  // Returns the distance of the eyes; 0 before the first view if it follows from that.
  double eye_base_m() const { return base_m_; }

 private:
  panorama::PanoramaMap map_;
  std::optional<panorama::PlaneReader> ranges_;
  SecondLookOptions options_;
  double base_m_ = 0;
  base::ThreadPool pool_;
  warp::Carrier carrier_;
  warp::CarriedImage carried_;
};

}  // namespace vpe::app
