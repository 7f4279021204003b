// Colours of volumes and of what lies before, in and behind them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "objects/draw/object_shader.h"
#include "objects/draw/volume_light.h"
#include "objects/draw/volume_rays.h"

namespace objects {

// Lays surfaces and volumes over each other. A volume in full sun has the colour of a surface that faces it; in the shadow
// of itself and of other things it has less. Belongs to one thread at a time.
class VolumeShader {
 public:
  // All must outlive this.
  VolumeShader(const ObjectShader& surfaces, const VolumeLights& lights,
               const std::vector<PlacedObject>& objects, const ImageLight& light);

  // Returns the colour of what nearest_object() found among these objects and of the named volumes, up to until_m. Exact
  // but for the light, which is constant in half a spacing of its posts, and for haze, which is constant in a stretch
  // between two surfaces.
  ObjectColour colour(const ObjectRay& ray, const RayResult& seen, std::span<const std::uint32_t> volumes,
                      double until_m);

  // Returns whether an object was met as a volume since this was made.
  bool has_shown(std::uint32_t object) const { return has_shown_[object] != 0; }

 private:
  // Holds what a volume adds along a stretch of a ray.
  struct Veil {
    double depth = 0;
    double lit = 0;      // mean factor of light
    double range_m = 0;  // mean, by what is seen
  };
  Veil veil_of(const VolumeCrossing& crossing, double begin_m, double end_m, ObjectColour* out);
  bool lay(const ObjectRay& ray, const VolumeStretch& stretch, ObjectColour& out);
  glm::dvec3 colour_of(const PlacedObject& object, const ObjectRay& ray, const Veil& veil) const;

  const ObjectShader& surfaces_;
  const VolumeLights& lights_;
  const std::vector<PlacedObject>& objects_;
  ImageLight light_;
  bool is_lit_;
  std::vector<VolumeCrossing> crossings_;
  std::vector<std::uint8_t> has_shown_;  // by object
};

}  // namespace objects
