// Ray casting against S. In the chart of a face a straight ray stays straight and a flat triangle is a plane
// 1 = A X + B Y + C Z through its three posts (X, Y, Z = components along the face's axes), so each cell needs
// three linear functions of the ray parameter and no trigonometry (design notes, rays.md section 1).
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "paging/surface.h"

namespace paging {

namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();

// A function of the ray parameter, value + slope * t.
struct Linear {
  double value = 0;
  double slope = 0;
  double at(double t) const { return value + slope * t; }
};

struct Interval {
  double begin = 0;
  double end = 0;
  bool empty() const { return !(begin < end); }
};

// Where f >= 0.
Interval clip(Interval in, Linear f) {
  if (f.slope == 0.0) return f.value >= 0.0 ? in : Interval{};
  const double root = -f.value / f.slope;
  if (f.slope > 0.0) {
    in.begin = std::max(in.begin, root);
  } else {
    in.end = std::min(in.end, root);
  }
  return in;
}

class FaceCaster {
 public:
  FaceCaster(const Surface& surface, mars::Face face, const glm::dvec3& eye, const glm::dvec3& direction,
             double exaggeration)
      : surface_(surface),
        tree_(surface.planet().tree()),
        radius_(surface.planet_radius_m()),
        exaggeration_(exaggeration),
        face_(face) {
    const mars::FaceAxes& a = mars::face_axes(face);
    x_ = {glm::dot(a.right, eye), glm::dot(a.right, direction)};
    y_ = {glm::dot(a.up, eye), glm::dot(a.up, direction)};
    z_ = {glm::dot(a.out, eye), glm::dot(a.out, direction)};
    eye2_ = glm::dot(eye, eye);
    half_ = glm::dot(eye, direction);
  }

  // Part of the ray inside the face's pyramid and below the highest terrain.
  Interval reach() const {
    Interval all{0.0, kNone};
    all = clip(all, z_);
    all = clip(all, line_u(-1.0));
    all = clip(all, negated(line_u(1.0)));
    all = clip(all, line_v(-1.0));
    return clip(all, negated(line_v(1.0)));
  }

  double cast(Interval part) const { return in_tile(static_cast<lod::TileTree::Index>(face_), part); }

 private:
  static Linear negated(Linear f) { return {-f.value, -f.slope}; }
  // Zero on the chart line u = const, positive beyond it (Z > 0).
  Linear line_u(double u) const { return {x_.value - u * z_.value, x_.slope - u * z_.slope}; }
  Linear line_v(double v) const { return {y_.value - v * z_.value, y_.slope - v * z_.slope}; }

  // Least squared distance from the planet's centre over part of the ray.
  double least_radius2(Interval part) const {
    const double t = std::clamp(-half_, part.begin, part.end);
    return eye2_ + t * (2.0 * half_ + t);
  }

  bool above(Interval part, double height) const {
    const double top = radius_ + exaggeration_ * height;
    return least_radius2(part) > top * top;
  }

  // Visits the four quarters that two lines cut out of a part of the ray, in the ray's order. visit(east,
  // north, interval) returns the hit or kNone.
  template <typename Visit>
  double quarters(Interval part, Linear fu, Linear fv, Visit&& visit) const {
    std::array<double, 4> cuts{part.begin, part.end, part.end, part.end};
    int count = 1;
    for (const Linear& f : {fu, fv}) {
      const double root = f.slope == 0.0 ? kNone : -f.value / f.slope;
      if (root > part.begin && root < part.end) cuts[static_cast<std::size_t>(count++)] = root;
    }
    cuts[static_cast<std::size_t>(count)] = part.end;
    if (count == 3 && cuts[1] > cuts[2]) std::swap(cuts[1], cuts[2]);
    for (std::size_t c = 0; c < static_cast<std::size_t>(count); ++c) {
      const Interval piece{cuts[c], cuts[c + 1]};
      if (piece.empty()) continue;
      // Beyond the far end of an unbounded ray any later point will do to tell the side.
      const double middle =
          std::isfinite(piece.end) ? 0.5 * (piece.begin + piece.end) : 2.0 * piece.begin + radius_;
      const double hit = visit(fu.at(middle) >= 0.0, fv.at(middle) >= 0.0, piece);
      if (hit < kNone) return hit;
    }
    return kNone;
  }

