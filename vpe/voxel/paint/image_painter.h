// Colours of an image whose ranges are known: ground, haze, sky and gaps, as core::Appearance defines them.
//
// Many pixels at once: a ray's place comes from terms of its row and column and its range, the posts and texels
// under it from squares of the chart that a thread has at hand, and the rest in vectors, for the instruction
// set that the machine has. Flat shading and colour=image are left to paging::TerrainShader::colour_at, pixel
// by pixel, at some 17 and 50 times the cost (docs/rays.md).
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "paging/shading/terrain_shader.h"
#include "vpe/base/parallel.h"
#include "vpe/core/frame.h"
#include "vpe/voxel/paint/scale_table.h"

namespace vpe::voxel {

// paint(): one caller at a time.
class ImagePainter {
 public:
  // Between images and while painting, holds at most about `budget_bytes` of posts and texels.
  ImagePainter(std::shared_ptr<const paging::PlanetFile> planet, std::size_t budget_bytes);

  // Paints the drawn part of request.view, any projection. range_m: of its pixels, metres along their unit
  // rays, core::kSkyRange = sky; rounded to float they move no colour. Sets all of `colour`, and
  // `inverse_depth`, when it is not empty, to 1 / metres along the camera's axis, at most 1000, 0 = sky
  // (perspective views). All three are as long as the part has pixels. Returns the number of pixels without
  // data.
  //
  // Within 1/255 of TerrainShader::colour_at, core::air_m with core::haze_colour, and core::sky_colour; at
  // steps of a palette, and where flat ground has no aspect, within rounding of the value to float. The same
  // bits for any number of threads, any instruction set and whatever was painted before. Modes wireframe and
  // markers are painted as their ground would be. Throws paging::PlanetError, and std::runtime_error for an
  // unreadable palette.
  std::int64_t paint(const core::DrawRequest& request, std::span<const float> range_m,
                     std::span<base::Rgb> colour, std::span<float> inverse_depth, base::ThreadPool& pool);

  // Reads what painting `request` takes, as far as rays through the pixels of `thin` tell, whose ranges are
  // given. `thin` sees what request.view sees, or a part of it. Ends early when `pool` is stopped, and when the
  // tiles of this image would take more than half of what the caches have for their kind. Any thread; also
  // while others paint. Throws PlanetError.
  void read_ahead(const core::DrawRequest& request, const core::View& thin, std::span<const float> range_m,
                  const base::ThreadPool& pool) const;

  std::size_t bytes_resident() const { return painter_.bytes_resident(); }

 private:
  void set_shading(const core::DrawRequest& request);

  std::shared_ptr<const paging::PlanetFile> planet_;
  std::size_t budget_;
  paging::TerrainShader painter_;
  paging::ShadingParams shading_;
  core::Appearance scale_of_;
  std::shared_ptr<const core::ColourScale> scale_;
  ScaleTable table_;
};

}  // namespace vpe::voxel
