// Whether two scenes are equal in all their members, numbers to the bit.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <variant>
#include <vector>

#include "objects/files/scene_file.h"

namespace objects::test {

// Return whether two parts of a scene are equal. Zeros of different signs are not.
inline bool same(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}
inline bool same(const mars::LonLat& a, const mars::LonLat& b) {
  return same(a.lon_deg, b.lon_deg) && same(a.lat_deg, b.lat_deg);
}
inline bool same(const ModelEntry& a, const ModelEntry& b) {
  return a.name == b.name && a.file == b.file && same(a.unit_m, b.unit_m) && a.up == b.up &&
         a.formula == b.formula;
}
inline bool same(const Placing& a, const Placing& b) {
  return same(a.place, b.place) && a.height_kind == b.height_kind && same(a.height_m, b.height_m) &&
         same(a.heading_deg, b.heading_deg) && same(a.pitch_deg, b.pitch_deg) && same(a.roll_deg, b.roll_deg) &&
         a.follows_slope == b.follows_slope && same(a.scale, b.scale);
}
inline bool same(const ObjectEntry& a, const ObjectEntry& b);
inline bool same(const PathPoint& a, const PathPoint& b);
inline bool same(const PathEntry& a, const PathEntry& b);
inline bool same(const ScatterEntry& a, const ScatterEntry& b);
inline bool same(const PosterEntry& a, const PosterEntry& b);
inline bool same(const KioskEntry& a, const KioskEntry& b);
template <class T>
bool same(const std::vector<T>& a, const std::vector<T>& b) {
  return std::ranges::equal(a, b, [](const T& x, const T& y) { return same(x, y); });
}
inline bool same(const ObjectEntry& a, const ObjectEntry& b) {
  return a.name == b.name && a.model == b.model && same(a.interest_levels, b.interest_levels) &&
         same(a.places, b.places) && a.ground.kind == b.ground.kind &&
         same(a.ground.voxel_m, b.ground.voxel_m) &&
         same(a.ground.solid_above_per_m, b.ground.solid_above_per_m);
}
inline bool same(const PathPoint& a, const PathPoint& b) {
  return same(a.time_s, b.time_s) && same(a.place, b.place) && a.heading_deg == b.heading_deg &&
         a.height_m == b.height_m;
}
inline bool same(const PathEntry& a, const PathEntry& b) {
  return a.name == b.name && a.model == b.model && same(a.points, b.points) && same(a.scale, b.scale) &&
         same(a.wheelbase_m, b.wheelbase_m) && same(a.track_m, b.track_m);
}
inline bool same(const ScatterEntry& a, const ScatterEntry& b) {
  if (a.distribution.index() != b.distribution.index()) return false;
  if (const auto* power = std::get_if<PowerLaw>(&a.distribution)) {
    const PowerLaw& other = std::get<PowerLaw>(b.distribution);
    if (!same(power->density_per_m2, other.density_per_m2) || !same(power->exponent, other.exponent))
      return false;
  } else if (!same(std::get<RockAbundance>(a.distribution).k, std::get<RockAbundance>(b.distribution).k)) {
    return false;
  }
  return a.name == b.name && a.models == b.models && same(a.polygon, b.polygon) && a.seed == b.seed &&
         same(a.least_diameter_m, b.least_diameter_m) && same(a.most_diameter_m, b.most_diameter_m) &&
         same(a.buried, b.buried) && a.follows_slope == b.follows_slope && a.tumbles == b.tumbles &&
         a.most == b.most;
}
// Bindings of all members: one that is added does not compile until it is compared.
inline bool same(const PosterEntry& a, const PosterEntry& b) {
  const auto& [name, file, form, place, height_kind, height_m, opacity, width_m, tall_m, heading_deg, pitch_deg,
               roll_deg, fov_deg, distance_m, radius_m, fade_m, is_cylinder, replaces_ground] = a;
  return name == b.name && file == b.file && form == b.form && place.has_value() == b.place.has_value() &&
         (!place || same(*place, *b.place)) && height_kind == b.height_kind && same(height_m, b.height_m) &&
         same(opacity, b.opacity) && same(width_m, b.width_m) && same(tall_m, b.tall_m) &&
         same(heading_deg, b.heading_deg) && same(pitch_deg, b.pitch_deg) && same(roll_deg, b.roll_deg) &&
         same(fov_deg, b.fov_deg) && same(distance_m, b.distance_m) && same(radius_m, b.radius_m) &&
         same(fade_m, b.fade_m) && is_cylinder == b.is_cylinder && replaces_ground == b.replaces_ground;
}
inline bool same(const KioskEntry& a, const KioskEntry& b) {
  const auto& [name, place, heading_deg, size_m, panorama, hotspots, beside_m] = a;
  return name == b.name && same(place, b.place) && same(heading_deg, b.heading_deg) && same(size_m, b.size_m) &&
         panorama == b.panorama && hotspots == b.hotspots && same(beside_m, b.beside_m);
}
// The path of the scene itself is that of the file that was read.
inline bool same(const SceneFile& a, const SceneFile& b) {
  const auto& [path, models, objects, scatters, paths, posters, kiosks] = a;
  return same(models, b.models) && same(objects, b.objects) && same(scatters, b.scatters) &&
         same(paths, b.paths) && same(posters, b.posters) && same(kiosks, b.kiosks);
}

}  // namespace objects::test
