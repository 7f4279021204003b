// Made-up terrain on a planet, and a camera over its middle, for the papers' tables.
#pragma once

#include <filesystem>

#include "mars/geodesy/pose.h"
#include "vpe/app/planet/fractal_terrain.h"

namespace vpe::app {

// Holds a planet file and removes it at the end.
struct PatchScene {
  std::filesystem::path file;
  PatchBuild build;
  mars::Pose pose;  // level

  PatchScene() = default;
  PatchScene(const PatchScene&) = delete;
  PatchScene& operator=(const PatchScene&) = delete;
  ~PatchScene();
};

// Describes the terrain and the camera's place.
struct PatchSceneSpec {
  int levels = 2;             // 128 * 2^levels + 1 posts a side
  double height_share = 0.1;  // of the camera above the ground, of a side of the terrain
  int threads = 1;            // of the build
};

// Builds the planet file. Throws what build_patch() throws.
void build_patch_scene(const std::filesystem::path& file, const PatchSceneSpec& spec, PatchScene& scene);

}  // namespace vpe::app
