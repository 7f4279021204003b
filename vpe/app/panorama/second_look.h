// Views of a panorama for one eye from beside its place, by the ranges of the panorama: of a second eye, of a head that moves.
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

// Holds what a head sees that is beside the panorama's place.
struct MovedView {
  core::RgbImage image;
  double filled_share = 0;  // as EyePair::filled_share
  double moved_m = 0;       // distance of the head, which may be shorter than was asked for
};

// A head moves at most by this share of the nearest range of a view: beyond it much of what it sees is not in the panorama.
inline constexpr double kMostMove = 0.25;

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

  // Returns what a camera sees whose position, metres in the panorama's frame, is not 0; it is taken nearer where it is farther
  // away than kMostMove allows. Throws what draw() and draw_left() throw.
  MovedView draw_moved(const core::View& view,
                       const std::function<core::RgbImage(const core::View&)>& draw_left);

  // Returns the distance of the eyes; 0 before the first view if it follows from that.
  double eye_base_m() const { return base_m_; }

 private:
  // Carries the panorama's view to another camera, at most `move_m` away, into carried_. Returns the image that it was carried
  // from, wider than `view` by the margin. Throws as draw().
  struct Wide {
    core::RgbImage image;
    glm::ivec2 margin_px{0, 0};
    std::int64_t filled = 0;
  };
  Wide carry(const core::View& view, const core::View& to, double move_m, float nearest_m,
             const std::function<core::RgbImage(const core::View&)>& draw_left);

  panorama::PanoramaMap map_;
  std::optional<panorama::PlaneReader> ranges_;
  SecondLookOptions options_;
  double base_m_ = 0;
  base::ThreadPool pool_;
  warp::Carrier carrier_;
  warp::CarriedImage carried_;
};

}  // namespace vpe::app
