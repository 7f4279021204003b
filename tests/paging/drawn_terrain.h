// The triangles that are drawn for a view, and rays against all of them: the brute-force oracle of culling.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "lod/occluder_profile.h"
#include "lod/select.h"
#include "paging/planet/planet_file.h"

namespace test_support {

// Holds one mesh in 3-D with its occluder profile.
struct DrawnMesh {
  std::vector<glm::dvec3> vertices;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;  // each once
  std::vector<std::uint16_t> triangles;
  lod::OccluderProfile occluders;
};

// Makes meshes by tile, variant and exaggeration, and keeps them.
class MeshStore {
 public:
  explicit MeshStore(std::shared_ptr<const paging::PlanetFile> planet) : planet_(std::move(planet)) {}
  const paging::PlanetFile& planet() const { return *planet_; }
  const DrawnMesh& mesh(const lod::SelectedTile& tile, double exaggeration);

 private:
  std::shared_ptr<const paging::PlanetFile> planet_;
  double exaggeration_ = 1.0;
  std::map<std::pair<std::uint32_t, int>, DrawnMesh> meshes_;
};

// Holds the meshes of all drawn tiles.
class DrawnTerrain {
 public:
  DrawnTerrain(MeshStore& store, const lod::Selection& selection, const glm::dvec3& camera_m);

  std::size_t size() const { return tiles_.size(); }
  const DrawnMesh& mesh(std::size_t tile) const { return *tiles_[tile].mesh; }

  // Returns whether the camera is above the terrain, or nullopt where no tile is drawn under the camera.
  std::optional<bool> camera_is_above() const;

  // Returns whether the ray from the camera to a point passes below a drawn edge that is nearer. The drawn
  // terrain has one radius for each direction, and in the ray's vertical plane it is straight between the
  // edges that cross the plane.
  bool blocked(const glm::dvec3& point) const;

 private:
  struct Tile {
    mars::ChartRect rect;
    std::array<glm::dvec3, 4> corners;
    const DrawnMesh* mesh;
  };
  std::vector<Tile> tiles_;
  glm::dvec3 camera_m_;
  glm::dvec3 up_;
};

}  // namespace test_support
