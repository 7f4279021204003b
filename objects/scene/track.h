// Objects of a scene file that a flight moves.
#pragma once

#include <cstddef>
#include <vector>

#include "objects/files/scene_file.h"
#include "vpe/core/object_track.h"

namespace objects {

struct TrackTarget {
  bool is_path = false;   // else one of SceneFile::objects, with one place
  std::size_t entry = 0;  // of SceneFile::paths or SceneFile::objects
};

// Returns the one object or path of a scene that has the name of a track. Throws std::runtime_error, naming the scene
// file, if there is none or several, or if it has several places or is part of the ground.
TrackTarget track_target(const SceneFile& scene, const vpe::core::ObjectTrack& track);

// Returns the points of a track as those of a path.
std::vector<PathPoint> path_points(const vpe::core::ObjectTrack& track);

}  // namespace objects
