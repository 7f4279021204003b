// The scene whose objects obstruct lines of sight, and how a program opens it.
//
// Typical usage:
//   const SceneSight objects = open_scene({"gale.scene.toml", 0, time_s});
//   const LineOfSight sight = line_of_sight(surface, from, to, objects.first_object);
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "vpe/core/object_track.h"
#include "vpe/explore/measure/line_of_sight.h"

namespace vpe::explore {

// Names a scene as a window shows it.
struct SightScene {
  std::string file;            // empty: there are no objects
  std::uint64_t revision = 0;  // another number: the file was written again
  double time_s = 0;           // of paths and tracks
  std::shared_ptr<const std::vector<core::ObjectTrack>> tracks = nullptr;  // of a flight; null: none
};

// Holds the objects of a scene at one time.
struct SceneSight {
  FirstObject first_object;  // may be called from any thread; empty: there are no objects
  bool moves = false;        // at other times they stand elsewhere
};

// Returns the objects of a scene. Is called on one thread at a time. Throws what readers of scenes throw.
using OpenScene = std::function<SceneSight(const SightScene& scene)>;

// Returns whether what was measured among the objects of one scene holds for another. `moves` says what the first one's
// SceneSight does. Pure.
bool is_same_sight(const SightScene& measured, bool moves, const SightScene& shown);

}  // namespace vpe::explore
