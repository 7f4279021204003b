// Draws images most of whose pixels are carried from another image of the same ground (docs/design/warp.md): the second
// eye of a pair, or frames of a film near a key frame.
//
// Typical usage:
//   CarriedDrawer pair(*renderer, planet, {.gap_px = 2});
//   core::DrawResult left = pair.draw_first(left_request);
//   core::DrawResult right = pair.draw_carried(right_request);
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "paging/surface/surface.h"
#include "vpe/base/parallel.h"
#include "vpe/core/pixel_renderer.h"
#include "vpe/warp/carry.h"

namespace vpe::app {

struct CarriedDrawerOptions {
  double gap_px = 2;  // CarryOptions::gap_px, > 0
  // CarryOptions::most_added_px.
  double most_added_px = std::numeric_limits<double>::infinity();
  // An image of which a larger share than this would have to be drawn is drawn in full, 0 to 1. Smaller: more images are,
  // with no error by carrying.
  double most_drawn_share = 1;
  // True: where settings.background is the sky, its colours are computed for the new camera. False: they are those of the
  // first image, moved, which two eyes near each other cannot tell apart.
  bool repaints_sky = false;
  bool filters = true;  // CarryOptions::filters
  // False: nothing is known about the air before the ground of pixels that are drawn. For comparison.
  bool uses_clear_air = true;
  // Bound of the memory beside the renderer of the first images. Smaller: tiles are loaded again.
  std::size_t memory_bytes = std::size_t{256} << 20;
  int threads = 0;  // 0: all cores
};

// Returns the part of `memory_mb` that CarriedDrawer gets as CarriedDrawerOptions::memory_bytes; the rest is for the
// renderer of the first images.
constexpr int carrying_memory_mb(int memory_mb) { return memory_mb / 4; }

// Returns why a request's image cannot be carried from another one, or "": rays have to be able to draw it, in perspective
// with one sample a pixel.
std::string why_not_carried(const core::DrawRequest& request);

// Draws first images in full and others by carrying the last of them. One thread at a time.
class CarriedDrawer {
 public:
  // `renderer` draws the first images and must outlive this. If it draws rays it also draws what is left of carried images,
  // else this has rays of its own.
  CarriedDrawer(core::Renderer& renderer, const std::shared_ptr<const paging::PlanetFile>& planet,
                const CarriedDrawerOptions& options);

  // Goes over to another version of the planet, to which the renderer of the first images has gone over. Forgets the first
  // image. Throws what paging::change_planet() throws.
  void change_planet(const std::shared_ptr<const paging::PlanetFile>& planet);

  // Draws an image in full: the image that `renderer` draws, to the bit where it draws rays. With a margin, pixels on each
  // side, more than the image is drawn (core::with_margin), so that less is left of the images that are carried from it;
  // then ranges are the same but for rounding.
  core::DrawResult draw_first(const core::DrawRequest& request, glm::ivec2 margin_px = {0, 0});

  // Draws an image by carrying the last first one. Its certificate has the larger bounds of the first image's and of the
  // pixels that were drawn, and what carrying adds. Draws all pixels if either camera is below the ground, if the first
  // image shows a semi-transparent object, or by CarriedDrawerOptions::most_drawn_share. Both requests may differ in their views only. Throws std::logic_error without
  // a first image.
  core::DrawResult draw_carried(const core::DrawRequest& request);

  // Returns what the drawn pixels of the last carried image took, seconds; 0 if all were drawn.
  double drawing_s() const { return drawing_s_; }
  // Returns where each pixel of the last carried image comes from, without colours; without pixels if all were drawn.
  const warp::CarriedImage& carried() const { return carried_; }

 private:
  // Smooths edges and applies gamma, as renderers do.
  void finish(const core::DrawRequest& request, core::Frame& frame);
  // Decides which pixels are drawn, and what is known about their rays.
  void choose_pixels(const core::DrawRequest& request);

  core::Renderer& renderer_;
  std::unique_ptr<core::PixelRenderer> own_rays_;  // null if renderer_ draws rays
  core::PixelRenderer* rays_ = nullptr;
  paging::Surface surface_;
  CarriedDrawerOptions options_;
  base::ThreadPool pool_;
  core::View view_;  // of the first image
  core::Frame raw_;  // the first image before edges are smoothed
  core::Certificate certificate_;
  double clear_of_objects_m_ = 0;
  bool shows_see_through_ = false;
  bool has_first_ = false;
  double drawing_s_ = 0;
  warp::Carrier carrier_;
  warp::CarriedImage carried_;
  std::vector<std::uint8_t> wanted_;
  std::vector<float> clear_m_;
  std::vector<float> inverse_depth_;
};

// Returns an image with the pixels in red that were drawn (Wan 2000, Fig. 8c).
std::vector<base::Rgb> with_drawn_pixels_red(const warp::CarriedImage& carried, const core::Frame& frame);

// Returns distances of colours between two images of equal size as shades of grey; 50 steps and more are white (Fig. 8e).
std::vector<base::Rgb> colour_differences(const core::Frame& a, const core::Frame& b);

}  // namespace vpe::app
