#include "paging/surface/section.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <vector>

#include "mars/geodesy/sphere.h"
#include "paging/surface/chart_line.h"

namespace paging {

namespace {

// A chord is walked, not the circle; over an arc this long it stays near the sphere, so that rounding does.
constexpr double kLongestChord_rad = mars::kPi / 4;

class FaceWalk {
 public:
  FaceWalk(const Surface& surface, mars::Face face, const glm::dvec3& start, const glm::dvec3& chord,
           const std::function<void(const SectionPiece&)>& visit)
      : surface_(surface),
        tree_(surface.planet().tree()),
        face_(face),
        line_(face, start, chord),
        start_(start),
        chord_(chord),
        visit_(visit) {}

  Interval reach() const { return line_.in_face({0.0, 1.0}); }
  void walk(Interval part) const { in_tile(static_cast<lod::TileTree::Index>(face_), part); }

 private:
  void in_tile(lod::TileTree::Index index, Interval part) const {
    const lod::TileInfo& info = tree_[index];
    const lod::TileKey& key = info.key;
    if (!info.has_children) {
      const auto tile = surface_.tile(key);
      return in_block(*tile, static_cast<int>(tile->block_max.size()), 0, 0, part);
    }
    const lod::TileTree::Index first = tree_.first_child(index);
    visit_quarters(part, line_.line_u(surface_.middle_line(key.level, key.i)),
                   line_.line_v(surface_.middle_line(key.level, key.j)), 1.0,
                   [&](bool east, bool north, Interval piece) {
                     in_tile(first + (east ? 1U : 0U) + (north ? 2U : 0U), piece);
                     return false;
                   });
  }

  void in_block(const SurfaceTile& tile, int b, int i, int j, Interval part) const {
    if (b == 0) return in_cell(tile, i, j, part);
    const auto half = std::size_t{1} << (b - 1);
    const double u = tile.lines.u[(static_cast<std::size_t>(i) << b) + half];
    const double v = tile.lines.v[(static_cast<std::size_t>(j) << b) + half];
    visit_quarters(part, line_.line_u(u), line_.line_v(v), 1.0, [&](bool east, bool north, Interval piece) {
      in_block(tile, b - 1, 2 * i + (east ? 1 : 0), 2 * j + (north ? 1 : 0), piece);
      return false;
    });
  }

  void in_cell(const SurfaceTile& tile, int i, int j, Interval part) const {
    const CellFacets facets(line_, tile.lines, tile.data.posts, i, j, 1.0, surface_.planet_radius_m());
    const Linear& diagonal = facets.diagonal;
    const double root = diagonal.slope == 0.0 ? part.end : -diagonal.value / diagonal.slope;
    const bool cut = root > part.begin && root < part.end;
    for (const Interval& piece :
         {Interval{part.begin, cut ? root : part.end}, Interval{cut ? root : part.end, part.end}}) {
      if (piece.empty()) continue;
      const Linear& f = diagonal.at(0.5 * (piece.begin + piece.end)) >= 0.0 ? facets.lower : facets.upper;
      visit_({on(f, piece.begin), on(f, piece.end)});
    }
  }

  // Returns the point of a facet on the vertical through the line: 1 - Z w vanishes there, and Z w grows with
  // the distance from the centre.
  glm::dvec3 on(const Linear& facet, double t) const { return (start_ + t * chord_) / (1.0 - facet.at(t)); }

  const Surface& surface_;
  const lod::TileTree& tree_;
  mars::Face face_;
  ChartLine line_;
  glm::dvec3 start_;
  glm::dvec3 chord_;
  const std::function<void(const SectionPiece&)>& visit_;
};

void walk_chord(const Surface& surface, const glm::dvec3& a, const glm::dvec3& b,
                const std::function<void(const SectionPiece&)>& visit) {
  struct FacePart {
    Interval part;
    mars::Face face;
  };
  std::vector<FacePart> parts;
  for (int f = 0; f < mars::kFaces; ++f) {
    const auto face = static_cast<mars::Face>(f);
    const Interval part = FaceWalk(surface, face, a, b - a, visit).reach();
    if (!part.empty()) parts.push_back({part, face});
  }
  std::sort(parts.begin(), parts.end(),
            [](const FacePart& p, const FacePart& q) { return p.part.begin < q.part.begin; });
  double done = 0.0;  // a chord along the border of two faces lies in both
  for (const FacePart& p : parts) {
    const Interval rest{std::max(p.part.begin, done), p.part.end};
    if (rest.empty()) continue;
    FaceWalk(surface, p.face, a, b - a, visit).walk(rest);
    done = rest.end;
  }
}

}  // namespace

void section(const Surface& surface, const glm::dvec3& from, const glm::dvec3& to,
             const std::function<void(const SectionPiece&)>& visit) {
  const glm::dvec3 a = glm::normalize(from);
  const glm::dvec3 b = glm::normalize(to);
  if (a == b) return;
  const double arc = mars::angle_between_rad(a, b);
  if (arc > mars::kPi - kNearlyOpposite_rad) {
    throw std::invalid_argument("a section between opposite sides of the planet; give a place between them");
  }
  // On a chord of the radius, 1 - Z w is as small as heights are against the radius, and keeps its bits.
  const double radius_m = surface.planet_radius_m();
  const auto chords = static_cast<int>(std::max(1.0, std::ceil(arc / kLongestChord_rad)));
  for (int n = 0; n < chords; ++n) {
    const auto place = [&](int k) {
      return radius_m * (k == 0 ? a : k == chords ? b : mars::slerp(a, b, static_cast<double>(k) / chords));
    };
    walk_chord(surface, place(n), place(n + 1), visit);
  }
}

SectionFigures section_figures(const Surface& surface, const glm::dvec3& from, const glm::dvec3& to) {
  SectionFigures figures;
  const double radius_m = surface.planet_radius_m();
  section(surface, from, to, [&](const SectionPiece& piece) {
    const glm::dvec3 along = piece.end_m - piece.begin_m;
    const double length_m = glm::length(along);
    figures.length_m += length_m;
    const double begin_m = glm::length(piece.begin_m);
    const double end_m = glm::length(piece.end_m);
    double low_m = std::min(begin_m, end_m);
    // A straight line is nearest to the centre at its foot point, which may lie between its ends.
    const double foot = length_m > 0 ? -glm::dot(piece.begin_m, along) / length_m : 0;
    if (foot > 0 && foot < length_m) low_m = glm::length(piece.begin_m + along * (foot / length_m));
    figures.lowest_m = std::min(figures.lowest_m, low_m - radius_m);
    figures.highest_m = std::max(figures.highest_m, std::max(begin_m, end_m) - radius_m);
  });
  return figures;
}

}  // namespace paging