  double in_tile(lod::TileTree::Index index, Interval part) const {
    const lod::TileInfo& info = tree_[index];
    if (above(part, info.max_height_m)) return kNone;
    const lod::TileKey& key = info.key;
    if (!info.has_children) {
      const auto tile = surface_.tile(key);
      return in_block(*tile, static_cast<int>(tile->block_max.size()), 0, 0, part);
    }
    const lod::TileTree::Index first = tree_.first_child(index);
    return quarters(part, line_u(surface_.middle_line(key.level, key.i)),
                    line_v(surface_.middle_line(key.level, key.j)), [&](bool east, bool north, Interval piece) {
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
    return quarters(part, line_u(u), line_v(v), [&](bool east, bool north, Interval piece) {
      return in_block(tile, b - 1, 2 * i + (east ? 1 : 0), 2 * j + (north ? 1 : 0), piece);
    });
  }

  double in_cell(const SurfaceTile& tile, int i, int j, Interval part) const {
    const auto x = static_cast<std::size_t>(i);
    const auto y = static_cast<std::size_t>(j);
    const double u0 = tile.lines.u[x];
    const double du = tile.lines.u[x + 1] - u0;
    const double v0 = tile.lines.v[y];
    const double dv = tile.lines.v[y + 1] - v0;
    const auto depth = [&](int a, int b) {
      return lod::inverse_depth(tile.lines.u[x + static_cast<std::size_t>(a)],
                                tile.lines.v[y + static_cast<std::size_t>(b)],
                                exaggeration_ * tile.data.posts.at(i + a, j + b), radius_);
    };
    const double w00 = depth(0, 0);
    const double w11 = depth(1, 1);
    const double w10 = depth(1, 0);
    const double w01 = depth(0, 1);
    // Relative to the cell's corner: s = (u - u0) / du, t likewise; w = w00 + ws s + wt t on each triangle.
    const Linear fs = line_u(u0);
    const Linear ft = line_v(v0);
    const auto surface = [&](double ws, double wt) {
      // 1 - Z w: negative above the surface of the ray, positive below it; scaled so that it is linear.
      const double a = ws / du;
      const double b = wt / dv;
      return Linear{1.0 - w00 * z_.value - a * fs.value - b * ft.value,
                    -w00 * z_.slope - a * fs.slope - b * ft.slope};
    };
    const Linear lower = surface(w10 - w00, w11 - w10);  // south-east of the diagonal
    const Linear upper = surface(w11 - w01, w01 - w00);
    // Diagonal: s - t, positive to the south-east.
    const Linear diagonal{fs.value / du - ft.value / dv, fs.slope / du - ft.slope / dv};
    const double root = diagonal.slope == 0.0 ? kNone : -diagonal.value / diagonal.slope;
    const bool cut = root > part.begin && root < part.end;
    const std::array<Interval, 2> pieces{Interval{part.begin, cut ? root : part.end}, Interval{root, part.end}};
    for (std::size_t p = 0; p < (cut ? 2U : 1U); ++p) {
      const Interval& piece = pieces[p];
      const double middle = 0.5 * (piece.begin + piece.end);
      const Linear& f = diagonal.at(middle) >= 0.0 ? lower : upper;
      if (f.at(piece.begin) >= 0.0) return piece.begin;
      if (f.at(piece.end) >= 0.0) return std::clamp(-f.value / f.slope, piece.begin, piece.end);
    }
    return kNone;
  }

  const Surface& surface_;
  const lod::TileTree& tree_;
  double radius_;
  double exaggeration_;
  mars::Face face_;
  Linear x_;
  Linear y_;
  Linear z_;
  double eye2_ = 0;
  double half_ = 0;
};

}  // namespace

double Surface::cast(const glm::dvec3& eye_m, const glm::dvec3& direction, double exaggeration,
                     const RayPart& wanted) const {
  // Only the part inside the sphere of the highest terrain can hit.
  const double radius = planet_->radius_m();
  const double top = radius + exaggeration * (planet_->meta().highest_radius_m - radius);
  const double half = glm::dot(eye_m, direction);
  const double rest = half * half - (glm::dot(eye_m, eye_m) - top * top);
  if (!(rest >= 0.0)) return kNone;
  const Interval shell{std::max(wanted.begin_m, -half - std::sqrt(rest)),
                       std::min(wanted.end_m, -half + std::sqrt(rest))};
  if (shell.empty()) return kNone;

  struct Candidate {
    double begin;
    double end;
    int face;
  };
  std::vector<Candidate> candidates;
  for (int f = 0; f < mars::kFaces; ++f) {
    Interval part = FaceCaster(*this, static_cast<mars::Face>(f), eye_m, direction, exaggeration).reach();
    part = {std::max(part.begin, shell.begin), std::min(part.end, shell.end)};
    if (!part.empty()) candidates.push_back({part.begin, part.end, f});
  }
  std::sort(candidates.begin(), candidates.end(),
            [](const Candidate& a, const Candidate& b) { return a.begin < b.begin; });
  for (const Candidate& candidate : candidates) {
    const FaceCaster caster(*this, static_cast<mars::Face>(candidate.face), eye_m, direction, exaggeration);
    const double hit = caster.cast({candidate.begin, candidate.end});
    if (hit < kNone) return hit;
  }
  return kNone;
}

}  // namespace paging
