// The ray backend (`--backend ray`): draws the reference surface by ray casting on the CPU, without triangles
// and without OpenGL.
//
// A pixel gets its colour in this order (docs/design/rays.md):
//   RangeCaster     finds the range of every pixel (cast/range_caster.h):
//     SectorPlan      divides a perspective image into sectors of vertical columns (columns/view_sector.h),
//     ColumnBatch     hands neighbouring columns to threads (cast/column_batch.h),
//     ColumnWalk      leads a group of columns over the tiles from near to far (cast/column_walk.h),
//     walk_grid()     resolves rows at the edges of one tile's posts (columns/columns.h),
//     refine_row()    moves the ranges from the columns to the pixels' own rays (columns/refine.h);
//   cast_smooth()   takes its place for smooth ground (smooth/smooth_caster.h),
//   ImagePainter    colours ground, haze and sky of these ranges (paint/image_painter.h);
//   RayRenderer     (this file) averages samples, smooths edges, applies gamma and states the certificate.
// FramePrefetcher starts the same steps early for the next frame of a film (frame_prefetcher.h).
//
// Typical usage:
//   const auto renderer = make_ray_renderer(paging::PlanetFile::open("mars.vpe"));
//   core::DrawRequest request;
//   request.view.camera = mars::to_camera(pose, planet_radius_m);
//   request.settings.ray_mode = core::RayMode::kMultires;
//   if (const std::string reason = why_not(request); !reason.empty()) throw std::runtime_error(reason);
//   const core::DrawResult result = renderer->draw(request);
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <vector>

#include "lod/explain.h"
#include "paging/planet/planet_file.h"
#include "vpe/core/pixel_renderer.h"
#include "vpe/voxel/ray_request.h"

namespace vpe::voxel {

struct RayOptions {
  // Budget for decoded ground and its colours: 0.6 of it for casting, 0.4 for painting. Smaller: tiles are read
  // and decoded again, which takes time; larger: no gain once all tiles of an image fit. Smooth ground, once it was drawn,
  // takes up to 0.45 of it besides.
  std::size_t memory_bytes = std::size_t{1024} << 20;
  // Threads of casting and painting, the caller included; 0: as many as the machine runs at once. Fewer leave
  // processors to other work; images do not depend on it.
  int threads = 0;
  // Beside the budget, an image takes ray_image_bytes() while it is drawn. draw() refuses a larger image than
  // this before it reads a tile: by throwing std::runtime_error with what the image takes.
  std::size_t max_image_bytes = std::numeric_limits<std::size_t>::max();
  // If set, every draw() replaces its content by an explanation of each tile that the image was cast with
  // (explain_tiles.h). It must outlive the renderer.
  std::vector<lod::TileExplanation>* explained = nullptr;
};

// Returns a renderer of every projection, at any pitch and roll.
//
// Geometry: with rays.mode=exact the geometric error is 0: a pixel shows the reference surface as exaggerated,
// within RangeCaster::range_error(). With multires, or where the request asks for coarsening, far tiles are
// coarser, and the certificate states the bound. Colours are those of core::Appearance, from posts and images
// about as fine as a pixel.
//
// Smooth ground: with rays.mode=perturbation a pixel shows the first point of smooth patches through the posts
// (smooth/smooth_caster.h), and the certificate states their distance from the reference surface. Such images read all
// tiles that they need: paging::PlanetError for one that cannot be read. Images that may be coarser are cast in cells.
//
// Samples: several samples are complete images with shifted pixel centres, and their mean; the range is that of
// the pixel's centre. (Cohen-Or 1996, section 2, shares one column's walk among vertical samples; this does
// not.)
//
// Certificate: quantisation_px is the rounding of ranges. tolerance_px repeats lod.tolerance, which the polygon
// backend uses and this one does not: it says nothing about the image. In multires the choice of tiles depends
// on the weights, functions and tables of lod.* and on regions of interest as that of triangles does.
//
// A request that names the next one (DrawRequest::paging.next, a shared pointer to another request) lets the
// renderer start it early. The next request's own paging.next is ignored, so requests never form a chain here.
//
// Images do not depend on the number of threads or on what was drawn before. One thread at a time may call
// draw(). The renderer is a paging::PlanetUser too.
//
// Paging: a frame that waits reads its tiles while it casts, on the casting threads, until its time-out has been
// spent with reading. One that does not wait draws what is held, and loader threads of the renderer's own read
// the rest for the frames after it. It reads itself: the tiles below the camera; a root where nothing is held;
// ground that is coloured pixel by pixel (image_painter.h); and all of an image that the memory cannot hold at
// once. A tile that is not there, or cannot be read, is cast and painted with the posts of its nearest ancestor
// that is; the certificate's bounds include it. draw() throws std::runtime_error for a view or an appearance
// that it cannot draw, and paging::PlanetError where not even a root can be read.
std::unique_ptr<core::PixelRenderer> make_ray_renderer(std::shared_ptr<const paging::PlanetFile> planet,
                                                       const RayOptions& options = {});

}  // namespace vpe::voxel
