// Greedy insertion over any half-edge structure. Internal to lod; use lod/mesh/mesh.h.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "lod/mesh/greedy_heap.h"
#include "lod/mesh/greedy_lines.h"
#include "lod/mesh/greedy_scan.h"
#include "lod/mesh/greedy_topology.h"
#include "lod/mesh/greedy_triangulation.h"
#include "lod/mesh/mesh.h"

namespace lod {

// Throws std::invalid_argument unless the borders are ascending, inside the grid, and have both ends.
void check_borders(const BorderPosts& borders, int intervals);

// Implements Mesher. Keeps its scratch memory. OpenMeshTopology shows the interface of Topology.
template <class Topology>
class GreedyMesher {
 public:
  TileMesh mesh(const Posts& posts, const BorderPosts& borders, double tolerance_m, double radius_m) {
    check_borders(borders, posts.intervals);
    field_.load(posts, radius_m);
    key_ = posts.key;
    intervals_ = posts.intervals;
    set_tolerance(tolerance_m);
    return with_lines([&](const auto& lines) { return run(lines, borders); });
  }

  // Continues from the last mesh.
  TileMesh refine(const BorderPosts& borders, double tolerance_m) {
    check_borders(borders, intervals_);
    set_tolerance(tolerance_m);
    return with_lines([&](const auto& lines) {
      keep_borders(lines, borders);
      return grow(lines);
    });
  }

 private:
  void set_tolerance(double tolerance_m) {
    // |n / w - (R + h)| <= t  <=>  -t / (1 - t / r) <= (R + h) (1 - w / w0) <= t / (1 + t / r), r = R + h.
    tolerance_m_ = tolerance_m / (1.0 + tolerance_m / field_.lowest_radius_m());
  }

  template <class Use>
  TileMesh with_lines(Use&& use) {
    if (key_.level >= kEvenLevel) return use(EvenLines(intervals_));
    return use(WarpedLines(key_, intervals_));
  }

  template <class Lines>
  TileMesh run(const Lines& lines, const BorderPosts& borders) {
    field_.set_lines(lines.x(), lines.y());
    field_.ignore_borders();
    triangles_.start(lines, intervals_);
    faces_.clear();
    unchecked_count_ = 0;
    keep_borders(lines, borders);
    return grow(lines);
  }

  template <class Lines>
  void keep_borders(const Lines& lines, const BorderPosts& borders) {
    triangles_.keep_borders(lines, borders, [this](const std::vector<int>& star) {
      make_room();
      for (const int f : star) state(f).is_scanned = false;
    });
  }

  template <class Lines>
  TileMesh grow(const Lines& lines) {
    queue_.clear();
    make_room();
    forget_unchecked();
    for (int f = 0; f < topology().face_count(); ++f) recall(lines, f);
    do {
      while (!queue_.empty() && !triangles_.is_full()) {
        const QueuedPost worst = queue_.top();
        insert(lines, worst.face, worst.post);
      }
    } while (repair_edges(lines));
    return triangles_.result();
  }

  template <class Lines>
  void insert(const Lines& lines, int face, std::uint32_t post) {
    field_.ignore(post);
    triangles_.insert(lines, face, post);
    make_room();
    for (const int f : triangles_.star()) touch(lines, f);
  }

  // Holds what is known of a triangle, from mesh to mesh.
  struct FaceState {
    double worst_m = 0;  // WorstPost
    std::uint32_t worst_post = 0;
    bool is_scanned = false;
    bool is_unchecked = false;
    WorstPost worst() const { return {worst_m, worst_post}; }
  };

  FaceState& state(int face) { return faces_[static_cast<std::size_t>(face)]; }

  // Makes room for what is known of all triangles.
  void make_room() {
    const auto count = static_cast<std::size_t>(topology().face_count());
    faces_.resize(count);
    unchecked_.resize(count + 1);
  }

  // Queues a triangle that has changed.
  template <class Lines>
  void touch(const Lines& lines, int face) {
    FaceState& known = state(face);
    const WorstPost worst = scan(lines, face);
    known.worst_m = worst.geometric_error_m;
    known.worst_post = worst.post;
    known.is_scanned = true;
    queue_.set(face, worst, tolerance_m_);
    want_check(face, known);
  }

