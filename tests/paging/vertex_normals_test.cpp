// Normals of the vertices of meshes: what light of vertices is made of.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <map>

#include "paging/shading/terrain_shader.h"
#include "tests/paging/planet_fixture.h"

namespace {

using paging::PlanetFile;
using paging::ShadingParams;
using paging::TerrainShader;

constexpr double kExaggeration = 12;

struct Mesh {
  lod::TileMesh mesh;
  std::vector<double> height_m;
  std::vector<glm::dvec3> places;
};

Mesh mesh_of(const PlanetFile& planet, const lod::TileKey& key, int variant, double exaggeration) {
  Mesh out;
  const lod::TileInfo& tile = *planet.tree().find(key);
  if (lod::is_full_grid(tile, variant)) {
    out.mesh = lod::mesh_full(planet.meta().tile.intervals());
    out.height_m = planet.heights(key, exaggeration).posts.height_m;
  } else {
    paging::PackedMesh packed = planet.mesh(key, variant);
    for (const std::int32_t q : packed.height_q) out.height_m.push_back(q * planet.meta().quantum_m);
    out.mesh = std::move(packed.mesh);
  }
  const lod::GridLines lines = lod::grid_lines(key, out.mesh.intervals);
  for (std::size_t v = 0; v < out.mesh.vertices.size(); ++v) {
    out.places.push_back(
        mars::chart_direction(key.face, lines.u[out.mesh.vertices[v].i], lines.v[out.mesh.vertices[v].j]) *
        (planet.radius_m() + exaggeration * out.height_m[v]));
  }
  return out;
}

bool on_border(const Mesh& m, std::size_t v) {
  const lod::MeshVertex at = m.mesh.vertices[v];
  return at.i == 0 || at.j == 0 || at.i == m.mesh.intervals || at.j == m.mesh.intervals;
}

class VertexNormals : public ::testing::Test {
 protected:
  void SetUp() override {
    planet_ = test_support::build_fake(dir_ / "p.vpe", test_support::FakeElevation(test_support::bumpy_height),
                                       90000);
    shader_ = std::make_unique<TerrainShader>(planet_, std::size_t{64} << 20);
  }
  std::vector<glm::vec3> normals(const lod::TileKey& key, const Mesh& m, const ShadingParams& params) const {
    return shader_->vertex_normals(key, m.mesh, m.height_m, params);
  }
  static ShadingParams params() {
    ShadingParams out;
    out.exaggeration = kExaggeration;
    return out;
  }
  // Calls visit(tile, variant) for every mesh of the planet.
  template <typename Visit>
  void for_each_mesh(const Visit& visit) const {
    for (const lod::TileInfo& tile : planet_->tree().tiles())
      for (std::size_t n = 0; n < tile.variants.size(); ++n) visit(tile, static_cast<int>(n));
  }

