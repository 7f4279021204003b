// Draws the two eyes of a pair, the second one by carrying the first (docs/design/warp.md).
//
// Typical usage:
//   PairDrawer pair(*renderer, *rays, surface, {.gap_px = 2});
//   core::DrawResult left = pair.first(left_request);
//   core::DrawResult right = pair.second(right_request);
#pragma once

#include <memory>

#include "paging/surface/surface.h"
#include "vpe/base/parallel.h"
#include "vpe/core/pixel_renderer.h"
#include "vpe/warp/carry.h"

namespace vpe::app {

struct PairOptions {
  double gap_px = 2;  // CarryOptions::gap_px, > 0
  bool filters = true;
  int threads = 0;
};

// Returns why a request's second eye cannot be carried, or "": rays have to be able to draw it, in perspective with one
// sample a pixel.
std::string why_not_carried(const core::DrawRequest& request);

// One thread at a time.
class PairDrawer {
 public:
  // All arguments must outlive this. `renderer` draws the first eye, `rays` what is left of the second; they may be the
  // same.
  PairDrawer(core::Renderer& renderer, core::PixelRenderer& rays, const paging::Surface& surface,
             const PairOptions& options);

  // Draws the first eye in full: the image that `renderer` draws, to the bit where that is the ray backend.
  core::DrawResult first(const core::DrawRequest& request);

  // Draws the second eye. Its certificate has the larger bounds of the first eye's and of the pixels that were drawn, and
  // what carrying adds. Throws std::logic_error without a first eye.
  core::DrawResult second(const core::DrawRequest& request);

  // Returns where each pixel of the last second eye comes from.
  const warp::CarriedImage& carried() const { return carried_; }

 private:
  // Smooths edges and applies gamma, as renderers do.
  void finish(const core::DrawRequest& request, core::Frame& frame);

  core::Renderer& renderer_;
  core::PixelRenderer& rays_;
  const paging::Surface& surface_;
  PairOptions options_;
  base::ThreadPool pool_;
  core::View view_;  // of the first eye
  core::Frame raw_;  // its image before edges are smoothed
  core::Certificate certificate_;
  bool has_first_ = false;
  warp::Carrier carrier_;
  warp::CarriedImage carried_;
  std::vector<std::uint8_t> wanted_;
  std::vector<float> inverse_depth_;
};

}  // namespace vpe::app
