#include "relief/field/surface.h"

#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

namespace relief {

Surface::Surface(Base base, std::vector<Piece> pieces) : base_(std::move(base)), pieces_(std::move(pieces)) {
  if (pieces_.empty() || pieces_.size() > kMaxPieces)
    throw std::invalid_argument("a surface of " + std::to_string(pieces_.size()) +
                                " pieces: it must have 1 to " + std::to_string(kMaxPieces));
}

const Piece* Surface::piece_at(const glm::dvec3& p_m) const {
  for (const Piece& piece : pieces_)
    if (piece.chart.holds(p_m)) return &piece;
  return nullptr;
}

double Surface::offset_m(const glm::dvec3& p_m) const {
  const Piece* piece = piece_at(p_m);
  if (piece == nullptr) return std::numeric_limits<double>::quiet_NaN();
  const double height_m = base_.height_m(p_m);
  if (piece->shape == nullptr) return height_m;
  const glm::dvec2 at = piece->chart.at(p_m);
  return height_m - piece->shape->height_m(at.x, at.y);
}

glm::dvec3 Surface::normal(const glm::dvec3& p_m) const {
  const Piece* piece = piece_at(p_m);
  if (piece == nullptr) return {0, 0, 0};
  glm::dvec3 slope = base_.gradient(p_m);
  if (piece->shape != nullptr) {
    const glm::dvec2 at = piece->chart.at(p_m);
    const glm::dvec2 rise = piece->shape->gradient(at.x, at.y);
    const std::array<glm::dvec3, 2> axes = piece->chart.gradients(p_m);
    slope -= rise.x * axes[0] + rise.y * axes[1];
  }
  const double length = glm::length(slope);
  return length > 0 ? slope / length : glm::dvec3{0, 0, 0};
}

Surface parallel_surface(const Base& base, const glm::dvec3& origin_m, const glm::dvec3& right,
                         const glm::dvec3& up, std::shared_ptr<const Shape> shape, const Rect& domain) {
  const Chart chart = Chart::parallel(origin_m, right, up, domain);
  if (base.kind() == Base::Kind::kPlane || base.kind() == Base::Kind::kQuadric)
    return {base, {{chart, std::move(shape)}}};
  const glm::dvec3 axis = glm::cross(right, up);
  const double offset = glm::dot(axis, base.centre_m());
  return {base, {{chart.cut({axis, -offset}), std::move(shape)}, {chart.cut({-axis, offset}), nullptr}}};
}

Surface cube_surface(const Base& base, double radius_m,
                     const std::array<std::shared_ptr<const Shape>, mars::kFaces>& shapes) {
  if (base.kind() != Base::Kind::kSphere && base.kind() != Base::Kind::kEllipsoid)
    throw std::invalid_argument("a surface of six faces needs a sphere or an ellipsoid as base");
  std::vector<Piece> pieces;
  for (int face = 0; face < mars::kFaces; ++face)
    pieces.push_back({Chart::cube_face(base.centre_m(), static_cast<mars::Face>(face), radius_m),
                      shapes[static_cast<std::size_t>(face)]});
  return {base, std::move(pieces)};
}

}  // namespace relief
