// Colours an image whose ranges are known: ground, haze, sky and nodata, as core::Appearance
// defines them.
//
// Stage of the pipeline (vpe/voxel/ray_renderer.h): the one after RangeCaster. Bands of rows are handed to
// threads. For each block of 32 pixels the kernel (paint_kernel.cpp) computes the places that the rays meet
// (ray_rows.h, paint_block-inl.h), finds their posts and texels (paint_tiles.h, paint_ground-inl.h) or facets
// (facet_tile.h, paint_facets-inl.h), shades them (paint_shading-inl.h, scale_table.h), and adds haze and sky
// (paint_air-inl.h), in vectors of the machine's instruction set.
//
// Typical usage:
//   ImagePainter painter(planet, memory_bytes);
//   std::vector<base::Rgb> colour(range_m.size());
//   const std::int64_t nodata_pixels = painter.paint(request, range_m, colour, {}, pool);
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "paging/shading/terrain_shader.h"
#include "vpe/base/parallel.h"
#include "vpe/core/frame.h"
#include "vpe/voxel/cast/pixel_normal.h"
#include "vpe/voxel/paint/made_tiles.h"
#include "vpe/voxel/paint/paint_sources.h"
#include "vpe/voxel/paint/scale_table.h"

namespace vpe::voxel {

struct PaintJob;  // paint_job.h

// One thread at a time may call paint().
class ImagePainter {
 public:
  // Holds at most about `budget_bytes` of posts and texels, also while painting. Smaller: tiles are read and
  // shaded again; larger: more memory.
  ImagePainter(std::shared_ptr<const paging::PlanetFile> planet, std::size_t budget_bytes);

  // Goes over to another version of the planet, as paging::PlanetUser::change_planet(). No other member may run
  // meanwhile.
  void change_planet(std::shared_ptr<const paging::PlanetFile> planet);

  // Paints the drawn part of request.view in any projection, and returns the number of nodata pixels.
  // `range_m` holds metres along the pixels' unit rays, core::kSkyRange for sky; rounding to float changes no
  // colour. Sets all of `colour`, or, unless `wanted` is empty, the pixels where it is not 0. All three hold one entry
  // for each pixel of the drawn part, row by row from the top.
  //
  // Colours are within 1/255 of TerrainShader::colour_at (nodata ground: nodata_image_at times nodata_tone(),
  // or core::kNodataMean without an image), core::air_m with core::haze_colour, and
  // core::sky_colour. At steps of a palette, and where flat ground has no aspect, they are those of the value
  // rounded to float. They are the same to the bit for any number of threads, any instruction set and any
  // earlier image. Modes wireframe and markers are painted as their ground would be. Throws paging::PlanetError
  // for unreadable tiles, and std::runtime_error for an unreadable palette.
  //
  // With `reading`, coarser posts and texels take the place of those that are not there, and paging::PlanetError
  // is thrown only where not even a root can be read. The facets of flat shading and the image at posts are read in
  // any case; where that fails, ground is coloured without them. Without any absent page the colours are those
  // without `reading`, to the bit.
  struct Reading {
    ReadingRule rule;
    std::vector<AbsentPage> absent = {};  // out
    std::string failure_of_points = {};   // out: why facets, or the image at posts, could not be had; or ""
  };
  //
  // Posts and texels are nominally at most post_px pixels wide. Smaller: sharper where the ground is seen at a grazing angle;
  // larger: blurred.
  //
  // With `normals`, an entry for each pixel or empty, light, slope, aspect and shadows follow from these where they have a share.
  // Flat shading does not use them.
  std::int64_t paint(const core::DrawRequest& request, std::span<const float> range_m,
                     std::span<base::Rgb> colour, std::span<const std::uint8_t> wanted, base::ThreadPool& pool,
                     Reading* reading = nullptr, std::span<const PixelNormal> normals = {}, double post_px = 1);

  // Returns the range of ground whose posts of level 0 are post_px pixels wide. Level n is painted from 2^-n times this range to
  // half of that.
  double level_range_m(const core::DrawRequest& request, double post_px) const;

  // Reads the tiles that painting `request` needs, as found by the pixels of `downsampled` with the given
  // ranges. `downsampled` sees what request.view sees, or a part of it. Ends early when `pool` is stopped, and
  // when the tiles of this image would fill more than half of the caches of their kind. Reads neither facets nor the
  // image at posts. Any thread may call it,
  // also while another one paints. Throws paging::PlanetError. With `reading` it finds what is absent instead.
  void read_ahead(const core::DrawRequest& request, const core::View& downsampled,
                  std::span<const float> range_m, const base::ThreadPool& pool,
                  Reading* reading = nullptr) const;

  // Reads a page, and records the failure if it cannot be read. Any thread may call it, also while another one
  // paints.
  void read(const PaintPage& page) const;
  // Returns how many pages such as this one the budget holds.
  std::size_t page_capacity(const PaintPage& page) const;

  std::size_t bytes_resident() const { return shader_.bytes_resident() + made_.bytes(); }

 private:
  void set_shading(const core::DrawRequest& request);
  std::int64_t paint_bands(const PaintJob& job, const paging::ShadingParams& shading, base::ThreadPool& pool,
                           Reading* reading);

  std::shared_ptr<const paging::PlanetFile> planet_;
  std::size_t budget_;
  mutable PaintFailures failures_;
  paging::TerrainShader shader_;
  MadeTiles made_;
  paging::ShadingParams shading_;
  core::Appearance scale_of_;
  std::shared_ptr<const core::ColourScale> scale_;
  ScaleTable table_;
};

}  // namespace vpe::voxel
