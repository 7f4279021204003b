#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "objects/model/normals.h"
#include "objects/model/shapes.h"

namespace objects {

namespace {

constexpr int kMostRockSubdivisions = 8;
constexpr int kRockCuts = 14;

std::uint32_t rock_hash(std::uint32_t seed, std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  std::uint32_t h = seed * 0x9E3779B9U + 0x7F4A7C15U;
  for (const std::uint32_t part : {x, y, z}) {
    h ^= part;
    h *= 0x85EBCA6BU;
    h ^= h >> 13U;
    h *= 0xC2B2AE35U;
    h ^= h >> 16U;
  }
  return h;
}

// From 0 to 1.
double rock_value(std::uint32_t seed, std::uint32_t x, std::uint32_t y = 0, std::uint32_t z = 0) {
  return rock_hash(seed, x, y, z) / 4294967296.0;
}

// From -1 to 1, of the size of the lattice's steps.
double rock_noise(std::uint32_t seed, const glm::dvec3& at) {
  std::array<std::uint32_t, 3> cell{};
  std::array<double, 3> share{};
  for (int k = 0; k < 3; ++k) {
    const double low = std::floor(at[k]);
    const auto n = static_cast<std::size_t>(k);
    cell[n] = static_cast<std::uint32_t>(static_cast<std::int32_t>(low));
    const double s = at[k] - low;
    share[n] = s * s * (3 - 2 * s);
  }
  double sum = 0;
  for (std::uint32_t corner = 0; corner < 8; ++corner) {
    double weight = 1;
    std::array<std::uint32_t, 3> p = cell;
    for (std::size_t k = 0; k < 3; ++k) {
      const bool is_high = ((corner >> k) & 1U) != 0;
      weight *= is_high ? share[k] : 1 - share[k];
      p[k] += is_high ? 1U : 0U;
    }
    sum += weight * rock_value(seed, p[0], p[1], p[2]);
  }
  return 2 * sum - 1;
}

struct UnitBall {
  std::vector<glm::dvec3> points;
  std::vector<glm::uvec3> triangles;
};

glm::dvec3 unit(const glm::dvec3& v) { return v / std::sqrt(glm::dot(v, v)); }

UnitBall icosphere(int subdivisions) {
  const double g = 0.5 * (1 + std::sqrt(5.0));
  UnitBall ball;
  for (const glm::dvec3& p :
       {glm::dvec3(-1, g, 0), glm::dvec3(1, g, 0), glm::dvec3(-1, -g, 0), glm::dvec3(1, -g, 0),
        glm::dvec3(0, -1, g), glm::dvec3(0, 1, g), glm::dvec3(0, -1, -g), glm::dvec3(0, 1, -g),
        glm::dvec3(g, 0, -1), glm::dvec3(g, 0, 1), glm::dvec3(-g, 0, -1), glm::dvec3(-g, 0, 1)})
    ball.points.push_back(unit(p));
  ball.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (int n = 0; n < subdivisions; ++n) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [entry, is_new] =
          middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(ball.points.size()));
      if (is_new) ball.points.push_back(unit(ball.points[a] + ball.points[b]));
      return entry->second;
    };
    std::vector<glm::uvec3> finer;
    for (const glm::uvec3& t : ball.triangles) {
      const std::uint32_t a = middle(t.x, t.y);
      const std::uint32_t b = middle(t.y, t.z);
      const std::uint32_t c = middle(t.z, t.x);
      finer.insert(finer.end(), {{t.x, a, c}, {t.y, b, a}, {t.z, c, b}, {a, b, c}});
    }
    ball.triangles = std::move(finer);
  }
  return ball;
}

struct RockCut {
  glm::dvec3 normal;
  double away;  // of the plane from the centre
};

std::vector<RockCut> rock_cuts(std::uint32_t seed) {
  std::vector<RockCut> cuts;
  for (std::uint32_t n = 0; cuts.size() < kRockCuts; ++n) {
    const glm::dvec3 p(2 * rock_value(seed, n, 1) - 1, 2 * rock_value(seed, n, 2) - 1,
                       2 * rock_value(seed, n, 3) - 1);
    const double length2 = glm::dot(p, p);
    if (length2 > 1 || length2 < 0.01) continue;
    cuts.push_back({unit(p), 0.62 + 0.3 * rock_value(seed, n, 4)});
  }
  return cuts;
}

}  // namespace

Mesh make_rock(std::uint32_t seed, int subdivisions) {
  const UnitBall ball = icosphere(std::clamp(subdivisions, 0, kMostRockSubdivisions));
  const std::vector<RockCut> cuts = rock_cuts(seed);
  const glm::dvec3 squeeze(1, 0.65 + 0.3 * rock_value(seed, 0, 5), 0.5 + 0.25 * rock_value(seed, 0, 6));
  std::vector<glm::dvec3> points;
  glm::dvec3 low(std::numeric_limits<double>::max());
  glm::dvec3 high(std::numeric_limits<double>::lowest());
  for (const glm::dvec3& to : ball.points) {
    // Points move along their direction only, so that the surface cannot fold.
    double away = 1 + 0.25 * rock_noise(seed + 1, 1.5 * to);
    for (const RockCut& cut : cuts) {
      const double along = glm::dot(to, cut.normal);
      if (along * away > cut.away) away = cut.away / along;
    }
    double step = 4;
    double height = 0.03;
    for (std::uint32_t octave = 2; octave < 6; ++octave) {
      away += height * rock_noise(seed + octave, step * to);
      step *= 2;
      height *= 0.5;
    }
    points.push_back(away * to * squeeze);
    low = glm::min(low, points.back());
    high = glm::max(high, points.back());
  }
  const glm::dvec3 size = high - low;
  const double scale = 1 / std::max({size.x, size.y, size.z});
  const glm::dvec3 foot(0.5 * (low.x + high.x), 0.5 * (low.y + high.y), low.z);
  Mesh mesh;
  for (const glm::dvec3& p : points) mesh.positions_m.emplace_back(glm::vec3(scale * (p - foot)));
  mesh.triangles = ball.triangles;
  mesh.materials.assign(mesh.triangles.size(), 0);
  mesh.material_table = {Material{}};
  mesh.material_table.front().colour = {96, 84, 76, 255};
  add_normals(mesh);
  return mesh;
}

}  // namespace objects