  test_support::TempDir dir_;
  std::shared_ptr<const PlanetFile> planet_;
  std::unique_ptr<TerrainShader> shader_;
};

TEST_F(VertexNormals, InsideAreMeansOfTheTrianglesByArea) {
  int inside = 0;
  for_each_mesh([&](const lod::TileInfo& tile, int variant) {
    const Mesh m = mesh_of(*planet_, tile.key, variant, kExaggeration);
    const std::vector<glm::vec3> found = normals(tile.key, m, params());
    ASSERT_EQ(found.size(), m.places.size());
    std::vector<glm::dvec3> sums(m.places.size(), glm::dvec3(0));
    for (std::size_t t = 0; t + 2 < m.mesh.triangles.size(); t += 3) {
      const glm::dvec3 a = m.places[m.mesh.triangles[t]], b = m.places[m.mesh.triangles[t + 1]],
                       c = m.places[m.mesh.triangles[t + 2]];
      const double x = glm::length(b - a), y = glm::length(c - b), z = glm::length(a - c), s = (x + y + z) / 2;
      const double area = std::sqrt(std::max(0.0, s * (s - x) * (s - y) * (s - z)));
      const glm::dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
      for (std::size_t k = 0; k < 3; ++k) sums[m.mesh.triangles[t + k]] += area * normal;
    }
    for (std::size_t v = 0; v < found.size(); ++v) {
      EXPECT_NEAR(glm::length(found[v]), 1, 1e-6);
      EXPECT_GT(glm::dot(glm::dvec3(found[v]), m.places[v]), 0);
      if (on_border(m, v)) continue;
      ++inside;
      ASSERT_LT(glm::length(glm::dvec3(found[v]) - glm::normalize(sums[v])), 1e-5) << v;
    }
  });
  EXPECT_GT(inside, 20000);
}

// Light would otherwise have a step along a border.
TEST_F(VertexNormals, OnBordersAreTheSameFromBothTiles) {
  constexpr double kSame = 1e-4;  // radians; a tenth of a step of 8 bits in light, at most
  struct Vertex {
    glm::dvec3 place;
    glm::vec3 normal;
  };
  // By level, of all meshes, at places to the nearest 10 m.
  std::map<std::tuple<int, std::int64_t, std::int64_t, std::int64_t>, std::vector<Vertex>> met;
  for_each_mesh([&](const lod::TileInfo& tile, int variant) {
    const Mesh m = mesh_of(*planet_, tile.key, variant, kExaggeration);
    const std::vector<glm::vec3> found = normals(tile.key, m, params());
    for (std::size_t v = 0; v < found.size(); ++v) {
      if (!on_border(m, v)) continue;
      const auto near = [](double x) { return static_cast<std::int64_t>(std::llround(x / 10)); };
      // The direction alone names the place: exact in all tiles.
      const glm::dvec3 d = glm::normalize(m.places[v]) * planet_->radius_m();
      met[{tile.key.level, near(d.x), near(d.y), near(d.z)}].push_back({m.places[v], found[v]});
    }
  });
  int shared = 0, corners = 0;
  double worst = 0;
  for (const auto& [at, vertices] : met) {
    if (vertices.size() < 2) continue;
    const glm::dvec3 d = glm::abs(glm::normalize(vertices[0].place));
    const bool is_cube_corner = std::max({d.x, d.y, d.z}) - std::min({d.x, d.y, d.z}) < 1e-6;
    corners += is_cube_corner ? 1 : 0;
    for (const Vertex& other : vertices) {
      EXPECT_LT(glm::length(other.place - vertices[0].place), 20) << "tiles do not meet";
      const double angle = glm::length(other.normal - vertices[0].normal);
      if (!is_cube_corner) worst = std::max(worst, angle);
    }
    ++shared;
  }
  EXPECT_LT(worst, kSame);
  EXPECT_GT(shared, 1000);
  EXPECT_GE(corners, 8);
}

TEST_F(VertexNormals, OnBordersAreThoseOfThePostsAndBetweenThem) {
  int at_posts = 0, between = 0;
  for_each_mesh([&](const lod::TileInfo& tile, int variant) {
    const Mesh m = mesh_of(*planet_, tile.key, variant, kExaggeration);
    const std::vector<glm::vec3> found = normals(tile.key, m, params());
    ShadingParams unlit = params();
    unlit.lit = false;
    const auto posts = shader_->normals(tile.key, unlit);
    const int finer = m.mesh.intervals / (posts->side - 1);
    const auto post = [&](int i, int j) {
      return posts->posts[static_cast<std::size_t>(j * posts->side + i)].normal;
    };
    for (std::size_t v = 0; v < found.size(); ++v) {
      if (!on_border(m, v)) continue;
      const int i = m.mesh.vertices[v].i, j = m.mesh.vertices[v].j;
      const glm::vec3 one = post(i / finer, j / finer);
      const glm::vec3 other = post((i + finer - 1) / finer, (j + finer - 1) / finer);
      const bool is_between = i % finer != 0 || j % finer != 0;
      (is_between ? between : at_posts) += 1;
      ASSERT_LE(finer, 2);
      EXPECT_LT(glm::length(found[v] - glm::normalize(one + other)), 1e-5F);
    }
  });
  EXPECT_GT(at_posts, 1000);
  EXPECT_GT(between, 10);
}

TEST_F(VertexNormals, TurnAwayFromASunThatTheGroundHides) {
  ShadingParams shadowed = params();
  shadowed.shadows = true;
  shadowed.sun = glm::normalize(glm::dvec3(1, 0.2, 0.1));
  const paging::Surface surface(planet_, std::size_t{64} << 20);
  int hidden = 0, lit = 0;
  for_each_mesh([&](const lod::TileInfo& tile, int variant) {
    if (tile.has_children || variant + 1 != static_cast<int>(tile.variants.size())) return;
    const Mesh m = mesh_of(*planet_, tile.key, variant, kExaggeration);
    const std::vector<glm::vec3> free = normals(tile.key, m, params());
    const std::vector<glm::vec3> found = normals(tile.key, m, shadowed);
    for (std::size_t v = 0; v < found.size(); ++v) {
      const bool faces = glm::dot(glm::dvec3(free[v]), shadowed.sun) > 0;
      // Well above the place, to be clear of the facets about it.
      const bool is_free_above = std::isinf(surface.cast(m.places[v] * 1.001, shadowed.sun, kExaggeration));
      const bool is_hidden = found[v] == glm::vec3(-shadowed.sun);
      if (!is_hidden) {
        EXPECT_EQ(found[v], free[v]);
      }
      if (!faces) {
        EXPECT_FALSE(is_hidden);
      } else if (!is_free_above) {
        EXPECT_TRUE(is_hidden);
        ++hidden;
      } else if (!is_hidden) {
        ++lit;
      }
    }
  });
  EXPECT_GT(hidden, 5);
  EXPECT_GT(lit, 1000);
  // Without light there are no shadows.
  ShadingParams unlit = shadowed;
  unlit.lit = false;
  const lod::TileKey key = planet_->tree()[0].key;
  const Mesh m = mesh_of(*planet_, key, 0, kExaggeration);
  EXPECT_EQ(normals(key, m, unlit), normals(key, m, params()));
}

}  // namespace
