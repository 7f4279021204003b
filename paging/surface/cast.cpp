// Ray casting against the reference surface. In the chart of a face a straight ray stays straight and a flat
// triangle is a plane 1 = A X + B Y + C Z through its three posts (X, Y, Z = components along the face's
// axes), so each cell needs three linear functions of the ray parameter and no trigonometry
// (docs/design/rays.md).
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "paging/surface/chart_line.h"
#include "paging/surface/surface.h"
#include "vpe/base/mutation.h"

namespace paging {

using vpe::base::Guard;
using vpe::base::mutated;

namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();
constexpr double kAbsent = -kNone;

class FaceCaster {
 public:
  FaceCaster(const Surface& surface, const Surface::TileProvider& tiles, mars::Face face,
             const glm::dvec3& camera, const glm::dvec3& direction, double exaggeration)
      : surface_(surface),
        tiles_(tiles),
        tree_(surface.planet().tree()),
        radius_(surface.planet_radius_m()),
        exaggeration_(exaggeration),
        face_(face),
        line_(face, camera, direction),
        camera2_(glm::dot(camera, camera)),
        half_(glm::dot(camera, direction)) {}

  // Returns the part of the ray inside the face's pyramid.
  Interval reach() const { return line_.in_face({0.0, kNone}); }

  // Returns the hit, kNone, or kAbsent where a tile is not provided.
  double cast(Interval part) const { return in_tile(static_cast<lod::TileTree::Index>(face_), part); }

 private:
  // Returns the least squared distance from the planet's centre over part of the ray.
  double least_radius2(Interval part) const {
    const double t = std::clamp(-half_, part.begin, part.end);
    return camera2_ + t * (2.0 * half_ + t);
  }

  bool above(Interval part, double height) const {
    const double top = radius_ + exaggeration_ * height;
    return least_radius2(part) > top * top;
  }

  // visit(east, north, interval) returns the hit or kNone.
  template <typename Visit>
  double quarters(Interval part, Linear fu, Linear fv, Visit&& visit) const {
    double hit = kNone;
    visit_quarters(part, fu, fv, radius_, [&](bool east, bool north, Interval piece) {
      hit = visit(east, north, piece);
      return hit < kNone;
    });
    return hit;
  }

  double in_tile(lod::TileTree::Index index, Interval part) const {
    const lod::TileInfo& info = tree_[index];
    if (above(part, info.max_height_m)) return kNone;
    const lod::TileKey& key = info.key;
    if (!info.has_children) {
      const auto tile = tiles_(key);
      if (tile == nullptr) return kAbsent;
      return in_block(*tile, static_cast<int>(tile->block_max.size()), 0, 0, part);
    }
    const lod::TileTree::Index first = tree_.first_child(index);
    return quarters(part, line_.line_u(surface_.middle_line(key.level, key.i)),
                    line_.line_v(surface_.middle_line(key.level, key.j)),
                    [&](bool east, bool north, Interval piece) {
                      return in_tile(first + (east ? 1U : 0U) + (north ? 2U : 0U), piece);
                    });
  }

  double in_block(const SurfaceTile& tile, int b, int i, int j, Interval part) const {
    if (b == 0) return in_cell(tile, i, j, part);
    const int side = tile.data.posts.intervals >> b;
    if (above(part, tile.block_max[static_cast<std::size_t>(b - 1)][static_cast<std::size_t>(j * side + i)])) {
      return kNone;
    }
    const auto half = std::size_t{1} << (b - 1);
    const double u = tile.lines.u[(static_cast<std::size_t>(i) << b) + half];
    const double v = tile.lines.v[(static_cast<std::size_t>(j) << b) + half];
    return quarters(part, line_.line_u(u), line_.line_v(v), [&](bool east, bool north, Interval piece) {
      return in_block(tile, b - 1, 2 * i + (east ? 1 : 0), 2 * j + (north ? 1 : 0), piece);
    });
  }

  double in_cell(const SurfaceTile& tile, int i, int j, Interval part) const {
    const CellFacets facets(line_, tile.lines, tile.data.posts, i, j, exaggeration_, radius_);
    const Linear& diagonal = facets.diagonal;
    const double root = diagonal.slope == 0.0 ? kNone : -diagonal.value / diagonal.slope;
    const bool cut = root > part.begin && root < part.end;
    const std::array<Interval, 2> pieces{Interval{part.begin, cut ? root : part.end}, Interval{root, part.end}};
    for (std::size_t p = 0; p < (cut ? 2U : 1U); ++p) {
      const Interval& piece = pieces[p];
      const double middle = 0.5 * (piece.begin + piece.end);
      const Linear& f = diagonal.at(middle) >= 0.0 ? facets.lower : facets.upper;
      if (f.at(piece.begin) >= 0.0) return piece.begin;
      if (f.at(piece.end) >= 0.0) return std::clamp(-f.value / f.slope, piece.begin, piece.end);
    }
    return kNone;
  }

  const Surface& surface_;
  const Surface::TileProvider& tiles_;
  const lod::TileTree& tree_;
  double radius_;
  double exaggeration_;
  mars::Face face_;
  ChartLine line_;
  double camera2_;
  double half_;
};

}  // namespace

double Surface::cast(const glm::dvec3& camera_m, const glm::dvec3& direction, double exaggeration,
                     const RaySegment& segment) const {
  const TileProvider all = [&](const lod::TileKey& key) { return tile(key, exaggeration); };
  return *cast_over(all, camera_m, direction, exaggeration, segment);
}

std::optional<double> Surface::cast_over(const TileProvider& tiles, const glm::dvec3& camera_m,
                                         const glm::dvec3& direction, double exaggeration,
                                         const RaySegment& segment) const {
  // Only the part inside the sphere of the highest terrain can hit.
  const double radius = planet_->radius_m();
  const double top = radius + exaggeration * (planet_->meta().highest_radius_m - radius);
  const double half = glm::dot(camera_m, direction);
  const double rest = half * half - (glm::dot(camera_m, camera_m) - top * top);
  if (!(rest >= 0.0)) return kNone;
  const Interval region{std::max(segment.begin_m, -half - std::sqrt(rest)),
                        std::min(segment.end_m, -half + std::sqrt(rest))};
  if (region.empty()) return kNone;

  struct Candidate {
    double begin;
    double end;
    int face;
  };
  std::vector<Candidate> candidates;
  for (int f = 0; f < mars::kFaces; ++f) {
    Interval part =
        FaceCaster(*this, tiles, static_cast<mars::Face>(f), camera_m, direction, exaggeration).reach();
    part = {std::max(part.begin, region.begin), std::min(part.end, region.end)};
    if (!part.empty()) candidates.push_back({part.begin, part.end, f});
  }
  if (!mutated(Guard::kFaceOrder)) {
    std::sort(candidates.begin(), candidates.end(),
              [](const Candidate& a, const Candidate& b) { return a.begin < b.begin; });
  }
  for (const Candidate& candidate : candidates) {
    const FaceCaster caster(*this, tiles, static_cast<mars::Face>(candidate.face), camera_m, direction,
                            exaggeration);
    const double hit = caster.cast({candidate.begin, candidate.end});
    if (hit == kAbsent) return std::nullopt;
    if (hit < kNone) return hit;
  }
  return kNone;
}

}  // namespace paging
