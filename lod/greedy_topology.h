// Half-edges of OpenMesh behind the few operations that greedy insertion needs (internal to lod).
#pragma once

#include <OpenMesh/Core/Mesh/TriConnectivity.hh>
#include <array>

namespace lod {

// Links of a star: the halfedges of its triangles that lie opposite the star's centre.
struct StarLinks {
  std::array<int, 4> halfedge{};
  int count = 0;
  void add(int h) { halfedge[static_cast<std::size_t>(count++)] = h; }
};

// What lod::GreedyMesher asks of a half-edge structure; vertices, halfedges and faces are indices.
// OpenMesh's connectivity alone: a tile's vertices are posts, so no points, normals or status are stored.
class OpenMeshTopology {
 public:
  // Square of vertices 0 1 2 3 as faces 0 1 2 and 0 2 3.
  void start() {
    mesh_.clear();
    for (int v = 0; v < 4; ++v) mesh_.new_vertex();
    mesh_.add_face(vertex(0), vertex(1), vertex(2));
    mesh_.add_face(vertex(0), vertex(2), vertex(3));
  }
  // The border edge between two vertices, inner side; flips may rename it.
  int border_halfedge(int from, int to) const { return mesh_.find_halfedge(vertex(from), vertex(to)).idx(); }

  int face_count() const { return static_cast<int>(mesh_.n_faces()); }
  int first_halfedge(int f) const { return mesh_.halfedge_handle(OpenMesh::FaceHandle(f)).idx(); }
  int next(int h) const { return mesh_.next_halfedge_handle(halfedge(h)).idx(); }
  int to(int h) const { return mesh_.to_vertex_handle(halfedge(h)).idx(); }
  int from(int h) const { return to(h ^ 1); }
  int face(int h) const { return mesh_.face_handle(halfedge(h)).idx(); }
  // The same edge seen from the other triangle, -1 at the border.
  int across(int h) const { return mesh_.is_boundary(halfedge(h ^ 1)) ? -1 : h ^ 1; }
  int add_vertex() { return mesh_.new_vertex().idx(); }

  // Splits face f at vertex v.
  StarLinks split_face(int f, int v) {
    StarLinks links;
    for (int h = first_halfedge(f); links.count < 3; h = next(h)) links.add(h);
    mesh_.split(OpenMesh::FaceHandle(f), vertex(v));
    return links;
  }

  // Splits the edge of h at vertex v.
  StarLinks split_edge(int h, int v) {
    StarLinks links;
    links.add(next(h));
    links.add(next(next(h)));
    if (const int other = across(h); other >= 0) {
      links.add(next(other));
      links.add(next(next(other)));
    }
    mesh_.split(OpenMesh::EdgeHandle(h / 2), vertex(v));
    return links;
  }

  // Turns the edge of link h; returns the two links that replace it.
  std::array<int, 2> flip(int h) {
    const int other = h ^ 1;
    const std::array<int, 2> links{next(other), next(next(other))};
    mesh_.flip(OpenMesh::EdgeHandle(h / 2));
    return links;
  }

 private:
  static OpenMesh::VertexHandle vertex(int v) { return OpenMesh::VertexHandle(v); }
  static OpenMesh::HalfedgeHandle halfedge(int h) { return OpenMesh::HalfedgeHandle(h); }

  OpenMesh::TriConnectivity mesh_;
};

}  // namespace lod
