// A Delaunay triangulation of posts that grows by single posts, over any half-edge structure. Internal to lod; use
// lod/mesh/mesh.h.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "lod/mesh/greedy_lines.h"
#include "lod/mesh/greedy_topology.h"
#include "lod/mesh/mesh.h"

namespace lod {

// Returns a TileMesh in its canonical form, from triangles of posts j * (intervals + 1) + i.
TileMesh canonical_mesh(int intervals, const std::vector<std::uint32_t>& posts,
                        const std::vector<std::array<std::uint32_t, 3>>& triangles);

inline constexpr std::size_t kMaxVertices = 65536;

// Implements the triangulation of GreedyMesher. OpenMeshTopology shows the interface of Topology. Lines are EvenLines or
// WarpedLines, the same in all calls.
template <class Topology>
class GreedyTriangulation {
 public:
  static constexpr double kUnknown = std::numeric_limits<double>::infinity();

  // Starts with the four corners of a grid.
  template <class Lines>
  void start(const Lines& lines, int intervals) {
    intervals_ = intervals;
    side_ = static_cast<std::uint32_t>(intervals) + 1;
    topology_.start();
    vertices_.clear();
    edges_m_.clear();
    const std::uint32_t last = side_ - 1;
    for (const std::uint32_t post : {0U, last, last * side_ + last, last * side_}) {
      vertices_.push_back(corner(lines, post));
    }
    edges_m_.resize(3 * vertices_.size(), kUnknown);
    for (int side = 0; side < 4; ++side) {
      border_[static_cast<std::size_t>(side)] = {{0, side}, {intervals_, (side + 1) % 4}};
    }
  }

  const Topology& topology() const { return topology_; }
  const Corner& vertex(int v) const { return vertices_[static_cast<std::size_t>(v)]; }
  bool is_full() const { return vertices_.size() >= kMaxVertices; }

  // Returns the value that belongs to the edge of a halfedge, until the edge is split or flipped. New edges have kUnknown,
  // and so has every edge at each call if the half-edge structure does not number edges.
  double& edge_m(int halfedge) {
    if constexpr (requires(const Topology& t) { t.edge(0); }) {
      return edges_m_[static_cast<std::size_t>(topology_.edge(halfedge))];
    } else {
      return unknown_m_ = kUnknown;
    }
  }

  // Returns the triangles around the last inserted post.
  const std::vector<int>& star() const { return star_; }

  // Inserts the border posts that are not vertices yet. Calls on_star(star()) after each.
  template <class Lines, class OnStar>
  void keep_borders(const Lines& lines, const BorderPosts& borders, const OnStar& on_star) {
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
        const int h = topology_.border_halfedge(merged.back().vertex, have[next].vertex);
        forget_edge(h);
        legalise(lines, v, topology_.split_edge(h, v));
        on_star(star_);
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

  // Inserts a post that lies in a triangle or on its sides.
  template <class Lines>
  void insert(const Lines& lines, int face, std::uint32_t post) {
    const int v = add(lines, post);
    const Corner& p = vertices_.back();
    star_.clear();
    int h = topology_.first_halfedge(face);
    for (int side = 0; side < 3; ++side, h = topology_.next(h)) {
      if (turn_of(vertex(topology_.from(h)), vertex(topology_.to(h)), p) == 0) {
        forget_edge(h);
        legalise(lines, v, topology_.split_edge(h, v));
        return;
      }
    }
    legalise(lines, v, topology_.split_face(face, v));
  }

  // Returns the triangle that contains a post, by walking towards it.
  template <class Lines>
  int locate(const Lines& lines, int face, std::uint32_t post) const {
    const Corner p = corner(lines, post);
    int h = topology_.first_halfedge(face);
    for (int inside = 0; inside < 3;) {
      if (turn_of(vertex(topology_.from(h)), vertex(topology_.to(h)), p) < 0) {
        h = topology_.next(topology_.across(h));
        inside = 1;
      } else {
        h = topology_.next(h);
        ++inside;
      }
    }
    return topology_.face(h);
  }

  // Returns the triangles as a mesh.
  TileMesh result() const {
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
    return canonical_mesh(intervals_, posts, triangles);
  }

 private:
  void forget_edge(int halfedge) { edge_m(halfedge) = kUnknown; }

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
      forget_edge(h);
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
  Corner corner(const Lines& lines, std::uint32_t post) const {
    const std::uint32_t i = post % side_;
    const std::uint32_t j = post / side_;
    return {post, static_cast<std::uint16_t>(i), static_cast<std::uint16_t>(j),
            static_cast<std::int32_t>(lines.x()[i]), static_cast<std::int32_t>(lines.y()[j])};
  }
  template <class Lines>
  int add(const Lines& lines, std::uint32_t post) {
    vertices_.push_back(corner(lines, post));
    edges_m_.resize(3 * vertices_.size(), kUnknown);  // a triangulation has fewer edges
    return topology_.add_vertex();
  }

  Topology topology_;
  std::vector<Corner> vertices_;
  std::vector<double> edges_m_;  // edge_m()
  double unknown_m_ = kUnknown;
  std::vector<int> star_;
  std::vector<int> stack_;
  // Border vertices of the sides south, east, north, west, counter-clockwise, by their distance along the side.
  struct BorderVertex {
    int along;
    int vertex;
  };
  std::array<std::vector<BorderVertex>, 4> border_;
  int intervals_ = 0;
  std::uint32_t side_ = 0;
};

}  // namespace lod
