// Which backend draws when none is named.
#pragma once

#include <span>
#include <string>

#include "vpe/app/picture/image_options.h"

namespace vpe::app {

struct BackendChoice {
  std::string backend;      // kPolygonBackend or kRayBackend
  core::Settings settings;  // as given, and what this backend needs to keep to the tolerance
};

// Of --backend auto, for images that are all to be drawn by one backend; of another value that one, with the
// settings as given. Both keep to lod.tolerance; without a GPU rays are the quicker where an image reaches the
// horizon and the camera is near (docs/error-and-time.md). So it is rays when there is no GPU, half of the
// images or more reach the horizon of a sphere of radius_m from less than kFar of it above, and they draw all
// of them as asked: no wireframe, no tiles that are shown, no control of levels other than the tolerance. Rays
// then draw cells of the tolerance, or exactly where that is finer than cells go; where --set names a key of
// rays, as it says. Pure.
inline constexpr double kFar = 1.0 / 30;
BackendChoice choose_backend(const RenderOptions& options, const core::Settings& settings,
                             std::span<const core::DrawRequest> images, double radius_m, bool has_gpu);

// Whether rays draw this as triangles would: nothing of it is about triangles.
bool suits_rays(const core::DrawRequest& request);

}  // namespace vpe::app
