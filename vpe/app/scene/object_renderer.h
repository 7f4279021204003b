// A renderer that lays the objects of a scene file into the images of another renderer.
//
// Both backends get their objects from here, so that silhouettes, ranges, light and shadows are the same with each
// (objects/draw/composer.h). Requests without a scene go to the other renderer as they are.
//
// Typical usage:
//   std::unique_ptr<core::Renderer> renderer = with_objects(voxel::make_ray_renderer(planet), planet, {});
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

#include "paging/planet/planet_file.h"
#include "vpe/core/pixel_renderer.h"

namespace vpe::app {

struct ObjectRendererOptions {
  // For the ground's posts where objects stand and cast shadows; models are not counted. Smaller: posts are read again.
  std::size_t memory_bytes = std::size_t{64} << 20;
  int threads = 0;  // 0: all cores
  // Called with what was ignored in a model, once for each. Empty: it is not told.
  std::function<void(const std::string& note)> note = {};
};

// Return a renderer that draws objects, too. The scene is the setting `scene`; its reader's exceptions pass through
// draw(). The image's certificate states the error of the objects beside that of the ground.
std::unique_ptr<core::Renderer> with_objects(std::unique_ptr<core::Renderer> ground,
                                             std::shared_ptr<const paging::PlanetFile> planet,
                                             const ObjectRendererOptions& options);
std::unique_ptr<core::PixelRenderer> with_objects(std::unique_ptr<core::PixelRenderer> ground,
                                                  std::shared_ptr<const paging::PlanetFile> planet,
                                                  const ObjectRendererOptions& options);

}  // namespace vpe::app
