// The few half-edge operations that greedy insertion needs, on OpenMesh. Internal to lod.
#pragma once

#include <OpenMesh/Core/Mesh/TriConnectivity.hh>
#include <algorithm>
#include <array>
#include <cstddef>

namespace lod {

// The links of a star: the halfedges of its triangles that lie opposite the star's centre.
struct StarLinks {
  std::array<int, 4> halfedge{};
  int count = 0;
  void add(int h) { halfedge[static_cast<std::size_t>(count++)] = h; }
};

// Holds a triangulation for lod::GreedyMesher. Vertices, halfedges and faces are indices. Uses only OpenMesh's
// connectivity: a tile's vertices are posts, so no points, normals or status are stored. The library's arrays only grow, and
// this class counts what is in use, so that the next triangulation finds its memory there.
class OpenMeshTopology {
 public:
  // Starts with a square of vertices 0 1 2 3 as faces 0 1 2 and 0 2 3.
  void start() {
    vertices_ = edges_ = faces_ = 0;
    for (int v = 0; v < 4; ++v) add_vertex();
    const std::array<OpenMesh::HalfedgeHandle, 4> side{
        new_edge(vertex(0), vertex(1)), new_edge(vertex(1), vertex(2)), new_edge(vertex(2), vertex(3)),
        new_edge(vertex(3), vertex(0))};
    const OpenMesh::HalfedgeHandle diagonal = new_edge(vertex(0), vertex(2));
    make_face(new_face(), side[0], side[1], opposite(diagonal));
    make_face(new_face(), diagonal, side[2], side[3]);
    // A border vertex names its halfedge without a face.
    for (std::size_t k = 0; k < 4; ++k) {
      const OpenMesh::HalfedgeHandle outside = opposite(side[k]);
      mesh_.set_next_halfedge_handle(outside, opposite(side[(k + 3) % 4]));
      mesh_.set_halfedge_handle(mesh_.from_vertex_handle(outside), outside);
    }
  }
  // Returns the inner halfedge of the border edge between two vertices; flips may change its index.
  int border_halfedge(int from, int to) const { return mesh_.find_halfedge(vertex(from), vertex(to)).idx(); }

  int face_count() const { return faces_; }
  int first_halfedge(int f) const { return mesh_.halfedge_handle(OpenMesh::FaceHandle(f)).idx(); }
  int next(int h) const { return mesh_.next_halfedge_handle(halfedge(h)).idx(); }
  int to(int h) const { return mesh_.to_vertex_handle(halfedge(h)).idx(); }
  int from(int h) const { return to(h ^ 1); }
  int edge(int h) const { return h >> 1; }
  int face(int h) const { return mesh_.face_handle(halfedge(h)).idx(); }
  // Returns the same edge seen from the other triangle, or -1 at the border.
  int across(int h) const { return mesh_.is_boundary(halfedge(h ^ 1)) ? -1 : h ^ 1; }
  int add_vertex() {
    if (vertices_ == static_cast<int>(mesh_.n_vertices())) grow();
    return vertices_++;
  }

  // The operations below repeat OpenMesh's own (split, split, flip) on its kernel: the library checks each
  // handle at run time, which takes a fifth of the meshing.

  // Splits face f at vertex v.
  StarLinks split_face(int f, int v) {
    StarLinks links;
    for (int h = first_halfedge(f); links.count < 3; h = next(h)) links.add(h);
    std::array<OpenMesh::HalfedgeHandle, 3> spoke;  // from a corner to v
    for (std::size_t k = 0; k < 3; ++k) spoke[k] = new_edge(vertex(to(links.halfedge[k])), vertex(v));
    for (std::size_t k = 0; k < 3; ++k) {
      const OpenMesh::FaceHandle own = k == 0 ? OpenMesh::FaceHandle(f) : new_face();
      make_face(own, halfedge(links.halfedge[k]), spoke[k], opposite(spoke[(k + 2) % 3]));
    }
    mesh_.set_halfedge_handle(vertex(v), opposite(spoke[0]));
    return links;
  }

