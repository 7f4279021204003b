// Chooses what draws the window: triangles, rays, or the quicker of both as the camera moves.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "vpe/core/backend.h"

namespace vpe::core {

enum class DrawnBy : std::uint8_t { kAuto, kPolygon, kRay };

// Returns "auto", "polygon" or "ray".
std::string_view to_string(DrawnBy drawn_by);

// Returns the choice of a backend that was named; kAuto if none was.
DrawnBy drawn_by(std::optional<Backend> named);

// Returns the backend that a choice names; nullopt for kAuto.
std::optional<Backend> named_backend(DrawnBy drawn_by);

// Describes what the choice depends on.
struct BackendInput {
  bool has_gpu = false;     // triangles are drawn by one
  bool suits_rays = true;   // rays can draw what the settings ask for
  double height_radii = 0;  // of the camera above the sphere, in radii
  Backend now = Backend::kPolygon;
};

// Returns the backend of the next image. kAuto is rays where there is no GPU, rays can draw the image, and the
// camera is nearer than kRaysReach_radii, as for single images; a tenth above or below that height keeps
// what draws now, so that the backend does not change to and fro. Pure.
Backend backend_for(DrawnBy drawn_by, const BackendInput& input);

}  // namespace vpe::core
