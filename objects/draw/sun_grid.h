// Objects as the sun sees them: in cells of the plane across its rays, so that a place finds what may hide the sun there
// without looking at all objects.
//
// Typical usage:
//   const SunGrid grid(rays, sun);
//   colour *= grid.light_at(place_m);
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "objects/draw/object_rays.h"

namespace objects {

// Immutable. Any thread may call any member.
class SunGrid {
 public:
  // Makes a grid without objects: the sun is everywhere.
  SunGrid() = default;
  // `rays` must outlive this. Objects that are too small to be drawn cast no shadows.
  SunGrid(const ObjectRays& rays, const glm::dvec3& sun);

  bool is_empty() const { return discs_.empty(); }
  // Returns whether an object may hide the sun from a place of a ball. Never false if one does.
  bool may_shade(const glm::dvec3& centre_m, double radius_m) const;
  // Returns the share of the sun's light that passes the objects on its way to a place.
  double light_at(const glm::dvec3& place_m) const;

 private:
  // Describes the ball of an object: its place across the rays, along them, and its radius.
  struct Disc {
    double u_m;
    double v_m;
    double along_m;
    double radius_m;
    std::uint32_t instance;
    std::int32_t volume = -1;  // of volumes_
  };
  struct Range {
    std::uint32_t begin;
    std::uint32_t end;
  };
  using Key = std::uint64_t;

  Disc disc_of(const glm::dvec3& centre_m, double radius_m, std::uint32_t instance) const;
  std::int64_t cell(double place_m) const;
  static Key key(std::int64_t i, std::int64_t j);
  bool hides(const Disc& disc, const Disc& place) const;
  void dim(const Disc& disc, const Disc& place, const glm::dvec3& place_m, double& light) const;

  const ObjectRays* rays_ = nullptr;
  glm::dvec3 sun_{1, 0, 0};
  glm::dvec3 across_[2]{};
  glm::dvec3 origin_m_{0, 0, 0};
  double cell_m_ = 1;
  std::vector<Disc> discs_;
  std::vector<PlacedObject> volumes_;   // rays of many places meet them
  std::vector<std::uint32_t> large_;    // discs that cover many cells
  std::vector<std::uint32_t> entries_;  // discs, cell by cell
  std::unordered_map<Key, Range> cells_;
};

}  // namespace objects
