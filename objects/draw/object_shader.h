// Colours of objects, by the light of the ground (vpe/core/appearance/shading.h).
#pragma once

#include <glm/vec4.hpp>
#include <optional>
#include <vector>

#include "objects/draw/object_rays.h"
#include "objects/draw/seen_posters.h"
#include "objects/draw/sun_grid.h"
#include "vpe/core/frame.h"
#include "vpe/core/ground_light.h"

namespace objects {

// Describes the light and the air of an image.
struct ImageLight {
  const vpe::core::DrawRequest& request;
  double planet_radius_m = 0;
  const vpe::core::GroundLight* ground = nullptr;  // null: the ground hides no sun
};

// Says what haze does along a ray: a colour becomes transmitted * colour + added.
struct Haze {
  double transmitted = 1;
  glm::dvec3 added{0, 0, 0};
};
Haze haze_at(const ImageLight& light, const glm::dvec3& direction, double range_m);

// Returns whether the sun lights what an image shows.
bool is_lit(const vpe::core::Appearance& appearance);
// Returns whether an image shows lines or dots, in this colour.
bool draws_lines(vpe::core::Mode mode);
inline constexpr glm::dvec3 kLineColour{242, 191, 140};  // as lines and dots of the ground

// Returns the share of the sun's light at a place, 0 where the planet's sphere hides it. Ground hides nothing.
double sun_above(const ImageLight& light, const SunGrid& before_sun, const glm::dvec3& place_m);

// Holds what objects cover of a pixel or a sample.
struct ObjectColour {
  glm::dvec4 over{0, 0, 0, 0};  // 0 to 255, premultiplied; opacity 0 to 1
  // Says where the opacity passes a half; infinity: nowhere.
  double range_m = std::numeric_limits<double>::infinity();
};

// Colours what rays meet among some objects. Any thread may call any member.
class ObjectShader {
 public:
  // All must outlive this.
  ObjectShader(const ObjectRays& rays, const SunGrid& before_sun, const std::vector<PlacedObject>& objects,
               const ImageLight& light, const SeenPosters* posters = nullptr);

  // Returns the colour of what nearest_object() found among these objects.
  ObjectColour colour(const ObjectRay& ray, const RayResult& seen) const;
  // Lays a surface behind what `out` has.
  void lay(const ObjectRay& ray, const ObjectHit& hit, ObjectColour& out) const;
  // Returns the mean colour of an object, 0 to 255, as far as it is too small for rays.
  glm::dvec3 mean_colour(const PlacedObject& object) const;

 private:
  // Describes a place of a surface, without light; normals are unit and body-fixed.
  struct Surface {
    glm::dvec4 colour;  // 0 to 255, with the opacity
    glm::dvec3 plane;
    glm::dvec3 normal;
    bool is_voxel;
  };
  Surface surface_of(const PlacedObject& object, const ObjectHit& hit) const;
  glm::dvec4 colour_of(const ObjectRay& ray, const ObjectHit& hit) const;
  double sun_at(const glm::dvec3& place_m) const;
  std::optional<glm::dvec3> line_colour(const PlacedObject& object, const ObjectHit& hit) const;

  const ObjectRays& rays_;
  const SunGrid& before_sun_;
  const std::vector<PlacedObject>& objects_;
  ImageLight light_;
  const SeenPosters* posters_;  // null: no ray meets any
  double pixel_rad_;
  bool is_lit_;
};

}  // namespace objects
