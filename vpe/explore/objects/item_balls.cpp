#include "vpe/explore/objects/item_balls.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "objects/scene/place.h"
#include "objects/scene/track.h"

namespace vpe::explore {

namespace {

ItemBall ball_around(const objects::Instance& instance, const objects::Ball& ball) {
  const double scale = static_cast<double>(instance.scale);
  return {instance.position_m + scale * (glm::dquat(instance.rotation) * glm::dvec3(ball.centre_m)),
          scale * static_cast<double>(ball.radius_m), instance.position_m};
}

ItemBall ball_around(const objects::ScatterEntry& scatter, const TerrainQuery& ground) {
  glm::dvec3 middle{0, 0, 0};
  for (const mars::LonLat corner : scatter.polygon) middle += mars::direction(corner);
  if (glm::length(middle) < 1e-9) middle = mars::direction(scatter.polygon.front());
  middle = glm::normalize(middle);
  ItemBall ball;
  ball.centre_m = ball.origin_m = middle * (ground.radius_m + ground.height_m(middle));
  for (const mars::LonLat corner : scatter.polygon) {
    const glm::dvec3 up = mars::direction(corner);
    ball.radius_m =
        std::max(ball.radius_m, glm::length(up * (ground.radius_m + ground.height_m(up)) - ball.centre_m));
  }
  return ball;
}

}  // namespace

const core::ObjectTrack* track_of(const SceneItem& item, const std::vector<core::ObjectTrack>* tracks) {
  const bool is_path = std::holds_alternative<objects::PathEntry>(item.entry);
  if (tracks == nullptr || (!is_path && single_placing(item) == nullptr)) return nullptr;
  const auto found = std::ranges::find(*tracks, item_name(item), &core::ObjectTrack::name);
  return found == tracks->end() ? nullptr : &*found;
}

std::vector<ItemBall> balls_of(const SceneItem& item, const std::vector<objects::ModelEntry>& models,
                               const ModelBall& model_ball, const TerrainQuery& ground, double time_s,
                               const core::ObjectTrack* track) {
  if (track != nullptr && !core::is_shown(*track, time_s)) return {};
  const bool has_way = track != nullptr && !track->points.empty();
  const objects::GroundRadius radius_m = [&ground](const glm::dvec3& up) {
    return ground.radius_m + ground.height_m(up);
  };
  if (const auto* scatter = std::get_if<objects::ScatterEntry>(&item.entry)) {
    if (scatter->polygon.empty()) return {};
    return {ball_around(*scatter, ground)};
  }
  if (const auto* path = std::get_if<objects::PathEntry>(&item.entry)) {
    if (path->points.empty() || path->model >= models.size()) return {};
    objects::PathEntry moved = *path;
    if (has_way) moved.points = objects::path_points(*track);
    return {ball_around(objects::path_instance(moved, time_s, radius_m), model_ball(models[path->model]))};
  }
  const auto& object = std::get<objects::ObjectEntry>(item.entry);
  std::vector<ItemBall> balls;
  if (object.model >= models.size()) return balls;
  const objects::Ball ball = model_ball(models[object.model]);
  const std::size_t count = std::min(object.places.size(), ItemBallLimits::kMostOfItem);
  balls.reserve(count);
  for (std::size_t n = 0; n < count; ++n) {
    const objects::Placing placing =
        has_way ? objects::placing_at(object.places[n], objects::path_points(*track), time_s)
                : object.places[n];
    const double size_m = static_cast<double>(ball.radius_m) * placing.scale;
    balls.push_back(ball_around(objects::place_instance(placing, size_m, ground.radius_m, radius_m), ball));
  }
  return balls;
}

std::optional<double> meets(const PickRay& ray, const ItemBall& ball) {
  const glm::dvec3 to_centre = ball.centre_m - ray.camera_m;
  const double along_m = glm::dot(to_centre, ray.direction);
  const double distance_m = glm::length(to_centre);
  const double radius_m = std::max(ball.radius_m, distance_m * std::sin(ray.reach_rad));
  if (along_m <= 0 || distance_m <= ball.radius_m) return std::nullopt;
  const double aside_m = glm::length(to_centre - along_m * ray.direction);
  if (aside_m > radius_m) return std::nullopt;
  const double enters_m = along_m - std::sqrt((radius_m - aside_m) * (radius_m + aside_m));
  return enters_m < ray.until_m ? std::optional(std::max(enters_m, 0.0)) : std::nullopt;
}

std::optional<std::size_t> first_met(const PickRay& ray, std::span<const ItemBall> balls) {
  std::optional<std::size_t> first;
  double nearest_m = ray.until_m;
  for (std::size_t n = 0; n < balls.size(); ++n) {
    const auto at_m = meets(ray, balls[n]);
    if (!at_m || (first && *at_m >= nearest_m)) continue;
    nearest_m = *at_m;
    first = n;
  }
  return first;
}

}  // namespace vpe::explore
