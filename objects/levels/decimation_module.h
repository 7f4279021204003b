// Tells OpenMesh's decimater what decimation.cpp wants. No other source includes this.
#pragma once

// OpenMesh's headers do not pass our warnings when their templates are instantiated.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#ifndef __clang__
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
// Needs the one before.
#include <OpenMesh/Core/Geometry/QuadricT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#pragma GCC diagnostic pop

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>
#include <vector>

namespace objects::decimating {

// OpenMesh keeps connections only.
using Connections = OpenMesh::TriMesh_ArrayKernelT<>;
using OpenMesh::FaceHandle;
using OpenMesh::HalfedgeHandle;
using OpenMesh::VertexHandle;

struct Corner {
  int node = 0;
  std::uint32_t source = 0;  // the vertex of the mesh with the corner's attributes
};

struct Face {
  std::array<Corner, 3> corners;
  std::uint16_t material = 0;

  std::uint32_t source_at(VertexHandle v) const {
    return corners[corners[0].node == v.idx() ? 0 : corners[1].node == v.idx() ? 1 : 2].source;
  }
};

// By the handles' numbers. Sizes are of about 1, so that costs fit a float.
struct Surface {
  std::vector<glm::dvec3> nodes;
  std::vector<Face> faces;
  std::size_t left = 0;  // faces that are not deleted
};

// Says how much the place of a border counts, in areas of the square over each of its edges.
inline constexpr double kBorderWeight = 4;
// Puts the shorter edge first of two whose collapses move the surface alike.
inline constexpr double kLengthWeight = 1e-8;
// Lets a triangle turn by less than 78 degrees in a collapse, a thin one by less than 26: it would show as a
// dark line.
inline constexpr double kCosineOfTurn = 0.2;
inline constexpr double kCosineOfThinTurn = 0.9;
// Twice the area over the square of the longest side. Needles may not get thinner.
inline constexpr double kThin = 0.1;
inline constexpr double kNeedle = 1e-3;

// Orders collapses, forbids those that fold the surface, and carries attributes along.
template <class MeshT>
class ModKeepAttributes : public OpenMesh::Decimater::ModBaseT<MeshT> {
 public:
  DECIMATING_MODULE(ModKeepAttributes, MeshT, KeepAttributes);
  explicit ModKeepAttributes(MeshT& mesh) : Base(mesh, false) {}

  void set_surface(Surface& surface) { surface_ = &surface; }

  void initialize() override {
    const auto& mesh = Base::mesh();
    quadrics_.assign(mesh.n_vertices(), Quadric());
    areas_.assign(mesh.n_vertices(), 0.0);
    for (const FaceHandle f : mesh.faces()) {
      const Points at = points_of(f);
      const glm::dvec3 doubled = doubled_area(at);
      const double length = glm::length(doubled);
      if (!(length > 0)) continue;
      for (const Corner& c : face(f).corners) {
        add_plane(c.node, doubled / length, at[0], 0.5 * length);
        areas_[static_cast<std::size_t>(c.node)] += 0.5 * length;
      }
      for (auto h = mesh.cfh_iter(f); h.is_valid(); ++h) {
        if (!is_border(*h)) continue;
        const VertexHandle a = mesh.from_vertex_handle(*h);
        const VertexHandle b = mesh.to_vertex_handle(*h);
        const glm::dvec3 along = node(b) - node(a);
        const glm::dvec3 across = glm::cross(along, doubled);
        const double wide = glm::length(across);
        if (!(wide > 0)) continue;
        for (const VertexHandle end : {a, b})
          add_plane(end.idx(), across / wide, node(a), kBorderWeight * squared(along));
      }
    }
  }

  float collapse_priority(const CollapseInfo& info) override {
    if (asked_ != info.v0) ask(info.v0);
    Quadric q = quadrics_[index(info.v0)];
    q += quadrics_[index(info.v1)];
    const double area = areas_[index(info.v0)] + areas_[index(info.v1)];
    const glm::dvec3& to = node(info.v1);
    const double length2 = squared(to - node(info.v0));
    double cost = std::max(0.0, q(OpenMesh::Vec3d(to.x, to.y, to.z))) + kLengthWeight * area * length2;
    if (!keeps_borders(info)) cost += area * length2;
    const auto priority = static_cast<float>(cost);
    // The decimater takes the best of v0's edges: there is no need to look at the others closely.
    if (priority >= best_of_asked_) return priority;
    if (does_fold(info)) return Base::ILLEGAL_COLLAPSE;
    return best_of_asked_ = priority;
  }