  // Queues a triangle for a new tolerance. Errors along edges only become fewer while their posts become vertices.
  template <class Lines>
  void recall(const Lines& lines, int face) {
    FaceState& known = state(face);
    if (!known.is_scanned) return touch(lines, face);
    queue_.set(face, known.worst(), tolerance_m_);
    int h = topology().first_halfedge(face);
    for (int side = 0; side < 3; ++side, h = topology().next(h)) {
      if (triangles_.edge_m(h) > tolerance_m_) return want_check(face, known);
    }
  }

  void want_check(int face, FaceState& known) {
    unchecked_[unchecked_count_] = face;
    unchecked_count_ += known.is_unchecked ? 0 : 1;
    known.is_unchecked = true;
  }

  // Although all posts are within tolerance, a long edge may cut a crest between two posts. Inserts a post
  // against each such edge of the triangles made since the last call. Returns false if there was none.
  template <class Lines>
  bool repair_edges(const Lines& lines) {
    collect_edges();
    wanted_.clear();
    for (const auto& [h, face] : edges_) {
      const WorstPost worst = field_.worst_crossing(triangles_.vertex(topology().from(h)),
                                                    triangles_.vertex(topology().to(h)), tolerance_m_);
      triangles_.edge_m(h) = worst.geometric_error_m;
      if (worst.geometric_error_m > tolerance_m_) wanted_.push_back({worst.post, face});
    }
    std::sort(wanted_.begin(), wanted_.end());
    bool any = false;
    std::uint32_t last = ~0U;
    for (const auto& [post, face] : wanted_) {
      if (post == last || triangles_.is_full()) continue;
      last = post;
      insert(lines, triangles_.locate(lines, face, post), post);
      any = true;
    }
    return any;
  }

  // Collects the edges of unchecked triangles that may have errors beyond the tolerance, each once. An edge whose error was
  // within the tolerance has none beyond it, since posts only become vertices. Without branches, which nothing could foresee.
  void collect_edges() {
    edges_.resize(3 * unchecked_count_);
    std::size_t count = 0;
    for (std::size_t k = 0; k < unchecked_count_; ++k) {
      const int f = unchecked_[k];
      int h = topology().first_halfedge(f);
      for (int side = 0; side < 3; ++side, h = topology().next(h)) {
        double& edge_m = triangles_.edge_m(h);
        edges_[count] = {h, f};
        count += static_cast<std::size_t>(edge_m > tolerance_m_);
        edge_m = std::min(edge_m, tolerance_m_);  // not collected again
      }
    }
    forget_unchecked();
    // Edges along lines and diagonals of S have no crossings.
    std::size_t slanting = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const auto [h, face] = edges_[k];
      const Corner& a = triangles_.vertex(topology().from(h));
      const Corner& b = triangles_.vertex(topology().to(h));
      const int di = b.i - a.i;
      const int dj = b.j - a.j;
      const bool is_of_surface = (di == 0) | (dj == 0) | ((di == dj) & (di * di == 1));
      edges_[slanting] = {h, face};
      slanting += static_cast<std::size_t>(!is_of_surface);
      double& edge_m = triangles_.edge_m(h);
      edge_m = is_of_surface ? 0.0 : edge_m;
    }
    edges_.resize(slanting);
  }

  void forget_unchecked() {
    for (std::size_t k = 0; k < unchecked_count_; ++k)
      faces_[static_cast<std::size_t>(unchecked_[k])].is_unchecked = false;
    unchecked_count_ = 0;
  }

  template <class Lines>
  WorstPost scan(const Lines& lines, int face) const {
    const int h = topology().first_halfedge(face);
    const Corner& a = triangles_.vertex(topology().from(h));
    const Corner& b = triangles_.vertex(topology().to(h));
    const Corner& c = triangles_.vertex(topology().to(topology().next(h)));
    return Lines::has_no_post(a, b, c) ? WorstPost{} : field_.worst(lines, a, b, c);
  }

  const Topology& topology() const { return triangles_.topology(); }

  static constexpr int kEvenLevel = 5;
  static_assert(1 << kEvenLevel == mars::kWarpKnots);

  GreedyTriangulation<Topology> triangles_;
  PostField field_;
  PostQueue queue_;
  std::vector<FaceState> faces_;
  std::vector<int> unchecked_;  // its first entries: triangles whose edges repair_edges() has not checked
  std::size_t unchecked_count_ = 0;
  std::vector<std::pair<int, int>> edges_;  // halfedges to check, and triangles beside them
  std::vector<std::pair<std::uint32_t, int>> wanted_;
  TileKey key_;
  int intervals_ = 0;
  double tolerance_m_ = 0;
};

}  // namespace lod
