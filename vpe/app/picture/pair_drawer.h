// Draws the two eyes of a pair, the second one by carrying the first (docs/design/warp.md).
//
// Typical usage:
//   PairDrawer pair(*renderer, planet, {.gap_px = 2});
//   core::DrawResult left = pair.first(left_request);
//   core::DrawResult right = pair.second(right_request);
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "paging/surface/surface.h"
#include "vpe/base/parallel.h"
#include "vpe/core/pixel_renderer.h"
#include "vpe/warp/carry.h"

namespace vpe::app {

struct PairOptions {
  double gap_px = 2;    // CarryOptions::gap_px, > 0
  bool filters = true;  // CarryOptions::filters
  // False: nothing is known about the air before the ground of pixels that are drawn. For comparison.
  bool uses_clear_air = true;
  // Bound of the memory beside the first eyes' renderer. Smaller: tiles are loaded again.
  std::size_t memory_bytes = std::size_t{256} << 20;
  int threads = 0;  // 0: all cores
};

// Returns the part of `memory_mb` that PairDrawer gets as PairOptions::memory_bytes; the rest is for the first eyes' renderer.
constexpr int pair_memory_mb(int memory_mb) { return memory_mb / 4; }

// Returns why a request's second eye cannot be carried, or "": rays have to be able to draw it, in perspective with one
// sample a pixel.
std::string why_not_carried(const core::DrawRequest& request);

// Draws pairs one after the other. One thread at a time.
class PairDrawer {
 public:
  // `renderer` draws the first eyes and must outlive this. If it draws rays it also draws what is left of the second eyes,
  // else this has rays of its own.
  PairDrawer(core::Renderer& renderer, const std::shared_ptr<const paging::PlanetFile>& planet,
             const PairOptions& options);

  // Draws the first eye in full: the image that `renderer` draws, to the bit where it draws rays.
  core::DrawResult first(const core::DrawRequest& request);

  // Draws the second eye. Its certificate has the larger bounds of the first eye's and of the pixels that were drawn, and
  // what carrying adds. Draws all pixels if the camera of either eye is below the ground. Throws std::logic_error without
  // a first eye.
  core::DrawResult second(const core::DrawRequest& request);

  // Returns what the drawn pixels of the last second eye took, seconds; 0 if all were drawn.
  double drawing_s() const { return drawing_s_; }
  // Returns where each pixel of the last second eye comes from, without colours; without pixels if all were drawn.
  const warp::CarriedImage& carried() const { return carried_; }

 private:
  // Smooths edges and applies gamma, as renderers do.
  void finish(const core::DrawRequest& request, core::Frame& frame);

  core::Renderer& renderer_;
  std::unique_ptr<core::PixelRenderer> own_rays_;  // null if renderer_ draws rays
  core::PixelRenderer* rays_ = nullptr;
  paging::Surface surface_;
  PairOptions options_;
  base::ThreadPool pool_;
  core::View view_;  // of the first eye
  core::Frame raw_;  // its image before edges are smoothed
  core::Certificate certificate_;
  bool has_first_ = false;
  double drawing_s_ = 0;
  warp::Carrier carrier_;
  warp::CarriedImage carried_;
  std::vector<std::uint8_t> wanted_;
  std::vector<float> inverse_depth_;
};

// Returns an image with the pixels in red that were drawn (Wan 2000, Fig. 8c).
std::vector<base::Rgb> with_drawn_pixels_red(const warp::CarriedImage& carried, const core::Frame& frame);

// Returns distances of colours between two images of equal size as shades of grey; 50 steps and more are white (Fig. 8e).
std::vector<base::Rgb> colour_differences(const core::Frame& a, const core::Frame& b);

}  // namespace vpe::app
