// Surfaces: a base with shapes of relief on it.
//
// A point belongs to the first piece whose chart holds it. Its height over the ground is the height above the base less
// that of the piece's shape: F'(p) = F(p) + R(p) of Vyatkin and Dolgovesov 2002 (section 2), with the sign that makes
// relief rise.
//
// Typical usage:
//   const auto map = std::make_shared<HeightMap>(layout, heights_m, Interpolation::kBicubic);
//   const Surface surface = parallel_surface(Base::plane({0, 0, 0}, {0, 0, 1}), {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, map);
//   const CastResult ranges = cast(surface, view, {}, pool);  // relief/cast/caster.h
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "relief/field/base.h"
#include "relief/field/chart.h"
#include "relief/shape.h"

namespace relief {

inline constexpr std::size_t kMaxPieces = 8;

// Holds a chart and the shape in its plane; without a shape the piece is the base itself.
struct Piece {
  Chart chart;
  std::shared_ptr<const Shape> shape;
};

// Holds a base and its pieces. Immutable; every function may be called from any number of threads at once.
class Surface {
 public:
  // Throws std::invalid_argument for no piece or more than kMaxPieces.
  Surface(Base base, std::vector<Piece> pieces);

  const Base& base() const { return base_; }
  const std::vector<Piece>& pieces() const { return pieces_; }

  // Returns the height over the ground, negative below it, and NaN where no chart holds the point. Metres of the base.
  double offset_m(const glm::dvec3& p_m) const;

  // Returns the unit normal of the ground at a point of it, away from the inside, from the smooth gradients. Returns 0
  // where no chart holds the point.
  glm::dvec3 normal(const glm::dvec3& p_m) const;

 private:
  const Piece* piece_at(const glm::dvec3& p_m) const;

  Base base_;
  std::vector<Piece> pieces_;
};

// Make a surface whose shape lies in a plane through `origin_m` and is projected along right x up; null: the base
// alone. Only the part over `domain` is there. On a sphere or an ellipsoid the shape acts on the half in front of the
// centre (with (p - centre) . axis >= 0), and the other half is bare: where the shape is not 0 at the edge of
// the half, the ground is open by that height.
Surface parallel_surface(const Base& base, const glm::dvec3& origin_m, const glm::dvec3& right,
                         const glm::dvec3& up, std::shared_ptr<const Shape> shape,
                         const Rect& domain = kEverywhere);

// Makes a surface around a sphere or an ellipsoid, with one shape for each face of a cube (or null), in the order of
// mars::Face. Their coordinates are metres from -radius_m to radius_m (Chart::cube_face). Where shapes
// differ on a shared edge the ground is open by the height of the step. Throws std::invalid_argument for other bases.
Surface cube_surface(const Base& base, double radius_m,
                     const std::array<std::shared_ptr<const Shape>, mars::kFaces>& shapes);

}  // namespace relief
