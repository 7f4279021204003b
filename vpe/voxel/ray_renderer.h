// The ray backend: pictures of the exact surface S without triangles and without OpenGL.
#pragma once

#include <cstddef>
#include <memory>

#include "paging/planet_file.h"
#include "vpe/core/frame.h"

namespace vpe::voxel {

struct RayOptions {
  std::size_t memory_bytes = std::size_t{1024} << 20;  // of decoded ground and its colours
  int threads = 0;                                     // 0: as many as the machine runs at once
};

// Draws every projection, at any pitch and roll. Each pixel's ray is cast against S as exaggerated
// (paging::Surface), so the picture has no tile error, and the range of a pixel is that of S but for rounding
// to float. Colours are those of core::Appearance, with posts and images about as fine as a pixel; ground of
// modes wireframe and markers, which show meshes, cannot be drawn. Does not depend on threads or on what was
// drawn before. Draws with one thread at a time. draw() throws std::runtime_error for a view or an appearance
// that it cannot draw, paging::PlanetError for unreadable tiles.
std::unique_ptr<core::Renderer> make_ray_renderer(std::shared_ptr<const paging::PlanetFile> planet,
                                                  const RayOptions& options = {});

}  // namespace vpe::voxel
