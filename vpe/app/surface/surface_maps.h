// Height maps of surface files, from rasters and planet files.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "mars/geodesy/cube.h"
#include "relief/field/height_map.h"
#include "relief/files/surface_file.h"

namespace vpe::app {

// Bounds the posts of a side of a face unless the file names a number.
inline constexpr int kUsualLeastFacePosts = 33;
inline constexpr int kUsualMostFacePosts = 1025;

// Posts of a face of the cube, even on its plane, with a ring of posts beyond it. Posts on an edge of the cube, and in line with
// it, are those of both faces, to the bit.
class FaceGrid {
 public:
  // `posts` are those of a side of the face itself, at least 2.
  FaceGrid(double radius_m, int posts) : radius_m_(radius_m), last_(posts - 1) {}

  int side() const { return last_ + 3; }
  double spacing_m() const { return 2 * radius_m_ / last_; }
  // Even numerators make coordinates that are equal but for their sign on both sides of an edge.
  double coordinate(int n) const { return static_cast<double>(2 * (n - 1) - last_) / last_; }
  relief::MapLayout layout() const {
    const double first_m = -radius_m_ - spacing_m();
    return {side(), side(), first_m, first_m, spacing_m(), spacing_m()};
  }
  // Returns the unit directions of a row of posts.
  std::vector<glm::dvec3> row(mars::Face face, int j) const;

 private:
  double radius_m_;
  int last_;
};

using FaceMaps = std::array<std::shared_ptr<const relief::HeightMap>, mars::kFaces>;

// Returns the maps of an entry on the six faces of a round surface: heights above its base, in the coordinates of
// Chart::cube_face(). Each map has a ring of posts beyond its face, so that neighbours agree on the edge that they share.
// With is_mask, of the entry's mask, whose values are no heights.
// Throws mars::SourceError and paging::PlanetError for a file that cannot be read, and std::runtime_error for posts without
// data where the entry has no fill_m.
FaceMaps face_maps(const relief::MapEntry& entry, const relief::SurfaceFile& surface, bool is_mask = false);

// Returns the map of an entry over the area of a plane or a quadric. The first row of the raster lies at the largest y, and the
// outer posts lie on the area's border. Throws as face_maps() does.
std::shared_ptr<const relief::HeightMap> plane_map(const relief::MapEntry& entry,
                                                   const relief::SurfaceFile& surface, bool is_mask = false);

// Returns the radius of a round base at a unit direction from its centre, in metres.
double base_radius_m(const relief::Base& base, const glm::dvec3& direction);

}  // namespace vpe::app
