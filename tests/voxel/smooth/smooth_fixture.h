// Planets whose tiles have several levels, and the smooth ground over them.
#pragma once

#include <glm/geometric.hpp>
#include <string>

#include "tests/paging/planet_fixture.h"
#include "vpe/voxel/smooth/smooth_ground.h"

namespace test_support {

// Bumpy, with posts eight times as dense about a corner of the cube, an edge of it, and a place within a face.
inline std::shared_ptr<const paging::PlanetFile> levels_planet(
    const std::filesystem::path& path, const std::function<double(const glm::dvec3&)>& height = bumpy_height) {
  const glm::dvec3 corner = glm::normalize(glm::dvec3(1, 1, 1));
  const glm::dvec3 edge = glm::normalize(glm::dvec3(1, -1, 0.3));
  const glm::dvec3 inside = mars::direction({-63, 17});
  const FakeElevation source(height, [=](const mars::Cap& cap) {
    for (const glm::dvec3& at : {corner, edge, inside}) {
      if (glm::length(cap.centre - at) < cap.radius_rad + 0.02) return 6000.0;
    }
    return 1e9;
  });
  return build_fake(path, source, 60000);
}

// Holds a planet, its reference surface, and its smooth ground.
struct SmoothPlanet {
  explicit SmoothPlanet(std::shared_ptr<const paging::PlanetFile> file)
      : planet(std::move(file)),
        surface(planet, std::size_t{128} << 20),
        ground(surface, std::size_t{256} << 20) {}

  const lod::TileTree& tree() const { return planet->tree(); }

  std::shared_ptr<const paging::PlanetFile> planet;
  paging::Surface surface;
  vpe::voxel::SmoothGround ground;
};

inline const char* name_of(vpe::core::RayPatch patch) {
  return patch == vpe::core::RayPatch::kBicubic ? "bicubic" : "bilinear";
}

inline constexpr std::array<vpe::core::RayPatch, 2> kPatches{vpe::core::RayPatch::kBicubic,
                                                             vpe::core::RayPatch::kBilinear};

}  // namespace test_support
