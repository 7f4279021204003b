// The triangles of the reference surface in Embree: a peer in reports and benchmarks, and an oracle of tests.
// Built with VPE_EMBREE=ON; tests compile it themselves wherever Embree is installed.
#pragma once

#include <embree3/rtcore.h>

#include <atomic>
#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "paging/planet/planet_file.h"

namespace vpe::app {

enum class EmbreeShape {
  kTriangles,  // RTC_GEOMETRY_TYPE_TRIANGLE
  kGrid,       // RTC_GEOMETRY_TYPE_GRID: less memory, and slower
};

struct EmbreeOptions {
  EmbreeShape shape = EmbreeShape::kTriangles;
  RTCBuildQuality quality = RTC_BUILD_QUALITY_HIGH;
  bool robust = false;  // RTC_SCENE_FLAG_ROBUST: fewer rays through edges, and slower
  int threads = 0;      // for building; 0: all
};

// Returns the finest tiles with ground that the camera may see.
std::vector<lod::TileKey> tiles_in_sight(const paging::PlanetFile& planet, const glm::dvec3& camera_m);

// Returns the number of triangles of the tiles.
std::int64_t triangle_count(const paging::PlanetFile& planet, const std::vector<lod::TileKey>& tiles);

// Holds finest tiles as one Embree scene, a geometry for each, in floats relative to the camera, so that rays
// start at 0. Cells are split along the diagonal of lod/tree/posts.h in both shapes. Any thread may cast into
// scene().
class EmbreeScene {
 public:
  // Throws paging::PlanetError, and std::runtime_error with Embree's message.
  EmbreeScene(const paging::PlanetFile& planet, const std::vector<lod::TileKey>& tiles,
              const glm::dvec3& camera_m, const EmbreeOptions& options = {});
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  RTCScene scene() const { return scene_; }
  std::int64_t triangles() const { return triangles_; }
  double build_s() const { return build_s_; }    // for Embree's structure alone, posts already decoded
  std::int64_t bytes() const { return bytes_; }  // held by Embree, vertices included

  // Returns the range along a direction in units of its length (metres for a unit vector), or infinity.
  double cast(const glm::dvec3& direction) const;

 private:
  void add_tile(const paging::PlanetFile& planet, const lod::TileKey& key, unsigned id,
                const glm::dvec3& camera_m, const EmbreeOptions& options);
  void check(const char* what) const;

  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
  std::vector<std::uint32_t> indices_;  // triangles of one tile, the same for all
  std::int64_t triangles_ = 0;
  double build_s_ = 0;
  std::atomic<std::int64_t> bytes_{0};
};

}  // namespace vpe::app