  // Splits the edge of h at vertex v.
  StarLinks split_edge(int h, int v) {
    StarLinks links;
    links.add(next(h));
    links.add(next(next(h)));
    const int other = across(h);
    if (other >= 0) {
      links.add(next(other));
      links.add(next(next(other)));
    }
    const OpenMesh::HalfedgeHandle here = halfedge(h);
    const OpenMesh::HalfedgeHandle there = halfedge(h ^ 1);
    const OpenMesh::VertexHandle end = mesh_.to_vertex_handle(here);
    const OpenMesh::HalfedgeHandle behind = mesh_.prev_halfedge_handle(there);  // used only at the border
    const OpenMesh::HalfedgeHandle onward = new_edge(vertex(v), end);           // the far half of the edge
    if (mesh_.halfedge_handle(end) == there) mesh_.set_halfedge_handle(end, opposite(onward));
    mesh_.set_vertex_handle(here, vertex(v));
    mesh_.set_halfedge_handle(vertex(v), onward);
    split_side(mesh_.face_handle(here), here, onward, links.halfedge[0], links.halfedge[1], v);
    if (other >= 0) {
      split_side(mesh_.face_handle(there), opposite(onward), there, links.halfedge[2], links.halfedge[3], v);
    } else {
      mesh_.set_next_halfedge_handle(behind, opposite(onward));
      mesh_.set_next_halfedge_handle(opposite(onward), there);
      mesh_.set_halfedge_handle(vertex(v), there);
    }
    return links;
  }

  // Flips the edge of link h. Returns the two links that replace it.
  std::array<int, 2> flip(int h) {
    const OpenMesh::HalfedgeHandle a = halfedge(h);
    const OpenMesh::HalfedgeHandle b = opposite(a);
    const OpenMesh::HalfedgeHandle a1 = mesh_.next_halfedge_handle(a);
    const OpenMesh::HalfedgeHandle a2 = mesh_.next_halfedge_handle(a1);
    const OpenMesh::HalfedgeHandle b1 = mesh_.next_halfedge_handle(b);
    const OpenMesh::HalfedgeHandle b2 = mesh_.next_halfedge_handle(b1);
    const OpenMesh::VertexHandle a_end = mesh_.to_vertex_handle(a);
    const OpenMesh::VertexHandle b_end = mesh_.to_vertex_handle(b);
    if (mesh_.halfedge_handle(a_end) == b) mesh_.set_halfedge_handle(a_end, a1);
    if (mesh_.halfedge_handle(b_end) == a) mesh_.set_halfedge_handle(b_end, b1);
    mesh_.set_vertex_handle(a, mesh_.to_vertex_handle(a1));
    mesh_.set_vertex_handle(b, mesh_.to_vertex_handle(b1));
    make_face(mesh_.face_handle(a), a, a2, b1);
    make_face(mesh_.face_handle(b), b, b2, a1);
    return {b1.idx(), b2.idx()};
  }

 private:
  static OpenMesh::VertexHandle vertex(int v) { return OpenMesh::VertexHandle(v); }
  static OpenMesh::HalfedgeHandle halfedge(int h) { return OpenMesh::HalfedgeHandle(h); }

  static OpenMesh::HalfedgeHandle opposite(OpenMesh::HalfedgeHandle h) { return halfedge(h.idx() ^ 1); }

  // A triangulation of v vertices has fewer than 3 v edges and 2 v triangles.
  void grow() {
    const std::size_t most = std::max<std::size_t>(64, 2 * mesh_.n_vertices());
    mesh_.resize(most, 3 * most, 2 * most);
  }
  // Returns a new edge without faces.
  OpenMesh::HalfedgeHandle new_edge(OpenMesh::VertexHandle start, OpenMesh::VertexHandle end) {
    const OpenMesh::HalfedgeHandle h = halfedge(2 * edges_++);
    mesh_.set_vertex_handle(h, end);
    mesh_.set_vertex_handle(opposite(h), start);
    mesh_.set_boundary(h);
    mesh_.set_boundary(opposite(h));
    return h;
  }
  OpenMesh::FaceHandle new_face() { return OpenMesh::FaceHandle(faces_++); }

  void make_face(OpenMesh::FaceHandle face, OpenMesh::HalfedgeHandle a, OpenMesh::HalfedgeHandle b,
                 OpenMesh::HalfedgeHandle c) {
    mesh_.set_next_halfedge_handle(a, b);
    mesh_.set_next_halfedge_handle(b, c);
    mesh_.set_next_halfedge_handle(c, a);
    mesh_.set_face_handle(a, face);
    mesh_.set_face_handle(b, face);
    mesh_.set_face_handle(c, face);
    mesh_.set_halfedge_handle(face, a);
  }

  // Splits one side of an edge: `in` ends at v, `out` starts there, `first` and `second` follow the old edge.
  void split_side(OpenMesh::FaceHandle face, OpenMesh::HalfedgeHandle in, OpenMesh::HalfedgeHandle out,
                  int first, int second, int v) {
    const OpenMesh::HalfedgeHandle spoke = new_edge(vertex(to(first)), vertex(v));
    make_face(face, opposite(spoke), halfedge(second), in);
    make_face(new_face(), out, halfedge(first), spoke);
  }

  OpenMesh::TriConnectivity mesh_;
  int vertices_ = 0;
  int edges_ = 0;
  int faces_ = 0;
};

}  // namespace lod
