// The ray backend: images of the exact surface S without triangles and without OpenGL.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "paging/planet/planet_file.h"
#include "vpe/core/frame.h"

namespace vpe::voxel {

struct RayOptions {
  std::size_t memory_bytes = std::size_t{1024} << 20;  // of decoded ground and its colours
  int threads = 0;                                     // 0: as many as the machine runs at once
};

// Draws every projection, at any pitch and roll (vpe/voxel/cast/range_caster.h). With rays.mode=exact the image
// has no tile error: what a pixel shows is on S as exaggerated, within RangeCaster::range_error(). With
// multires, or where the request is for coarsening, tiles far away are coarser, and the certificate says by how
// much at most. Colours are those of core::Appearance, with posts and images about as fine as a pixel; ground
// of modes wireframe and markers, which show meshes, cannot be drawn. Several samples are rays shifted in
// parallel; range is that of the middle. Does not depend on threads or on what was drawn before. Draws with one
// thread at a time. draw() throws std::runtime_error for a view or an appearance that it cannot draw,
// paging::PlanetError for unreadable tiles. Why an image cannot be drawn by rays, for people; empty: it can.
std::string why_not(const core::DrawRequest& request);

std::unique_ptr<core::Renderer> make_ray_renderer(std::shared_ptr<const paging::PlanetFile> planet,
                                                  const RayOptions& options = {});

}  // namespace vpe::voxel
