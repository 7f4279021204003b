#include "objects/model/hausdorff.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

namespace objects {

namespace {

constexpr double kRelativeTolerance = 0.05;
// Pieces at every seventh depth are halved at their longest edge, so that all shrink.
constexpr int kHalvingDepth = 7;

struct PieceCorner {
  glm::dvec3 at_m;
  double away_m = 0;  // from the other mesh
  std::uint32_t nearest = 0;
};

// A part of a triangle of one mesh.
struct SurfacePiece {
  std::array<PieceCorner, 3> corners;
  const DistanceTree* other = nullptr;
  int depth = 0;
};

struct QueuedPiece {
  double bound_m;
  std::uint32_t piece;
  // Total, so that the order does not depend on the library's heap.
  bool operator<(const QueuedPiece& o) const {
    return bound_m != o.bound_m ? bound_m < o.bound_m : piece < o.piece;
  }
};

// Where an edge of a piece is divided: at a share of the way from corner `from` to corner `to`.
struct PieceCut {
  std::size_t from = 0;
  std::size_t to = 1;
  double share = 0.5;
};

std::pair<std::size_t, double> longest_edge(const SurfacePiece& piece) {
  std::pair<std::size_t, double> longest{0, -1.0};
  for (std::size_t k = 0; k < 3; ++k) {
    const double length_m = glm::distance(piece.corners[k].at_m, piece.corners[(k + 1) % 3].at_m);
    if (length_m > longest.second) longest = {k, length_m};
  }
  return longest;
}

using CornerDistances =
    std::array<std::array<double, 3>, 3>;  // [i][j]: of corner i from the nearest triangle of j

CornerDistances corner_distances(const SurfacePiece& piece) {
  CornerDistances d_m{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      d_m[i][j] = piece.corners[i].nearest == piece.corners[j].nearest
                      ? piece.corners[i].away_m
                      : piece.other->distance_m(piece.corners[i].at_m, piece.corners[j].nearest);
  return d_m;
}

double bound_of(const SurfacePiece& piece, const CornerDistances& d_m) {
  // Every point of a triangle is within its longest edge / sqrt(3) of a corner.
  double bound_m = std::max({piece.corners[0].away_m, piece.corners[1].away_m, piece.corners[2].away_m}) +
                   longest_edge(piece).second * 0.57735026918962585;
  for (std::size_t j = 0; j < 3; ++j) bound_m = std::min(bound_m, std::max({d_m[0][j], d_m[1][j], d_m[2][j]}));
  return bound_m;
}

// Returns where the way from one corner to another leaves what is nearer to the first one's triangle. With
// coplanar triangles of a common edge the function below is linear, so that the first step finds it.
double share_of_change(const SurfacePiece& piece, const CornerDistances& d_m, std::size_t from, std::size_t to,
                       double enough_m) {
  const PieceCorner& a = piece.corners[from];
  const PieceCorner& b = piece.corners[to];
  const auto root_of = [](double p, double q) {
    const double root = std::sqrt(std::abs((p - q) * (p + q)));
    return p < q ? -root : root;
  };
  double low = 0;
  double high = 1;
  double at_low = root_of(d_m[from][from], d_m[from][to]);
  double at_high = root_of(d_m[to][from], d_m[to][to]);
  double share = 0.5;
  for (int step = 0; step < 12; ++step) {
    const double secant =
        at_high > at_low ? low - at_low * (high - low) / (at_high - at_low) : 0.5 * (low + high);
    share = step % 3 == 2 ? 0.5 * (low + high) : secant;
    const glm::dvec3 at = a.at_m + share * (b.at_m - a.at_m);
    const double at_share =
        root_of(piece.other->distance_m(at, a.nearest), piece.other->distance_m(at, b.nearest));
    if (std::abs(at_share) <= enough_m) break;
    if (at_share < 0) low = share, at_low = at_share;
    if (at_share > 0) high = share, at_high = at_share;
  }
  return std::clamp(share, 1e-3, 1.0 - 1e-3);
}

PieceCut cut_of(const SurfacePiece& piece, const CornerDistances& d_m, double enough_m) {
  const std::size_t longest = longest_edge(piece).first;
  PieceCut cut{longest, (longest + 1) % 3, 0.5};
  if (piece.depth % kHalvingDepth == kHalvingDepth - 1) return cut;
  double most_m = enough_m;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const double lost_m = std::min(d_m[i][j] - piece.corners[i].away_m, d_m[j][i] - piece.corners[j].away_m);
    if (lost_m <= most_m) continue;
    most_m = lost_m;
    cut = {i, j, -1.0};
  }
  if (cut.share < 0) cut.share = share_of_change(piece, d_m, cut.from, cut.to, enough_m);
  return cut;
}

class HausdorffSearch {
 public:
  HausdorffSearch(const DistanceTree& a, const DistanceTree& b, double tolerance_m)
      : tolerance_m_(std::max(tolerance_m, 0.0)),
        rounding_m_(64 * std::numeric_limits<double>::epsilon() * std::max(a.extent_m(), b.extent_m())),
        most_pieces_(1'000'000 + 8 * (std::size_t{a.size()} + b.size())) {
    std::array<std::vector<PieceCorner>, 2> corners{corners_of(a, b), corners_of(b, a)};
    add(a, b, corners[0]);
    add(b, a, corners[1]);
  }

