#include "objects/draw/object_shader.h"

#include <algorithm>
#include <cmath>
#include <glm/ext/scalar_constants.hpp>
#include <glm/geometric.hpp>

#include "objects/model/surface_sample.h"
#include "vpe/core/appearance/shading.h"
#include "vpe/core/appearance/sky.h"

namespace objects {

using vpe::core::Mode;

namespace {

// Rays to the sun leave a voxel by this many of its edges.
constexpr double kVoxelLift = 1.5;
constexpr double kHalfLine_px = 1;  // half of it may lie beside the object

// Returns the part of a ball that faces the sun, as its camera sees it, by Lambert's law.
double mean_incidence(const glm::dvec3& to_camera, const glm::dvec3& sun) {
  const double phase = std::acos(std::clamp(glm::dot(to_camera, sun), -1.0, 1.0));
  return 2 / (3 * glm::pi<double>()) * (std::sin(phase) + (glm::pi<double>() - phase) * std::cos(phase));
}

// Returns whether the planet's sphere hides the sun, for places of any height.
bool is_night(const glm::dvec3& place_m, const glm::dvec3& sun, double planet_radius_m) {
  const double r = glm::length(place_m);
  const double dip_cosine = std::min(1.0, planet_radius_m / r);
  return glm::dot(place_m, sun) <= -r * std::sqrt(1 - dip_cosine * dip_cosine);
}

}  // namespace

bool draws_lines(Mode mode) { return mode == Mode::kWireframe || mode == Mode::kMarkers; }

double sun_above(const ImageLight& light, const SunGrid& before_sun, const glm::dvec3& place_m) {
  return is_night(place_m, light.request.sun, light.planet_radius_m) ? 0 : before_sun.light_at(place_m);
}

bool is_lit(const vpe::core::Appearance& appearance) {
  return !draws_lines(appearance.mode) && appearance.mode != Mode::kUnlit;
}

Haze haze_at(const ImageLight& light, const glm::dvec3& direction, double range_m) {
  const vpe::core::SettingsValues& settings = light.request.settings;
  Haze haze;
  if (!(settings.haze_visibility_m > 0) || draws_lines(settings.mode)) return haze;
  const glm::dvec3& camera = light.request.view.camera.position_m;
  const double r = glm::length(camera);
  const double air = vpe::core::air_m(light.planet_radius_m, r - light.planet_radius_m,
                                      glm::dot(direction, camera) / r, range_m);
  haze.transmitted = vpe::core::transmittance(air, settings.haze_visibility_m);
  const glm::dvec3 up = glm::normalize(camera + range_m * direction);
  haze.added = (1 - haze.transmitted) * vpe::core::haze_colour(vpe::core::air_of(settings.atmosphere).haze,
                                                               glm::dot(up, light.request.sun));
  return haze;
}

ObjectShader::ObjectShader(const ObjectRays& rays, const SunGrid& before_sun,
                           const std::vector<PlacedObject>& objects, const ImageLight& light,
                           const SeenPosters* posters)
    : rays_(rays),
      before_sun_(before_sun),
      objects_(objects),
      light_(light),
      posters_(posters),
      pixel_rad_(1 / rays.rule().focal_px),
      is_lit_(is_lit(light.request.settings)) {}

double ObjectShader::sun_at(const glm::dvec3& place_m) const {
  const double through = sun_above(light_, before_sun_, place_m);
  if (through <= 0 || light_.ground == nullptr) return through;
  return light_.ground->sees_sun(place_m) ? through : 0;
}

// Lines run along the edges of triangles, dots lie on their corners.
std::optional<glm::dvec3> ObjectShader::line_colour(const PlacedObject& object, const ObjectHit& hit) const {
  const Mesh& mesh = object.level->mesh;
  const glm::uvec3& t = mesh.triangles[hit.triangle];
  const glm::dvec3 a(mesh.positions_m[t.x]), b(mesh.positions_m[t.y]), c(mesh.positions_m[t.z]);
  const glm::dvec3 at = a * static_cast<double>(1 - hit.weights.x - hit.weights.y) +
                        b * static_cast<double>(hit.weights.x) + c * static_cast<double>(hit.weights.y);
  const double pixel_m = hit.range_m * pixel_rad_ / static_cast<double>(object.scale);
  if (light_.request.settings.mode == Mode::kMarkers) {
    const double nearest = std::min({glm::distance(at, a), glm::distance(at, b), glm::distance(at, c)});
    if (nearest <= 0.5 * light_.request.settings.marker_px * pixel_m) return kLineColour;
    return std::nullopt;
  }
  const double area2 = glm::length(glm::cross(b - a, c - a));
  const auto height = [&](double weight, const glm::dvec3& from, const glm::dvec3& to) {
    const double side = glm::distance(from, to);
    return side > 0 ? weight * area2 / side : 0;
  };
  const double nearest = std::min(
      {height(1 - static_cast<double>(hit.weights.x) - static_cast<double>(hit.weights.y), b, c),
       height(static_cast<double>(hit.weights.x), c, a), height(static_cast<double>(hit.weights.y), a, b)});
  if (nearest <= kHalfLine_px * pixel_m) return kLineColour;
  return std::nullopt;
}

ObjectShader::Surface ObjectShader::surface_of(const PlacedObject& o, const ObjectHit& hit) const {
  if (o.level == nullptr) {
    const Rgba& c = hit.voxel.colour;
    const glm::dvec3 normal(hit.voxel.normal[0], hit.voxel.normal[1], hit.voxel.normal[2]);
    const double length = glm::length(normal);
    return {{c.r, c.g, c.b, hit.opacity},
            o.to_body * glm::dvec3(hit.face),
            o.to_body * (length > 0 ? normal / length : glm::dvec3(hit.face)),
            true};
  }
  const Mesh& mesh = o.level->mesh;
  const double size_m = hit.range_m * pixel_rad_ / static_cast<double>(o.scale);
  return {glm::dvec4(
              surface_colour(mesh, o.model->textures(), hit.triangle, hit.weights, static_cast<float>(size_m))),
          o.to_body * glm::dvec3(plane_normal(mesh, hit.triangle)),
          o.to_body * glm::dvec3(surface_normal(mesh, hit.triangle, hit.weights)), false};
}

glm::dvec4 ObjectShader::colour_of(const ObjectRay& ray, const ObjectHit& hit) const {
  if (is_poster(hit.object)) return posters_->colour(hit.object & ~kPosterBit, hit.weights, hit.opacity);
  const PlacedObject& o = objects_[hit.object];
  const vpe::core::SettingsValues& settings = light_.request.settings;
  if (draws_lines(settings.mode)) {
    const double paper = settings.background == vpe::core::Background::kWhite ? 255 : 0;
    // Sticks have no edges: each voxel is a dot.
    return {o.level == nullptr ? kLineColour : line_colour(o, hit).value_or(glm::dvec3(paper)), 255};
  }
  const Surface surface = surface_of(o, hit);
  glm::dvec3 colour = settings.mode == Mode::kLit ? settings.plain_ground : glm::dvec3(surface.colour);
  if (is_lit_) {
    const double side = glm::dot(surface.plane, ray.direction) > 0 ? -1 : 1;
    const glm::dvec3 plane = side * surface.plane;
    const glm::dvec3 normal = side * surface.normal;
    const glm::dvec3& sun = light_.request.sun;
    double incidence = std::max(0.0, glm::dot(normal, sun));
    // What faces away from the sun needs no ray. The plane of a triangle decides, as rays meet it and not the curved
    // normal; the sides of voxels are steps of a surface that has the normal.
    if (!surface.is_voxel && glm::dot(plane, sun) <= 0) incidence = 0;
    if (incidence > 0) {
      // Away from the surface by what floats make of its place, and from the steps of its voxels.
      double lift_m = 2e-5 * o.ball_radius_m * static_cast<double>(o.scale) + 1e-7 * hit.range_m;
      if (surface.is_voxel)
        lift_m +=
            kVoxelLift * static_cast<double>(o.model->sticks()->levels()[o.level_index].grid.voxel_m * o.scale);
      const glm::dvec3 away = surface.is_voxel ? normal : plane;
      incidence *= sun_at(ray.origin_m + hit.range_m * ray.direction + lift_m * away);
    }
    colour *= vpe::core::light(settings.sun_ambient, settings.sun_diffuse, incidence);
  }
  const Haze haze = haze_at(light_, ray.direction, hit.range_m);
  return {glm::min(colour, 255.0) * haze.transmitted + haze.added, surface.colour.w};
}

void ObjectShader::lay(const ObjectRay& ray, const ObjectHit& hit, ObjectColour& out) const {
  const glm::dvec4 c = colour_of(ray, hit);
  const double share = (1 - out.over.w) * c.w / 255;
  out.over += glm::dvec4(glm::dvec3(c) * share, share);
  if (out.over.w >= 0.5) out.range_m = std::min(out.range_m, hit.range_m);
}

ObjectColour ObjectShader::colour(const ObjectRay& ray, const RayResult& seen) const {
  ObjectColour out;
  for (const ObjectHit& layer : seen.layers) lay(ray, layer, out);
  if (seen.has_front) lay(ray, seen.front, out);
  return out;
}

glm::dvec3 ObjectShader::mean_colour(const PlacedObject& object) const {
  const vpe::core::SettingsValues& settings = light_.request.settings;
  if (draws_lines(settings.mode)) return kLineColour;
  glm::dvec3 colour = settings.mode == Mode::kLit ? settings.plain_ground : object.model->mean_colour();
  const SceneBall& ball = object.around;
  const glm::dvec3 to_camera = rays_.rule().camera_m - ball.centre_m;
  const double range_m = glm::length(to_camera);
  if (is_lit_) {
    double incidence = mean_incidence(to_camera / range_m, light_.request.sun);
    const glm::dvec3 up = glm::normalize(ball.centre_m);
    if (is_night(ball.centre_m, light_.request.sun, light_.planet_radius_m)) incidence = 0;
    if (incidence > 0 && light_.ground != nullptr &&
        !light_.ground->sees_sun(ball.centre_m + ball.radius_m * up))
      incidence = 0;
    colour *= vpe::core::light(settings.sun_ambient, settings.sun_diffuse, incidence);
  }
  const Haze haze = haze_at(light_, -to_camera / range_m, range_m);
  return glm::min(colour, 255.0) * haze.transmitted + haze.added;
}

}  // namespace objects
