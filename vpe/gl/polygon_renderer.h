// The polygon backend: selected tiles as textured triangle meshes.
#pragma once

#include <functional>
#include <memory>

#include "paging/planet/planet_file.h"
#include "vpe/core/frame.h"
#include "vpe/gl/context.h"

namespace vpe::gl {

struct RendererOptions {
  std::size_t memory_bytes = std::size_t{1} << 30;  // CPU and GPU payloads together
  int threads = 0;                                  // for making tiles ready; 0 = all cores
  // Called by a loader before each page that it makes, on its thread; may wait, and may throw what then is the
  // page's failure. For tests of slow and broken storage.
  std::function<void(const lod::TileKey& tile)> before_load;
};

// Triangles of the largest frame for which the memory is enough.
std::int64_t most_triangles(std::size_t memory_bytes);

// Complete images (core::DrawResult::missing is empty) do not depend on what was drawn before, on threads or
// on the order in which tiles came. Others are in full cover: coarser tiles stand in for missing ones.
// Positions are relative to each tile's centre, the camera is subtracted in double, depth is reversed 32-bit
// float. Range of a pixel is the distance to the drawn triangle at the pixel's centre; its relative error is at
// most kRangeError * (1 + range / nearest range in the image), from the interpolation of depth over large
// triangles. Sky pixels are +infinity. Range takes passes of its own, with one sample a pixel.
inline constexpr double kRangeError = 5e-7;
std::unique_ptr<core::Renderer> make_polygon_renderer(std::shared_ptr<Context> context,
                                                      std::shared_ptr<const paging::PlanetFile> planet,
                                                      const RendererOptions& options = {});

}  // namespace vpe::gl