  double run() {
    std::make_heap(queue_.begin(), queue_.end());
    while (!queue_.empty() && queue_.front().bound_m > enough_m() && made_ < most_pieces_) divide_first();
    if (!queue_.empty()) settled_m_ = std::max(settled_m_, queue_.front().bound_m);
    return std::max(settled_m_, least_m_) + rounding_m_;
  }

 private:
  // Bounds up to this need no work, as the distance is known to reach least_m_.
  double enough_m() const { return std::max(least_m_ * (1 + kRelativeTolerance), least_m_ + tolerance_m_); }

  std::vector<PieceCorner> corners_of(const DistanceTree& mesh, const DistanceTree& other) {
    std::vector<PieceCorner> corners;
    std::uint32_t hint = 0;
    for (std::uint32_t n = 0; n < mesh.size(); ++n) {
      const std::array<glm::dvec3, 3> at = mesh.corners_m(n);
      for (int k = 0; k < 3; ++k) {
        const std::size_t vertex = mesh.vertices(n)[k];
        if (vertex >= corners.size()) corners.resize(vertex + 1, {glm::dvec3(0.0), -1.0, 0});
        if (corners[vertex].away_m >= 0) continue;
        corners[vertex] = corner_at(at[static_cast<std::size_t>(k)], other, hint);
        hint = corners[vertex].nearest;
      }
    }
    return corners;
  }

  PieceCorner corner_at(const glm::dvec3& at_m, const DistanceTree& other, std::uint32_t hint) {
    const DistanceTree::Nearest nearest = other.nearest(at_m, hint);
    least_m_ = std::max(least_m_, nearest.distance_m);
    return {at_m, nearest.distance_m, nearest.triangle};
  }

  void add(const DistanceTree& mesh, const DistanceTree& other, const std::vector<PieceCorner>& corners) {
    for (std::uint32_t n = 0; n < mesh.size(); ++n) {
      const glm::uvec3& v = mesh.vertices(n);
      const SurfacePiece piece{{corners[v.x], corners[v.y], corners[v.z]}, &other, 0};
      const double bound_m = bound_of(piece, corner_distances(piece));
      if (settle(bound_m)) continue;
      pieces_.push_back(piece);
      queue_.push_back({bound_m, static_cast<std::uint32_t>(pieces_.size() - 1)});
    }
  }

  bool settle(double bound_m) {
    if (bound_m > enough_m()) return false;
    settled_m_ = std::max(settled_m_, bound_m);
    return true;
  }

  void push(const SurfacePiece& piece, std::uint32_t place) {
    ++made_;
    const double bound_m = bound_of(piece, corner_distances(piece));
    if (settle(bound_m)) {
      free_.push_back(place);
      return;
    }
    pieces_[place] = piece;
    queue_.push_back({bound_m, place});
    std::push_heap(queue_.begin(), queue_.end());
  }

  void divide_first() {
    std::pop_heap(queue_.begin(), queue_.end());
    const std::uint32_t place = queue_.back().piece;
    queue_.pop_back();
    const SurfacePiece piece = pieces_[place];
    const PieceCut cut = cut_of(piece, corner_distances(piece), 0.1 * enough_m());
    const PieceCorner& from = piece.corners[cut.from];
    const PieceCorner& to = piece.corners[cut.to];
    const PieceCorner middle = corner_at(from.at_m + cut.share * (to.at_m - from.at_m), *piece.other,
                                         cut.share < 0.5 ? from.nearest : to.nearest);
    std::uint32_t second = 0;
    if (free_.empty()) {
      second = static_cast<std::uint32_t>(pieces_.size());
      pieces_.emplace_back();
    } else {
      second = free_.back();
      free_.pop_back();
    }
    SurfacePiece part = piece;
    ++part.depth;
    part.corners[cut.to] = middle;
    push(part, place);
    part.corners = piece.corners;
    part.corners[cut.from] = middle;
    push(part, second);
  }

  double tolerance_m_;
  double rounding_m_;
  std::size_t most_pieces_;
  double least_m_ = 0;    // the largest distance found
  double settled_m_ = 0;  // the largest bound of pieces that need no work
  std::size_t made_ = 0;
  std::vector<SurfacePiece> pieces_;
  std::vector<std::uint32_t> free_;
  std::vector<QueuedPiece> queue_;
};

}  // namespace

double hausdorff_bound(const DistanceTree& a, const DistanceTree& b, double tolerance_m) {
  if (a.size() == 0 || b.size() == 0) return a.size() == b.size() ? 0 : std::numeric_limits<double>::infinity();
  return HausdorffSearch(a, b, tolerance_m).run();
}

double hausdorff_bound(const Mesh& a, const Mesh& b, double tolerance_m) {
  return hausdorff_bound(DistanceTree(a), DistanceTree(b), tolerance_m);
}

}  // namespace objects
