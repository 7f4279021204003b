// OpenMesh's headers do not pass our warnings when their templates are instantiated.
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#ifndef __clang__
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#endif
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>

#include "lod/mesh/greedy.h"
#include "tests/bench/simplify_methods.h"

namespace bench {

namespace {

struct Traits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
};
using Mesh = OpenMesh::TriMesh_ArrayKernelT<Traits>;

struct Chart {
  int side;
  int i(int v) const { return v % side; }
  int j(int v) const { return v / side; }
};

template <class MeshT>
class ModKeepChart : public OpenMesh::Decimater::ModBaseT<MeshT> {
 public:
  DECIMATING_MODULE(ModKeepChart, MeshT, KeepChart);
  explicit ModKeepChart(MeshT& mesh) : Base(mesh, true) {}
  void set_chart(Chart chart) { chart_ = chart; }

  float collapse_priority(const CollapseInfo& info) override {
    const auto& mesh = Base::mesh();
    const int from = info.v0.idx();
    const int to = info.v1.idx();
    const int n = chart_.side - 1;
    for (const auto& at : {&Chart::i, &Chart::j}) {
      const int a = (chart_.*at)(from);
      if ((a == 0 || a == n) && (chart_.*at)(to) != a) return Base::ILLEGAL_COLLAPSE;
    }
    for (auto f = mesh.cvf_iter(info.v0); f.is_valid(); ++f) {
      if (*f == info.fl || *f == info.fr) continue;
      int x[3], y[3], k = 0;
      for (auto v = mesh.cfv_iter(*f); v.is_valid(); ++v, ++k) {
        const int moved = v->idx() == from ? to : v->idx();
        x[k] = chart_.i(moved);
        y[k] = chart_.j(moved);
      }
      if ((x[1] - x[0]) * (y[2] - y[0]) <= (y[1] - y[0]) * (x[2] - x[0])) return Base::ILLEGAL_COLLAPSE;
    }
    return Base::LEGAL_COLLAPSE;
  }

 private:
  Chart chart_{1};
};

}  // namespace

struct Decimater::State {
  Mesh mesh;
  OpenMesh::Decimater::DecimaterT<Mesh> decimater{mesh};
  OpenMesh::Decimater::ModQuadricT<Mesh>::Handle quadric;
  int side = 0;
};

Decimater::Decimater(const lod::Posts& posts, double radius_m) : state_(std::make_unique<State>()) {
  const int n = posts.intervals;
  state_->side = n + 1;
  const lod::GridLines lines = lod::grid_lines(posts.key, n);
  const auto point = [&](int i, int j) {
    const double u = lines.u[static_cast<std::size_t>(i)];
    const double v = lines.v[static_cast<std::size_t>(j)];
    return OpenMesh::Vec3d(u, v, 1.0) / lod::inverse_depth(u, v, posts.at(i, j), radius_m);
  };
  const OpenMesh::Vec3d middle = point(n / 2, n / 2);
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) state_->mesh.add_vertex(point(i, j) - middle);
  }
  const auto vertex = [&](int i, int j) { return OpenMesh::VertexHandle(j * (n + 1) + i); };
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      state_->mesh.add_face(vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1));
      state_->mesh.add_face(vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1));
    }
  }
  ModKeepChart<Mesh>::Handle keep;
  state_->decimater.add(state_->quadric);
  state_->decimater.add(keep);
  state_->decimater.module(keep).set_chart({n + 1});
  state_->decimater.initialize();
}
Decimater::~Decimater() = default;

void Decimater::decimate(double largest_quadric_m2) {
  // Not binary: the quadric also orders the collapses.
  state_->decimater.module(state_->quadric).set_max_err(largest_quadric_m2, false);
  state_->decimater.decimate();
}

std::optional<lod::TileMesh> Decimater::mesh() const {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t> posts;
  const Mesh& mesh = state_->mesh;
  for (const auto f : mesh.faces()) {
    std::array<std::uint32_t, 3> corner{};
    std::size_t k = 0;
    for (const auto v : f.vertices()) corner[k++] = static_cast<std::uint32_t>(v.idx());
    triangles.push_back(corner);
  }
  for (const auto v : mesh.vertices()) posts.push_back(static_cast<std::uint32_t>(v.idx()));
  if (posts.size() > lod::kMaxVertices) return std::nullopt;
  return lod::canonical_mesh(state_->side - 1, posts, triangles);
}

}  // namespace bench
