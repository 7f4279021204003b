// The backend of --backend auto.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "vpe/app/picture/image_options.h"

namespace vpe::app {

struct BackendChoice {
  core::Backend backend;
  core::Settings settings;  // the settings given, changed where this backend needs it to keep to the tolerance
};

// Chooses the backend for images that are all drawn by one backend. A backend named in the options is taken,
// with the settings unchanged.
//
// Both backends keep to lod.tolerance. Without a GPU, rays are faster where an image reaches the horizon and
// the camera is near (docs/measurements/error-and-time.md). So the choice is rays when all of these hold: there
// is no GPU; at least half of the images reach the horizon of a sphere of radius_m from less than
// core::kRaysReach_radii above it; and rays can draw all of them as requested (suits_rays()). Rays then use cells
// of the tolerance, or mode exact where the tolerance is finer than the smallest cell; where --set names a key of
// rays, the settings stay unchanged. Pure.
BackendChoice choose_backend(const RenderOptions& options, const core::Settings& settings,
                             std::span<const core::DrawRequest> images, double radius_m, bool has_gpu);

// Returns true if nothing in the request is about triangles, so that rays draw the same image: no wireframe, no
// inspection of tiles, no limit of triangles.
bool suits_rays(const core::DrawRequest& request);

// Returns the choice of rays for images that are to be drawn by triangles, for a machine without OpenGL; nullopt
// if rays cannot draw them. Pure.
std::optional<BackendChoice> rays_instead(const RenderOptions& options, const core::Settings& settings,
                                          std::span<const core::DrawRequest> images);
// Says so on stderr. `reason`: the words of gl::ContextError.
void note_rays_instead(const std::string& reason, bool quiet);

}  // namespace vpe::app
