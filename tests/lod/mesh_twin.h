// A second half-edge structure for GreedyMesher: plain arrays, halfedge 3 f + k is edge k of face f. It shares
// no code with OpenMesh, so equal meshes from both show that neither breaks the topology.
#pragma once

#include <array>
#include <vector>

#include "lod/mesh/greedy.h"

namespace lod_test {

class ArrayTopology {
 public:
  void start() {
    from_.assign({0, 1, 2, 0, 2, 3});
    across_.assign({-1, -1, 3, 2, -1, -1});
    border_from_ = {0, 1, 4, 5};
  }
  int border_halfedge(int from, int) const { return border_from_[static_cast<std::size_t>(from)]; }

  int face_count() const { return static_cast<int>(from_.size() / 3); }
  int first_halfedge(int f) const { return 3 * f; }
  int next(int h) const { return h % 3 == 2 ? h - 2 : h + 1; }
  int from(int h) const { return from_[static_cast<std::size_t>(h)]; }
  int to(int h) const { return from(next(h)); }
  int face(int h) const { return h / 3; }
  int across(int h) const { return across_[static_cast<std::size_t>(h)]; }
  int add_vertex() {
    border_from_.push_back(-1);
    return static_cast<int>(border_from_.size()) - 1;
  }

  lod::StarLinks split_face(int f, int v) {
    const int a = from(3 * f);
    const int b = from(3 * f + 1);
    const int c = from(3 * f + 2);
    const int bc = across(3 * f + 1);
    const int ca = across(3 * f + 2);
    from_[static_cast<std::size_t>(3 * f + 2)] = v;  // a b v
    const int g = add_face(b, c, v);
    const int e = add_face(c, a, v);
    join(g, bc);
    join(e, ca);
    join(3 * f + 1, g + 2);
    join(g + 1, e + 2);
    join(e + 1, 3 * f + 2);
    lod::StarLinks links;
    for (const int h : {3 * f, g, e}) links.add(h);
    return links;
  }

  lod::StarLinks split_edge(int h, int v) {
    const int other = across(h);
    lod::StarLinks links;
    const int head = cut(h, v, links);
    if (other >= 0) {
      const int tail = cut(other, v, links);
      join(h, tail);
      join(other, head);
    } else {
      join(h, -1);
      join(head, -1);
    }
    return links;
  }

  std::array<int, 2> flip(int h) {
    const int o = across(h);
    const int hn = next(h);
    const int hp = next(hn);
    const int on = next(o);
    const int op = next(on);
    const int v = from(hp);
    const int d = from(op);
    const int b = from(hn);
    const int a = from(on);
    const int va = across(hp);  // v a lies beyond hp
    const int bv = across(hn);
    const int ad = across(on);
    const int db = across(op);
    // h's face becomes v a d, o's face v d b.
    set(h, v, a, d);
    set(o, v, d, b);
    join(h, va);
    join(next(h), ad);
    join(next(next(h)), o);
    join(next(o), db);
    join(next(next(o)), bv);
    return {next(h), next(o)};
  }

 private:
  int add_face(int a, int b, int c) {
    const int h = static_cast<int>(from_.size());
    for (const int v : {a, b, c}) {
      from_.push_back(v);
      across_.push_back(-1);
    }
    return h;
  }
  void set(int h, int a, int b, int c) {
    from_[static_cast<std::size_t>(h)] = a;
    from_[static_cast<std::size_t>(next(h))] = b;
    from_[static_cast<std::size_t>(next(next(h)))] = c;
  }
  void join(int g, int h) {
    across_[static_cast<std::size_t>(g)] = h;
    if (h >= 0) {
      across_[static_cast<std::size_t>(h)] = g;
    } else {
      border_from_[static_cast<std::size_t>(from(g))] = g;
    }
  }
  // Triangle a b c with h = a b becomes v b c (h stays) and a v c; returns the halfedge a v.
  int cut(int h, int v, lod::StarLinks& links) {
    const int a = from(h);
    const int c = from(next(next(h)));
    const int ca = across(next(next(h)));
    from_[static_cast<std::size_t>(h)] = v;
    const int g = add_face(a, v, c);
    join(g + 2, ca);
    join(g + 1, next(next(h)));
    links.add(next(h));
    links.add(g + 2);
    return g;
  }

  std::vector<int> from_;
  std::vector<int> across_;
  std::vector<int> border_from_;  // per vertex; flips rename halfedges, so it is kept up by join
};

}  // namespace lod_test
