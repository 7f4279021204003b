// Greedy insertion over any half-edge structure. Internal to lod; use lod/mesh/mesh.h.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "lod/mesh/greedy_heap.h"
#include "lod/mesh/greedy_lines.h"
#include "lod/mesh/greedy_scan.h"
#include "lod/mesh/greedy_topology.h"
#include "lod/mesh/mesh.h"

namespace lod {

// Returns a TileMesh in its canonical form, from triangles of posts j * (intervals + 1) + i.
TileMesh canonical_mesh(int intervals, const std::vector<std::uint32_t>& posts,
                        const std::vector<std::array<std::uint32_t, 3>>& triangles);

// Throws std::invalid_argument unless the borders are ascending, inside the grid, and have both ends.
void check_borders(const BorderPosts& borders, int intervals);

inline constexpr std::size_t kMaxVertices = 65536;

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
    side_ = static_cast<std::uint32_t>(intervals_) + 1;
    start(lines);
    keep_borders(lines, borders);
    return grow(lines);
  }

  template <class Lines>
  TileMesh grow(const Lines& lines) {
    queue_.clear();
    forget_unchecked();
    for (int f = 0; f < topology_.face_count(); ++f) recall(lines, f);
    do {
      while (!queue_.empty() && vertices_.size() < kMaxVertices) {
        const QueuedPost worst = queue_.top();
        insert(lines, worst.face, worst.post);
        for (const int f : star_) touch(lines, f);
      }
    } while (repair_edges(lines));
    return result(intervals_);
  }

  // Holds what is known of a triangle, from mesh to mesh.
  struct FaceState {
    WorstPost worst;
    double edges_m = kUnknown;  // the largest error along its edges, of those looked at
    bool is_scanned = false;
    bool is_unchecked = false;
  };
  static constexpr double kUnknown = std::numeric_limits<double>::infinity();

  FaceState& state(int face) {
    const auto f = static_cast<std::size_t>(face);
    if (f >= faces_.size()) faces_.resize(f + 1);
    return faces_[f];
  }

  // Queues a triangle that has changed.
  template <class Lines>
  void touch(const Lines& lines, int face) {
    FaceState& known = state(face);
    known.worst = scan(lines, face);
    known.edges_m = kUnknown;
    known.is_scanned = true;
    queue_.set(face, known.worst, tolerance_m_);
    want_check(face, known);
  }

  // Queues a triangle for a new tolerance. Errors along edges only become fewer while their posts become vertices.
  template <class Lines>
  void recall(const Lines& lines, int face) {
    FaceState& known = state(face);
    if (!known.is_scanned) return touch(lines, face);
    queue_.set(face, known.worst, tolerance_m_);
    if (known.edges_m > tolerance_m_) want_check(face, known);
  }

  void want_check(int face, FaceState& known) {
    if (known.is_unchecked) return;
    known.is_unchecked = true;
    unchecked_.push_back(face);
  }

  // Although all posts are within tolerance, a long edge may cut a crest between two posts. Inserts a post
  // against each such edge of the triangles made since the last call. Returns false if there was none.
  template <class Lines>
  bool repair_edges(const Lines& lines) {
    wanted_.clear();
    for (const int f : unchecked_) faces_[static_cast<std::size_t>(f)].edges_m = 0;
    for (const int f : unchecked_) {
      FaceState& here = faces_[static_cast<std::size_t>(f)];
      int h = topology_.first_halfedge(f);
      for (int side = 0; side < 3; ++side, h = topology_.next(h)) {
        // An edge between two such triangles is checked from the first of them.
        const int other = topology_.across(h);
        const int beyond = other < 0 ? f : topology_.face(other);
        FaceState& there = faces_[static_cast<std::size_t>(beyond)];
        if (beyond < f && there.is_unchecked) continue;
        const WorstPost worst =
            field_.worst_crossing(vertex(topology_.from(h)), vertex(topology_.to(h)), tolerance_m_);
        here.edges_m = std::max(here.edges_m, worst.geometric_error_m);
        there.edges_m = std::max(there.edges_m, worst.geometric_error_m);
        if (worst.geometric_error_m > tolerance_m_) wanted_.push_back({worst.post, f});
      }
    }
    forget_unchecked();
    std::sort(wanted_.begin(), wanted_.end());
    bool any = false;
    std::uint32_t last = ~0U;
    for (const auto& [post, face] : wanted_) {
      if (post == last || vertices_.size() >= kMaxVertices) continue;
      last = post;
      insert(lines, locate(lines, face, post), post);
      for (const int f : star_) touch(lines, f);
      any = true;
    }
    return any;
  }

  void forget_unchecked() {
    for (const int f : unchecked_) faces_[static_cast<std::size_t>(f)].is_unchecked = false;
    unchecked_.clear();
  }

  // Returns the triangle that contains a post, by walking towards it.
  template <class Lines>
  int locate(const Lines& lines, int face, std::uint32_t post) const {
    const Corner p = corner(lines, post);
    int h = topology_.first_halfedge(face);
    for (int inside = 0; inside < 3;) {
      const Corner& a = vertex(topology_.from(h));
      const Corner& b = vertex(topology_.to(h));
      if ((b.x - a.x) * (p.y - a.y) < (b.y - a.y) * (p.x - a.x)) {
        h = topology_.next(topology_.across(h));
        inside = 1;
      } else {
        h = topology_.next(h);
        ++inside;
      }
    }
    return topology_.face(h);
  }

  template <class Lines>
  void start(const Lines& lines) {
    topology_.start();
    vertices_.clear();
    faces_.clear();
    unchecked_.clear();
    const std::uint32_t last = side_ - 1;
    for (const std::uint32_t post : {0U, last, last * side_ + last, last * side_}) {
      vertices_.push_back(corner(lines, post));
    }
    field_.ignore_borders();
    for (int side = 0; side < 4; ++side) {
      border_[static_cast<std::size_t>(side)] = {{0, side}, {intervals_, (side + 1) % 4}};
    }
  }

  // Inserts the border posts that are not vertices yet.
  template <class Lines>
  void keep_borders(const Lines& lines, const BorderPosts& borders) {
    const std::uint32_t last = side_ - 1;
    // Counter-clockwise: south and east ascend, north and west descend.
    const auto chain = [&](Edge edge, std::size_t side, std::uint32_t origin, std::uint32_t stride,
                           bool ascending) {
      const std::vector<int>& kept = borders[static_cast<std::size_t>(edge)];
      std::vector<BorderVertex>& have = border_[side];
      std::vector<BorderVertex> merged{have.front()};
      std::size_t next = 1;
      for (std::size_t k = 1; k < kept.size(); ++k) {
        const int at = ascending ? kept[k] : kept[kept.size() - 1 - k];
        const int along = ascending ? at : intervals_ - at;
        while (have[next].along < along) merged.push_back(have[next++]);
        if (have[next].along == along) continue;
        const int v = add(lines, origin + stride * static_cast<std::uint32_t>(at));
        star_.clear();
        legalise(lines, v,
                 topology_.split_edge(topology_.border_halfedge(merged.back().vertex, have[next].vertex), v));
        for (const int f : star_) state(f).is_scanned = false;
        merged.push_back({along, v});
      }
      merged.insert(merged.end(), have.begin() + static_cast<std::ptrdiff_t>(next), have.end());
      have = std::move(merged);
    };
    chain(Edge::kSouth, 0, 0, 1, true);
    chain(Edge::kEast, 1, last, side_, true);
    chain(Edge::kNorth, 2, last * side_, 1, false);
    chain(Edge::kWest, 3, 0, side_, false);
  }

  template <class Lines>
  void insert(const Lines& lines, int face, std::uint32_t post) {
    const int v = add(lines, post);
    field_.ignore(post);
    const Corner& p = vertices_.back();
    star_.clear();
    int h = topology_.first_halfedge(face);
    for (int side = 0; side < 3; ++side, h = topology_.next(h)) {
      const Corner& a = vertex(topology_.from(h));
      const Corner& b = vertex(topology_.to(h));
      if ((b.x - a.x) * (p.y - a.y) == (b.y - a.y) * (p.x - a.x)) {
        legalise(lines, v, topology_.split_edge(h, v));
        return;
      }
    }
    legalise(lines, v, topology_.split_face(face, v));
  }

  // Restores the Delaunay property around the new vertex v. star_ becomes the triangles around it.
  template <class Lines>
  void legalise(const Lines& lines, int v, const StarLinks& links) {
    stack_.assign(links.halfedge.begin(), links.halfedge.begin() + links.count);
    for (const int h : stack_) star_.push_back(topology_.face(h));
    while (!stack_.empty()) {
      const int h = stack_.back();
      stack_.pop_back();
      const int other = topology_.across(h);
      if (other < 0 || !wants_flip(lines, v, h, topology_.to(topology_.next(other)))) continue;
      star_.push_back(topology_.face(other));
      for (const int link : topology_.flip(h)) stack_.push_back(link);
    }
  }

  // Tests triangle v a b (h runs from a to b) against d on the other side of a b. Of four posts on a circle the
  // first in (j, i) order keeps its diagonal. That is an infinitesimal lift of earlier posts, so the result
  // does not depend on the order of insertion.
  template <class Lines>
  bool wants_flip(const Lines&, int v, int h, int d) const {
    const Corner& pv = vertex(v);
    const Corner& pa = vertex(topology_.from(h));
    const Corner& pb = vertex(topology_.to(h));
    const Corner& pd = vertex(d);
    const int sign =
        Lines::in_circle(pv.x - pd.x, pv.y - pd.y, pa.x - pd.x, pa.y - pd.y, pb.x - pd.x, pb.y - pd.y);
    return sign > 0 || (sign == 0 && std::min(pv.post, pd.post) < std::min(pa.post, pb.post));
  }

  template <class Lines>
  WorstPost scan(const Lines& lines, int face) const {
    const int h = topology_.first_halfedge(face);
    const Corner& a = vertex(topology_.from(h));
    const Corner& b = vertex(topology_.to(h));
    const Corner& c = vertex(topology_.to(topology_.next(h)));
    return Lines::has_no_post(a, b, c) ? WorstPost{} : field_.worst(lines, a, b, c);
  }

  template <class Lines>
  Corner corner(const Lines& lines, std::uint32_t post) const {
    return {post, post % side_, post / side_, lines.x()[post % side_], lines.y()[post / side_]};
  }
  template <class Lines>
  int add(const Lines& lines, std::uint32_t post) {
    vertices_.push_back(corner(lines, post));
    return topology_.add_vertex();
  }
  const Corner& vertex(int v) const { return vertices_[static_cast<std::size_t>(v)]; }

  TileMesh result(int intervals) const {
    std::vector<std::uint32_t> posts;
    posts.reserve(vertices_.size());
    for (const Corner& c : vertices_) posts.push_back(c.post);
    std::vector<std::array<std::uint32_t, 3>> triangles;
    triangles.reserve(static_cast<std::size_t>(topology_.face_count()));
    for (int f = 0; f < topology_.face_count(); ++f) {
      const int h = topology_.first_halfedge(f);
      triangles.push_back({vertex(topology_.from(h)).post, vertex(topology_.to(h)).post,
                           vertex(topology_.to(topology_.next(h))).post});
    }
    return canonical_mesh(intervals, posts, triangles);
  }

  static constexpr int kEvenLevel = 5;
  static_assert(1 << kEvenLevel == mars::kWarpKnots);

  Topology topology_;
  PostField field_;
  PostQueue queue_;
  std::vector<Corner> vertices_;
  std::vector<int> star_;
  std::vector<int> stack_;
  std::vector<int> unchecked_;  // triangles whose edges repair_edges() has not checked
  std::vector<FaceState> faces_;
  std::vector<std::pair<std::uint32_t, int>> wanted_;
  // Border vertices of the sides south, east, north, west, counter-clockwise, by their distance along the side.
  struct BorderVertex {
    int along;
    int vertex;
  };
  std::array<std::vector<BorderVertex>, 4> border_;
  TileKey key_;
  int intervals_ = 0;
  std::uint32_t side_ = 0;
  double tolerance_m_ = 0;
};

}  // namespace lod
