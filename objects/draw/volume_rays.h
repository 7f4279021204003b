// Rays through the volumes of a scene, and the order of what lies along a ray.
//
// Typical usage:
//   enter_volumes(objects, named, ray, until_m, crossings);
//   in_order(seen, crossings, lay_surface, lay_stretch);
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "objects/draw/object_rays.h"
#include "objects/volumes/volume_march.h"

namespace objects {

// Says where a ray is in the ball of a volume.
struct VolumeCrossing {
  std::uint32_t object = 0;
  double begin_m = 0;  // along the ray
  double end_m = 0;
  // Begins at begin_m, in the model frame. t counts in metres of the ray.
  VolumeRay ray;
};

// Returns where a ray crosses an object's ball and the box of one of its levels before until_m.
std::optional<VolumeCrossing> enter_volume(const PlacedObject& object, const VolumeLevel& level,
                                           const ObjectRay& ray, double until_m);

// Finds the named volumes that enter_volume() finds. `out` is overwritten.
void enter_volumes(std::span<const PlacedObject> objects, std::span<const std::uint32_t> named,
                   const ObjectRay& ray, double until_m, std::vector<VolumeCrossing>& out);

// Returns the share of light that a volume lets through along a ray, at the next coarser level.
double volume_through(const PlacedObject& object, const ObjectRay& ray);

// A stretch of a ray with the volumes that it lies in, by number of their crossing. One alone, or pieces so short that
// volumes in one another may be taken as mixed.
struct VolumeStretch {
  double begin_m = 0;
  double end_m = 0;
  std::span<const std::uint32_t> crossings;
};

// Gives the number of pieces of a stretch that lies in several volumes.
inline constexpr int kMixedPieces = 32;

// Calls lay_surface(ObjectHit) for the surfaces that nearest_object() found and lay_stretch(VolumeStretch) for what lies in
// volumes before the front, from near to far, until one of them returns false.
template <class Surface, class Stretch>
void in_order(const RayResult& seen, std::span<const VolumeCrossing> crossings, const Surface& lay_surface,
              const Stretch& lay_stretch) {
  const double front_m = seen.has_front ? seen.front.range_m : std::numeric_limits<double>::infinity();
  // A list is made only where a ray crosses many volumes.
  constexpr std::size_t kFew = 4;
  std::array<double, 2 * kFew> few_bounds{};
  std::array<std::uint32_t, kFew> few_inside{};
  std::vector<double> many_bounds;
  std::vector<std::uint32_t> many_inside;
  std::span<double> bounds(few_bounds);
  std::span<std::uint32_t> inside(few_inside);
  if (crossings.size() > kFew) {
    many_bounds.resize(2 * crossings.size());
    many_inside.resize(crossings.size());
    bounds = many_bounds;
    inside = many_inside;
  }
  bounds = bounds.first(2 * crossings.size());
  for (std::size_t n = 0; n < crossings.size(); ++n) {
    bounds[2 * n] = std::min(crossings[n].begin_m, front_m);
    bounds[2 * n + 1] = std::min(crossings[n].end_m, front_m);
  }
  std::sort(bounds.begin(), bounds.end());
  const auto lay = [&](double begin_m, double end_m) {
    if (!(begin_m < end_m)) return true;
    const double middle_m = 0.5 * (begin_m + end_m);
    std::size_t count = 0;
    for (std::uint32_t n = 0; n < crossings.size(); ++n) {
      if (crossings[n].begin_m < middle_m && middle_m < crossings[n].end_m) inside[count++] = n;
    }
    if (count == 0) return true;
    const int pieces = count > 1 ? kMixedPieces : 1;
    const auto cut = [&](int n) { return begin_m + (end_m - begin_m) * n / pieces; };
    for (int n = 0; n < pieces; ++n) {
      if (!lay_stretch(VolumeStretch{cut(n), n + 1 == pieces ? end_m : cut(n + 1), inside.first(count)}))
        return false;
    }
    return true;
  };
  std::size_t layer = 0;
  double at_m = 0;
  for (const double bound_m : bounds) {
    for (; layer < seen.layers.size() && seen.layers[layer].range_m <= bound_m; ++layer) {
      if (!lay(at_m, seen.layers[layer].range_m) || !lay_surface(seen.layers[layer])) return;
      at_m = std::max(at_m, seen.layers[layer].range_m);
    }
    if (!lay(at_m, bound_m)) return;
    at_m = std::max(at_m, bound_m);
  }
  for (; layer < seen.layers.size(); ++layer) {
    if (!lay_surface(seen.layers[layer])) return;
  }
  if (seen.has_front) lay_surface(seen.front);
}

}  // namespace objects
