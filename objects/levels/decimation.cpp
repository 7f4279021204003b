#include "objects/levels/decimation.h"

#include <algorithm>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include "objects/levels/decimation_module.h"
#include "objects/levels/manifold.h"

namespace objects {

namespace {

using decimating::FaceHandle;
using decimating::VertexHandle;

class StopAtTriangles : public OpenMesh::Decimater::Observer {
 public:
  StopAtTriangles(const decimating::Surface& surface, std::size_t triangles)
      : Observer(1), surface_(surface), triangles_(triangles) {}
  void notify(std::size_t /*step*/) override {}
  bool abort() const override { return surface_.left <= triangles_; }

 private:
  const decimating::Surface& surface_;
  std::size_t triangles_;
};

// Returns, for each vertex, the first one with the same texture coordinates and colour.
std::vector<std::uint32_t> equal_attributes(const Mesh& mesh) {
  std::vector<std::uint32_t> order(mesh.positions_m.size());
  for (std::uint32_t n = 0; n < order.size(); ++n) order[n] = n;
  if (mesh.uvs.empty() && mesh.colours.empty()) return std::vector<std::uint32_t>(order.size(), 0);
  const auto key = [&](std::uint32_t n) {
    const glm::vec2 uv = mesh.uvs.empty() ? glm::vec2(0) : mesh.uvs[n];
    const Rgba c = mesh.colours.empty() ? Rgba{} : mesh.colours[n];
    return std::make_tuple(uv.x, uv.y, c.r, c.g, c.b, c.a);
  };
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::make_pair(key(a), a) < std::make_pair(key(b), b);
  });
  std::vector<std::uint32_t> first(order.size());
  for (std::size_t n = 0; n < order.size(); ++n)
    first[order[n]] = n > 0 && key(order[n]) == key(order[n - 1]) ? first[order[n - 1]] : order[n];
  return first;
}

}  // namespace

struct Decimation::State {
  const Mesh* source = nullptr;
  decimating::Connections connections;
  decimating::Surface surface;
  std::vector<std::uint32_t> vertex_of;  // of nodes
  OpenMesh::Decimater::DecimaterT<decimating::Connections> decimater{connections};
  decimating::ModKeepAttributes<decimating::Connections>::Handle module;
};

Decimation::Decimation(const Mesh& mesh) : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.source = &mesh;
  const Manifold manifold = make_manifold(mesh);
  const std::vector<std::uint32_t> sources = equal_attributes(mesh);
  const Ball ball = bounding_ball(mesh);
  const glm::dvec3 centre(ball.centre_m);
  const double scale = ball.radius_m > 0 ? 1.0 / static_cast<double>(ball.radius_m) : 1.0;
  const auto add_node = [&](std::uint32_t vertex) {
    s.vertex_of.push_back(vertex);
    s.surface.nodes.push_back(scale * (glm::dvec3(mesh.positions_m[vertex]) - centre));
    return s.connections.new_vertex();
  };
  for (const std::uint32_t vertex : manifold.vertex_of) add_node(vertex);
  for (std::size_t n = 0; n < manifold.triangles.size(); ++n) {
    const std::uint32_t triangle = manifold.triangle_of[n];
    std::array<VertexHandle, 3> nodes;
    for (std::size_t k = 0; k < 3; ++k)
      nodes[k] = VertexHandle(static_cast<int>(manifold.triangles[n][static_cast<int>(k)]));
    if (!s.connections.add_face(nodes[0], nodes[1], nodes[2]).is_valid()) {
      for (std::size_t k = 0; k < 3; ++k) nodes[k] = add_node(mesh.triangles[triangle][static_cast<int>(k)]);
      s.connections.add_face(nodes[0], nodes[1], nodes[2]);
    }
    decimating::Face face;
    face.material = mesh.materials[triangle];
    for (std::size_t k = 0; k < 3; ++k)
      face.corners[k] = {nodes[k].idx(), sources[mesh.triangles[triangle][static_cast<int>(k)]]};
    s.surface.faces.push_back(face);
  }
  s.surface.left = s.surface.faces.size();
  s.decimater.add(s.module);
  s.decimater.module(s.module).set_surface(s.surface);
  s.decimater.initialize();
}

Decimation::~Decimation() = default;

std::size_t Decimation::triangles() const { return state_->surface.left; }

void Decimation::reduce_to(std::size_t triangles) {
  if (triangles >= this->triangles()) return;
  StopAtTriangles stop(state_->surface, triangles);
  state_->decimater.set_observer(&stop);
  state_->decimater.module(state_->module).start();
  state_->decimater.decimate();
  state_->decimater.set_observer(nullptr);
}

Mesh Decimation::mesh() const {
  const State& s = *state_;
  const Mesh& source = *s.source;
  Mesh result;
  result.material_table = source.material_table;
  std::unordered_map<std::uint64_t, std::uint32_t> vertices;  // of (node, source)
  for (const FaceHandle f : s.connections.faces()) {
    if (s.connections.status(f).deleted()) continue;
    const decimating::Face& face = s.surface.faces[static_cast<std::size_t>(f.idx())];
    const auto position_at = [&](std::size_t k) {
      return source.positions_m[s.vertex_of[static_cast<std::size_t>(face.corners[k].node)]];
    };
    const glm::dvec3 a(position_at(0));
    if (glm::cross(glm::dvec3(position_at(1)) - a, glm::dvec3(position_at(2)) - a) == glm::dvec3(0.0)) continue;
    glm::uvec3 triangle(0);
    for (std::size_t k = 0; k < 3; ++k) {
      const decimating::Corner& c = face.corners[k];
      const auto [entry, is_new] = vertices.try_emplace((static_cast<std::uint64_t>(c.node) << 32U) | c.source,
                                                        static_cast<std::uint32_t>(result.positions_m.size()));
      if (is_new) {
        result.positions_m.push_back(position_at(k));
        if (!source.uvs.empty()) result.uvs.push_back(source.uvs[c.source]);
        if (!source.colours.empty()) result.colours.push_back(source.colours[c.source]);
      }
      triangle[static_cast<int>(k)] = entry->second;
    }
    result.triangles.push_back(triangle);
    result.materials.push_back(face.material);
  }
  return result;
}

}  // namespace objects
