// Balls around the items of a scene, and the item that a ray meets.
#pragma once

#include <cstddef>
#include <functional>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "objects/model/mesh.h"
#include "vpe/core/object_track.h"
#include "vpe/explore/objects/scene_item.h"
#include "vpe/explore/terrain_query.h"

namespace vpe::explore {

// Returns a ball around a model, metres in the model's frame.
using ModelBall = std::function<objects::Ball(const objects::ModelEntry& model)>;

// A ball in the body-fixed frame around one object of an item, or around a scatter.
struct ItemBall {
  glm::dvec3 centre_m{0, 0, 0};
  double radius_m = 0;
  glm::dvec3 origin_m{0, 0, 0};  // of the model; what stands on the ground
};

struct ItemBallLimits {
  static constexpr std::size_t kMostOfItem = 1000;  // replicas; the first ones
};

// Returns the way that a flight gives an item, among all of its ways (null: none): that of the item's name, if it is a
// path or an object with one place. Else null.
const core::ObjectTrack* track_of(const SceneItem& item, const std::vector<core::ObjectTrack>* tracks);

// Returns the balls around an item at a time of its paths, on ground as it is drawn: one for each place, at most
// kMostOfItem; one around the corners of a scatter. `track` is what track_of() returns: the item is on that way, or has no
// ball while it is hidden. Pure but for the functions.
std::vector<ItemBall> balls_of(const SceneItem& item, const std::vector<objects::ModelEntry>& models,
                               const ModelBall& model_ball, const TerrainQuery& ground, double time_s,
                               const core::ObjectTrack* track = nullptr);

// A ray from `camera_m` along the unit direction, up to `until_m`.
struct PickRay {
  glm::dvec3 camera_m{0, 0, 0};
  glm::dvec3 direction{0, 0, 1};
  double until_m = std::numeric_limits<double>::infinity();  // where the ground is
  double reach_rad = 0;  // balls that are seen smaller than this radius count as so large
};

// Returns the distance at which a ray enters a ball before until_m; nullopt if it misses the ball or begins inside. Pure.
std::optional<double> meets(const PickRay& ray, const ItemBall& ball);

// Returns the index of the ball that a ray enters first, or nullopt. Pure.
std::optional<std::size_t> first_met(const PickRay& ray, std::span<const ItemBall> balls);

}  // namespace vpe::explore
