// Polygon backend: draws selected tiles as textured triangle meshes.
#pragma once

#include <cstddef>
#include <functional>
#include <glm/vec2.hpp>
#include <memory>
#include <vector>

#include "paging/planet/planet_file.h"
#include "vpe/core/frame.h"
#include "vpe/gl/context.h"

namespace vpe::gl {

// Lets images stay in textures of a window whose context shares objects with the renderer's (Context::adopt). The caller
// fills in what it wants before each draw(); the renderer fills in the rest. core::Frame::colour stays empty then.
struct TextureHandover {
  unsigned texture = 0;  // OpenGL's name; its storage is made by the renderer. 0: pixels are wanted
  // GLsync, which is passed once the window no longer draws the texture; null: it does not.
  void* unused = nullptr;
  // Ranges are wanted at the corners of cells where the request wants rough ranges; 0: nowhere.
  glm::ivec2 cells{0, 0};

  bool is_drawn = false;  // false: the image needs the CPU, and is in the frame
  void* drawn =
      nullptr;  // GLsync, which is passed once the image is drawn; the renderer's until the next draw()
  std::vector<float> range_m = {};  // as core::Frame::range_m, of the pixels of corners (TextureFinish::draw)
  std::size_t bytes = 0;            // of textures of the renderer's own, which only this way needs
};

struct RendererOptions {
  // CPU and GPU payloads together. Smaller: coarser textures, more loading while the camera moves, and fewer
  // triangles (most_triangles()); larger: more memory of the process.
  std::size_t memory_bytes = std::size_t{1} << 30;
  // Threads that make pages; 0 = all cores. Fewer: tiles come later, drawing is disturbed less.
  int threads = 0;
  // Called by a loader on its thread before each page that it makes. May wait. An exception becomes the page's
  // failure. For tests of slow and broken storage.
  std::function<void(const lod::TileKey& tile)> before_load;
  // Null: images are pixels.
  std::shared_ptr<TextureHandover> handover = nullptr;
};

// Returns the number of triangles of the largest frame for which the memory is enough.
std::int64_t most_triangles(std::size_t memory_bytes);

// Relative error of a range, from the interpolation of depth over large triangles: a range is off by at most
// kRangeError * (1 + range / nearest range in the image) of itself.
inline constexpr double kRangeError = 5e-7;

// Makes a renderer of a planet. The context must be current on this thread, which alone may use the renderer.
// Throws std::runtime_error when OpenGL fails.
//
// Complete images (core::DrawResult::missing is empty) do not depend on what was drawn before, on threads or on
// the order in which tiles came. Other images have no holes: coarser tiles replace missing ones. Positions are
// relative to each tile's centre, the camera is subtracted in double, depth is reversed 32-bit float. The range
// of a pixel is the distance to the drawn triangle at the pixel's centre, +infinity for the sky. Ranges take
// passes of their own, with one sample a pixel. Only perspective views can be drawn. The renderer is a
// paging::PlanetUser too.
//
// Typical usage:
//
//   const std::shared_ptr<Context> context = Context::create();
//   const auto renderer = make_polygon_renderer(context, paging::PlanetFile::open("mars.vpe"));
//   const core::DrawResult result = renderer->draw(request);
std::unique_ptr<core::Renderer> make_polygon_renderer(std::shared_ptr<Context> context,
                                                      std::shared_ptr<const paging::PlanetFile> planet,
                                                      const RendererOptions& options = {});

}  // namespace vpe::gl
