// Carries a finished image with its ranges to another view of the same ground.
//
// Source: Wan, Zhang, Kaufman, Qu (2000), "Interactive stereoscopic rendering of voxel-based terrain", sections 2.2 to
// 2.5, for a second eye; here also for any other view. Each pixel's point moves to its place in the new view. Between
// the places of neighbours lies the ground between them, or, where they have moved apart, ground that the first image
// may not show: such pixels are open. The places and the edges between them are a closed surface around air that the
// first camera has looked through, so what lies behind it is hidden from the new camera, whatever it is.
//
// Stage of the pipeline: after the first image, before the open pixels are drawn by a renderer.
//
// Typical usage:
//   Carrier carrier;
//   CarriedImage carried;
//   carrier.carry(left, frame, right, {.nearest_m = 20}, pool, carried);
//   for (std::size_t n = 0; n < carried.origin.size(); ++n)
//     if (carried.origin[n] == Origin::kOpen) draw_pixel(n);
#pragma once

#include <limits>
#include <memory>
#include <string>

#include "vpe/base/parallel.h"
#include "vpe/core/frame.h"
#include "vpe/core/view.h"
#include "vpe/warp/carried_image.h"

namespace vpe::warp {

struct MovedPixels;

struct CarryLimits {
  static constexpr double kMaxGap_px = 16;
};

struct CarryOptions {
  // Widest distance of two neighbours in the new image that is filled by what lies between them, 0 to
  // CarryLimits::kMaxGap_px pixels; in an image of the same view neighbours are 1 apart. Larger: fewer open pixels, and an
  // error of up to gap_px - 1 between neighbours (CarriedImage::added_px); below 1 all ground is open. 0: nothing is
  // carried.
  double gap_px = 2;
  // Largest bound of what carrying may add to a pixel's position (CarriedImage::added_px), pixels, >= 0; ground beyond it
  // is open. Smaller: fewer carried pixels.
  float most_added_px = std::numeric_limits<float>::infinity();
  // Distance from the new camera within which there is no ground outside of what the first image shows, metres, >= 0.
  // Larger: fewer open pixels at the border; too large: something beside the first image is missed that hides a carried
  // pixel. 0: safe; every pixel is open whose ray begins beside the first image.
  double nearest_m = 0;
  // False: each pixel takes its nearest neighbour's colour instead of what lies between two: the position of textures
  // is then wrong by up to half a pixel. For comparison.
  bool filters = true;
};

// Returns "" if an image can be carried from one view to the other, else why not and what to do. Both views must be
// perspective.
std::string check_carry(const core::View& from, const core::View& to);

// Carries images. Keeps the memory that it needs from one to the next. One thread at a time may call it.
class Carrier {
 public:
  Carrier();
  ~Carrier();
  Carrier(Carrier&&) noexcept;
  Carrier& operator=(Carrier&&) noexcept;

  // Carries `frame`, drawn as `from` sees it, with ranges and, unless its colours are empty, colours. The colour of a
  // pixel is that of the first image there: what depends on the direction of view is not computed again. Replaces `into`.
  //
  // Exact for equal views. Positions: on ground that is flat between neighbours within kCarriedPosition_px; elsewhere within
  // CarriedImage::added_px, if the ground between neighbours is no nearer than the nearer and no farther than the farther
  // of them. Ranges: likewise. No pixel shows ground that the first image's surface hides, but for silhouettes, which are
  // those of the first image's pixels: they are up to the distance of two of its pixels off.
  //
  // A view that differs by a shift along its right axis and in principal_offset_px.x, as a second eye does, is carried row
  // by row, in a fraction of the time of other views. The result is the same to the bit for any number of threads.
  // Throws std::invalid_argument where check_carry() or the options' limits are violated, or the frame has no ranges.
  void carry(const core::View& from, const core::Frame& frame, const core::View& to,
             const CarryOptions& options, base::ThreadPool& pool, CarriedImage& into);

 private:
  std::unique_ptr<MovedPixels> pixels_;
};

// Carries a single image.
CarriedImage carry(const core::View& from, const core::Frame& frame, const core::View& to,
                   const CarryOptions& options, base::ThreadPool& pool);

}  // namespace vpe::warp