  void preprocess_collapse(const CollapseInfo& info) override {
    const auto& mesh = Base::mesh();
    std::vector<std::pair<FaceHandle, std::uint32_t>> carried;
    // The triangles beside the edge vanish; those around v0 up to the next border continue them.
    const auto carry = [&](FaceHandle beside, bool is_left) {
      if (!beside.is_valid()) return;
      const std::uint32_t source = face(beside).source_at(info.v1);
      const std::size_t before = carried.size();
      HalfedgeHandle out = info.v0v1;
      while (true) {
        out = is_left ? mesh.ccw_rotated_halfedge_handle(out) : mesh.cw_rotated_halfedge_handle(out);
        if (out == info.v0v1) {
          // All around v0, though the edge is a border: there is no telling which side continues.
          if (is_border(out)) carried.resize(before);
          return;
        }
        if (is_border(out)) return;
        carried.emplace_back(mesh.face_handle(is_left ? out : mesh.opposite_halfedge_handle(out)), source);
      }
    };
    carry(info.fl, true);
    carry(info.fr, false);
    for (const auto& [f, source] : carried)
      for (Corner& c : face(f).corners)
        if (c.node == info.v0.idx()) c.source = source;
    for (auto f = mesh.cvf_iter(info.v0); f.is_valid(); ++f)
      for (Corner& c : face(*f).corners)
        if (c.node == info.v0.idx()) c.node = info.v1.idx();
    surface_->left -= (info.fl.is_valid() ? 1U : 0U) + (info.fr.is_valid() ? 1U : 0U);
  }

  void postprocess_collapse(const CollapseInfo& info) override {
    quadrics_[index(info.v1)] += quadrics_[index(info.v0)];
    areas_[index(info.v1)] += areas_[index(info.v0)];
    asked_ = VertexHandle();
  }

  // Forgets what holds only until the next collapse.
  void start() { asked_ = VertexHandle(); }

 private:
  using Quadric = OpenMesh::Geometry::QuadricT<double>;
  using Points = std::array<glm::dvec3, 3>;

  static std::size_t index(VertexHandle v) { return static_cast<std::size_t>(v.idx()); }
  static double squared(const glm::dvec3& v) { return glm::dot(v, v); }
  static glm::dvec3 doubled_area(const Points& at) { return glm::cross(at[1] - at[0], at[2] - at[0]); }
  static double longest2(const Points& at) {
    return std::max({squared(at[1] - at[0]), squared(at[2] - at[1]), squared(at[0] - at[2])});
  }

  Face& face(FaceHandle f) { return surface_->faces[static_cast<std::size_t>(f.idx())]; }
  const glm::dvec3& node(VertexHandle v) const { return surface_->nodes[index(v)]; }
  Points points_of(FaceHandle f) {
    const std::array<Corner, 3>& c = face(f).corners;
    const auto at = [&](std::size_t k) { return surface_->nodes[static_cast<std::size_t>(c[k].node)]; };
    return {at(0), at(1), at(2)};
  }

  void add_plane(int at_node, const glm::dvec3& normal, const glm::dvec3& at, double weight) {
    Quadric q(normal.x, normal.y, normal.z, -glm::dot(normal, at));
    q *= weight;
    quadrics_[static_cast<std::size_t>(at_node)] += q;
  }

  // Whether the surface, its material or its attributes end at an edge.
  bool is_border(HalfedgeHandle h) {
    const auto& mesh = Base::mesh();
    const FaceHandle f = mesh.face_handle(h);
    const FaceHandle g = mesh.face_handle(mesh.opposite_halfedge_handle(h));
    if (!f.is_valid() || !g.is_valid()) return true;
    const Face& a = face(f);
    const Face& b = face(g);
    if (a.material != b.material) return true;
    const VertexHandle from = mesh.from_vertex_handle(h);
    const VertexHandle to = mesh.to_vertex_handle(h);
    return a.source_at(from) != b.source_at(from) || a.source_at(to) != b.source_at(to);
  }

  void ask(VertexHandle v0) {
    const auto& mesh = Base::mesh();
    asked_ = v0;
    best_of_asked_ = std::numeric_limits<float>::max();
    borders_of_asked_ = 0;
    for (auto h = mesh.cvoh_iter(v0); h.is_valid(); ++h) borders_of_asked_ += is_border(*h) ? 1 : 0;
  }

  // Borders stay where they are if v0 is on none, or on a single one and moves along it.
  bool keeps_borders(const CollapseInfo& info) {
    return borders_of_asked_ == 0 || (borders_of_asked_ == 2 && is_border(info.v0v1));
  }

  bool does_fold(const CollapseInfo& info) {
    const auto& mesh = Base::mesh();
    for (auto f = mesh.cvf_iter(info.v0); f.is_valid(); ++f) {
      if (*f == info.fl || *f == info.fr) continue;
      Points at = points_of(*f);
      const glm::dvec3 before = doubled_area(at);
      const double longest2_before = longest2(at);
      for (std::size_t k = 0; k < 3; ++k)
        if (face(*f).corners[k].node == info.v0.idx()) at[k] = node(info.v1);
      const glm::dvec3 after = doubled_area(at);
      const double before2 = squared(before);
      const double after2 = squared(after);
      const double longest2_after = longest2(at);
      const auto is_below = [&](double thin) { return after2 < thin * thin * longest2_after * longest2_after; };
      const double along = glm::dot(before, after);
      const double cosine = is_below(kThin) ? kCosineOfThinTurn : kCosineOfTurn;
      if (along < 0 || along * along < cosine * cosine * before2 * after2) return true;
      if (is_below(kNeedle) &&
          after2 * longest2_before * longest2_before < before2 * longest2_after * longest2_after)
        return true;
    }
    return false;
  }

  Surface* surface_ = nullptr;
  std::vector<Quadric> quadrics_;
  std::vector<double> areas_;
  VertexHandle asked_;  // v0 of the last question, until the next collapse
  float best_of_asked_ = 0;
  int borders_of_asked_ = 0;
};

}  // namespace objects::decimating
