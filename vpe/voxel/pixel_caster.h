// Casts the rays of single pixels of an image.
//
// Stage of the pipeline (vpe/voxel/ray_renderer.h): takes RangeCaster's place where most of an image is known. Strips along
// the borders of the image, where nothing is known about the air before the ground, are cast by columns; what lies
// scattered is cast ray by ray, from where the air is known to be clear (Wan 2000, section 3.2, where the air is clear up
// to the ground of the pixel below).
//
// Typical usage:
//   PixelCaster pixels(caster);
//   pixels.cast(view, range_options(request, radius_m), wanted, pool, range_m, &fallbacks);
#pragma once

#include <span>
#include <vector>

#include "vpe/base/parallel.h"
#include "vpe/core/pixel_renderer.h"
#include "vpe/voxel/cast/range_caster.h"

namespace vpe::voxel {

// Says how the wanted pixels of an image are cast.
struct PixelPlan {
  // Cast by columns; in pixels of the full image. They do not overlap.
  std::vector<core::SubRectangle> strips;
  // Others, ray by ray: columns of the drawn part that have any, those with most of them first.
  std::vector<int> columns;
  std::int64_t rays = 0;
};

// Plans the casting of a view. Everything is one strip where single rays would take longer than columns; other strips are
// for perspective views, where columns may be cast in part. Pure.
PixelPlan plan_pixels(const core::View& view, const core::WantedPixels& wanted);

// Keeps memory from one image to the next. One thread at a time may call it.
class PixelCaster {
 public:
  // `caster` must outlive this.
  explicit PixelCaster(const RangeCaster& caster) : caster_(caster) {}

  // Writes the ranges of the wanted pixels of a view's drawn part, and leaves the others alone. They are those
  // of RangeCaster::cast(), but for rays that meet something before they are known to be clear; with a cell_px above 0
  // rays that are cast one by one meet the reference surface itself. Returns the tiles that columns used and the steepest
  // slope. `fallbacks` as there.
  ColumnWalk::Usage cast(const core::View& view, const RangeOptions& options, const core::WantedPixels& wanted,
                         base::ThreadPool& pool, std::span<float> range_m, TileFallbacks* fallbacks);

  std::size_t bytes() const { return sectors_.bytes() + buffer_m_.capacity() * sizeof(float); }

 private:
  ColumnWalk::Usage cast_strip(const core::View& view, RangeOptions options, const core::SubRectangle& strip,
                               const core::WantedPixels& wanted, base::ThreadPool& pool,
                               std::span<float> range_m, TileFallbacks* fallbacks);

  const RangeCaster& caster_;
  SectorCaster sectors_;
  std::vector<float> buffer_m_;
};

}  // namespace vpe::voxel
