// The two rendering backends and their names.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace vpe::core {

// The method that turns a DrawRequest into a Frame. Both draw the same reference surface. Without a GPU, kRay
// is usually faster for single images and panoramas.
enum class Backend : std::uint8_t {
  kPolygon,  // triangle meshes on OpenGL (vpe/gl)
  kRay,      // ray casting on the CPU (vpe/voxel)
};

// Height of the camera above the sphere, in radii, from which on rays have no advantage over triangles without a
// GPU (docs/measurements/error-and-time.md).
inline constexpr double kRaysReach_radii = 1.0 / 30;

// Returns "polygon" or "ray".
std::string_view to_string(Backend backend);

// Returns the backend of that name; accepts former names (former_names.h). Returns nullopt for other text.
std::optional<Backend> parse_backend(std::string_view text);

}  // namespace vpe::core
