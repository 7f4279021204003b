#include "objects/draw/object_rays.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>
#include <numeric>
#include <optional>

#include "objects/draw/volume_rays.h"
#include "objects/model/surface_sample.h"

namespace objects {

namespace {

// The part of a ray in an object's ball, and the ray in the model frame from where it enters.
struct LocalRay {
  ModelRay ray;
  double begin_m = 0;
  double end_m = 0;
};

// Returns false if a ray passes the ball around an object by more than rounding.
bool passes_ball(const PlacedObject& o, const ObjectRay& ray) {
  const glm::dvec3 to = o.around.centre_m - ray.origin_m;
  const double along = glm::dot(to, ray.direction);
  const double to2 = glm::dot(to, to);
  const double reach2 = o.around.radius_m * o.around.radius_m;
  // Of the two squares whose difference is compared.
  constexpr double kSquareError = 1e-14;
  if (to2 - along * along > reach2 + kSquareError * to2) return false;
  return along >= 0 || to2 <= reach2;
}

std::optional<LocalRay> enter(const PlacedObject& o, const ObjectRay& ray, double until_m) {
  if (!passes_ball(o, ray)) return std::nullopt;
  // Along `direction` a metre of the ray is a step of 1.
  const glm::dvec3 origin = o.to_model * (ray.origin_m - o.position_m);
  const glm::dvec3 direction = o.to_model * ray.direction;
  const glm::dvec3 to_ball = o.ball_m - origin;
  const double length2 = glm::dot(direction, direction);
  const double middle = glm::dot(to_ball, direction) / length2;
  const glm::dvec3 beside = to_ball - middle * direction;
  const double across2 = glm::dot(beside, beside);
  const double radius2 = o.ball_radius_m * o.ball_radius_m;
  if (across2 > radius2) return std::nullopt;
  const double half = std::sqrt((radius2 - across2) / length2);
  LocalRay local;
  local.begin_m = std::max(0.0, middle - half);
  local.end_m = std::min(middle + half, until_m);
  if (local.begin_m > local.end_m) return std::nullopt;
  local.ray = {glm::vec3(origin + local.begin_m * direction), glm::vec3(direction)};
  return local;
}

// The ball's radius was rounded up, so a hit lies before its end; floats round that end.
float length_of(const LocalRay& local) {
  return static_cast<float>((local.end_m - local.begin_m) * (1 + 1e-6));
}

void meet_sticks(const PlacedObject& o, std::uint32_t n, const LocalRay& local, double end_m, RayResult& out) {
  StickHits hits;
  o.model->sticks()->cast(local.ray, o.level_index, length_of(local), hits);
  for (const StickLayer& layer : hits.layers) {
    ObjectHit& hit = out.layers.emplace_back();
    hit.range_m = local.begin_m + static_cast<double>(layer.t);
    hit.object = n;
    hit.triangle = static_cast<std::uint32_t>(out.layers.size());  // layers stay apart
    hit.voxel = layer.voxel;
    hit.face = -glm::normalize(local.ray.direction);
    hit.opacity = 255 * layer.opacity;
  }
  if (!hits.has_front) return;
  const double range_m = local.begin_m + static_cast<double>(hits.front.t);
  if (range_m >= end_m) return;
  out.front = {};
  out.front.range_m = range_m;
  out.front.object = n;
  out.front.voxel = hits.front.voxel;
  out.front.face = hits.front.face;
  out.has_front = true;
}

bool hides_back(const PlacedObject& o, const TriangleHit& hit) {
  const Material& m = o.level->mesh.material_table[o.level->mesh.materials[hit.triangle]];
  return !m.double_sided && hit.is_back;
}

}  // namespace

bool meets(const ViewCone& cone, const glm::dvec3& origin_m, const glm::dvec3& centre_m, double radius_m) {
  const glm::dvec3 to = centre_m - origin_m;
  const double distance = glm::length(to);
  if (distance <= radius_m) return true;
  // The angle to the centre is at most that of the cone and that of the ball together.
  const double along = glm::dot(to, cone.axis);
  const double across = std::sqrt(std::max(0.0, distance * distance - along * along));
  const double ball_sine = radius_m / distance;
  const double ball_cosine = std::sqrt(1 - ball_sine * ball_sine);
  const double sine = cone.sine * ball_cosine + cone.cosine * ball_sine;
  const double cosine = cone.cosine * ball_cosine - cone.sine * ball_sine;
  if (sine <= 0 && cosine < 0) return true;  // together over 180 degrees
  return along * sine - across * cosine >= -1e-9 * distance || (cosine > 0 && along > 0 && across <= radius_m);
}

double ObjectRays::diameter_px(double radius_m, double distance_m) const {
  if (distance_m <= radius_m) return std::numeric_limits<double>::infinity();
  return 2 * radius_m * rule_.focal_px * rule_.stretch / distance_m;
}

PlacedObject ObjectRays::placed(std::uint32_t n) const {
  const Instance i = scene_.instance(n);
  PlacedObject o;
  o.model = scene_.models()[i.model].get();
  o.instance = n;
  o.is_mirrored = i.is_mirrored;
  o.scale = i.scale;
  o.position_m = i.position_m;
  glm::dmat3 rotation = glm::mat3_cast(glm::normalize(glm::dquat(i.rotation)));
  if (i.is_mirrored) rotation[0] = -rotation[0];
  o.to_body = rotation;
  o.to_model = glm::transpose(rotation) * (1.0 / static_cast<double>(i.scale));
  const Ball& ball = o.model->ball();
  o.ball_m = glm::dvec3(ball.centre_m);
  o.ball_radius_m = static_cast<double>(ball.radius_m) * (1 + 1e-6);
  o.around = scene_.ball(n);
  const SceneBall& around = o.around;
  const double distance = glm::distance(around.centre_m, rule_.camera_m);
  o.near_m = std::max(0.0, distance - around.radius_m);
  o.diameter_px = diameter_px(around.radius_m, distance);
  o.by_rays = o.diameter_px >= rule_.least_ray_px * rule_.stretch;
  const double per_px = rule_.focal_px * rule_.stretch;
  const double geometric_error_m = rule_.tolerance_px * o.near_m / per_px / static_cast<double>(i.scale);
  o.level_index = rule_.tolerance_px > 0 ? o.model->level_within(geometric_error_m) : 0;
  if (const VolumeModel* volume = o.model->volume(); volume != nullptr) {
    const double least_m = kLeastPosts_px * o.near_m / per_px / static_cast<double>(i.scale);
    o.level_index = std::max(o.level_index, o.model->level_within(least_m));
    o.volume = &volume->levels()[o.level_index];
  } else if (o.model->sticks() == nullptr) {
    o.level = &o.model->levels()[o.level_index];
  }
  return o;
}

bool ObjectRays::is_drawn(const SceneBall& ball) const {
  const double distance = glm::distance(ball.centre_m, rule_.camera_m);
  return diameter_px(ball.largest_m, std::max(0.0, distance - ball.radius_m + ball.largest_m)) >=
         kLeastDiameter_px;
}

std::vector<PlacedObject> ObjectRays::in_cone(const ViewCone& cone, double until_m) const {
  std::vector<PlacedObject> out;
  scene_.visit(
      [&](const SceneBall& ball) {
        const double distance = glm::distance(ball.centre_m, rule_.camera_m);
        if (distance - ball.radius_m > until_m) return false;
        return is_drawn(ball) && meets(cone, rule_.camera_m, ball.centre_m, ball.radius_m);
      },
      [&](std::uint32_t n) { out.push_back(placed(n)); });
  std::sort(out.begin(), out.end(), [](const PlacedObject& a, const PlacedObject& b) {
    return a.near_m != b.near_m ? a.near_m < b.near_m : a.instance < b.instance;
  });
  return out;
}

ObjectNumbers all_of(std::span<const PlacedObject> objects) {
  ObjectNumbers out(objects.size());
  std::iota(out.begin(), out.end(), 0U);
  return out;
}

void nearest_object(std::span<const PlacedObject> objects, std::span<const std::uint32_t> named,
                    const ObjectRay& ray, double until_m, double footprint, RayResult& out) {
  out.layers.clear();
  out.has_front = false;
  double end_m = until_m;
  for (const std::uint32_t n : named) {
    const PlacedObject& o = objects[n];
    if (o.near_m > end_m) break;
    if (!o.by_rays || o.volume != nullptr) continue;
    const std::optional<LocalRay> local = enter(o, ray, end_m);
    if (!local) continue;
    if (o.level == nullptr) {
      meet_sticks(o, n, *local, end_m, out);
      if (out.has_front) end_m = std::min(end_m, out.front.range_m);
      continue;
    }
    const Mesh& mesh = o.level->mesh;
    const auto hit_of = [&](const TriangleHit& hit) {
      ObjectHit found;
      found.range_m = local->begin_m + static_cast<double>(hit.t);
      found.object = n;
      found.triangle = hit.triangle;
      found.weights = {hit.u, hit.v};
      return found;
    };
    const auto accept = [&](const TriangleHit& hit) {
      if (hides_back(o, hit)) return false;
      if (mesh.material_table[mesh.materials[hit.triangle]].alpha == AlphaMode::kOpaque) return true;
      const double size_m = hit_of(hit).range_m * footprint / static_cast<double>(o.scale);
      const glm::vec4 c =
          surface_colour(mesh, o.model->textures(), hit.triangle, {hit.u, hit.v}, static_cast<float>(size_m));
      if (c.w >= 255.0F) return true;
      if (c.w > 0.0F) out.layers.push_back(hit_of(hit));
      return false;
    };
    const std::optional<TriangleHit> hit = o.level->tree.nearest(local->ray, length_of(*local), accept);
    if (!hit) continue;
    const ObjectHit found = hit_of(*hit);
    if (found.range_m >= end_m) continue;
    out.front = found;
    out.has_front = true;
    end_m = found.range_m;
  }
  std::erase_if(out.layers, [&](const ObjectHit& h) { return h.range_m >= end_m; });
  std::sort(out.layers.begin(), out.layers.end(), [](const ObjectHit& a, const ObjectHit& b) {
    return a.range_m != b.range_m ? a.range_m < b.range_m
           : a.object != b.object ? a.object < b.object
                                  : a.triangle < b.triangle;
  });
  // A ray through an edge meets both of its triangles.
  out.layers.erase(std::unique(out.layers.begin(), out.layers.end(),
                               [](const ObjectHit& a, const ObjectHit& b) {
                                 return a.object == b.object && a.triangle == b.triangle;
                               }),
                   out.layers.end());
}

double light_through(std::span<const PlacedObject> objects, std::span<const std::uint32_t> named,
                     const ObjectRay& ray) {
  double light = 1;
  for (const std::uint32_t n : named) {
    const PlacedObject& o = objects[n];
    if (o.volume != nullptr) {
      light *= volume_through(o, ray);
      continue;
    }
    const std::optional<LocalRay> local = enter(o, ray, std::numeric_limits<double>::infinity());
    if (!local) continue;
    if (o.level == nullptr) {
      StickHits hits;
      o.model->sticks()->cast(local->ray, o.level_index, length_of(*local), hits);
      if (hits.has_front) return 0;
      for (const StickLayer& layer : hits.layers) light *= 1 - static_cast<double>(layer.opacity);
      continue;
    }
    const Mesh& mesh = o.level->mesh;
    bool is_hidden = false;
    const auto accept = [&](const TriangleHit& hit) {
      if (is_hidden) return true;
      const Material& material = mesh.material_table[mesh.materials[hit.triangle]];
      const float alpha = material.alpha == AlphaMode::kOpaque
                              ? 255.0F
                              : surface_colour(mesh, o.model->textures(), hit.triangle, {hit.u, hit.v}, 0.0F).w;
      light *= 1 - static_cast<double>(alpha) / 255;
      is_hidden = alpha >= 255.0F;
      return is_hidden;
    };
    (void)o.level->tree.nearest(local->ray, length_of(*local), accept);
    if (is_hidden) return 0;
  }
  return light;
}

}  // namespace objects
