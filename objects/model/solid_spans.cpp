#include "objects/model/solid_spans.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "objects/model/surface_sample.h"

namespace objects {

namespace {

// A place where a line meets a triangle.
struct LineCrossing {
  double t_m = 0;  // from where the line enters the ball
  bool leaves = false;
};

// Returns where a unit line meets the plane of a triangle that a ray in single precision has met. Where the
// plane runs along the line, the place stays that of the ray. Places beyond the triangle's corners are moved to
// it.
double crossing_m(const Mesh& mesh, const TriangleHit& hit, const glm::dvec3& from_m, const glm::dvec3& unit) {
  constexpr double kEdgeOn = 1e-9;
  const glm::uvec3& t = mesh.triangles[hit.triangle];
  const glm::dvec3 a = glm::dvec3(mesh.positions_m[t.x]) - from_m;
  const glm::dvec3 b = glm::dvec3(mesh.positions_m[t.y]) - from_m;
  const glm::dvec3 c = glm::dvec3(mesh.positions_m[t.z]) - from_m;
  const glm::dvec3 normal = glm::cross(b - a, c - a);
  const double across = glm::dot(normal, unit);
  const double at_m = std::abs(across) > kEdgeOn * glm::length(normal) ? glm::dot(normal, a) / across
                                                                       : static_cast<double>(hit.t);
  const double a_m = glm::dot(a, unit);
  const double b_m = glm::dot(b, unit);
  const double c_m = glm::dot(c, unit);
  return std::clamp(at_m, std::min({a_m, b_m, c_m}), std::max({a_m, b_m, c_m}));
}

// Pairs crossings as brackets are paired, so that an open surface above a closed one leaves that one whole.
std::vector<SolidSpan> paired(std::vector<LineCrossing> crossings) {
  std::sort(crossings.begin(), crossings.end(), [](const LineCrossing& a, const LineCrossing& b) {
    return a.t_m != b.t_m ? a.t_m < b.t_m : a.leaves < b.leaves;
  });
  std::vector<SolidSpan> spans;
  std::vector<double> entered_m;
  for (const LineCrossing& c : crossings) {
    if (!c.leaves) {
      entered_m.push_back(c.t_m);
    } else if (entered_m.empty()) {
      spans.push_back({c.t_m, c.t_m});
    } else {
      spans.push_back({entered_m.back(), c.t_m});
      entered_m.pop_back();
    }
  }
  for (const double t_m : entered_m) spans.push_back({t_m, t_m});
  return spans;
}

}  // namespace

void join_spans(std::vector<SolidSpan>& spans, double touch) {
  std::sort(spans.begin(), spans.end(), [](const SolidSpan& a, const SolidSpan& b) {
    return a.begin != b.begin ? a.begin < b.begin : a.end < b.end;
  });
  std::size_t kept = 0;
  for (const SolidSpan& s : spans) {
    if (kept > 0 && s.begin <= spans[kept - 1].end + touch) {
      spans[kept - 1].end = std::max(spans[kept - 1].end, s.end);
    } else {
      spans[kept++] = s;
    }
  }
  spans.resize(kept);
}

std::vector<SolidSpan> mesh_spans(const MeshLevel& level, const std::vector<TexturePyramid>& textures,
                                  const Ball& ball, const ModelLine& line) {
  const double length_m = glm::length(line.direction);
  const glm::dvec3 unit = line.direction / length_m;
  const glm::dvec3 to_ball = glm::dvec3(ball.centre_m) - line.origin_m;
  const double middle_m = glm::dot(to_ball, unit);
  const glm::dvec3 beside = to_ball - middle_m * unit;
  const double reach_m = static_cast<double>(ball.radius_m) * (1 + 1e-6);
  const double half2 = reach_m * reach_m - glm::dot(beside, beside);
  if (!(half2 >= 0) || !std::isfinite(middle_m)) return {};
  const double begin_m = middle_m - std::sqrt(half2);
  const glm::dvec3 from_m = line.origin_m + begin_m * unit;
  const Mesh& mesh = level.mesh;
  std::vector<LineCrossing> crossings;
  const auto note = [&](const TriangleHit& hit) {
    const AlphaMode alpha = mesh.material_table[mesh.materials[hit.triangle]].alpha;
    if (alpha == AlphaMode::kOpaque ||
        surface_colour(mesh, textures, hit.triangle, {hit.u, hit.v}, 0).w >= kSolidOpacity)
      crossings.push_back({crossing_m(mesh, hit, from_m, unit), hit.is_back});
    return false;  // so that the tree goes on to all others
  };
  const auto until = static_cast<float>(2 * std::sqrt(half2) * (1 + 1e-6));
  (void)level.tree.nearest({glm::vec3(from_m), glm::vec3(unit)}, until, note);
  std::vector<SolidSpan> spans = paired(std::move(crossings));
  join_spans(spans, kMeshSpanError * (glm::length(glm::dvec3(ball.centre_m)) + reach_m));
  for (SolidSpan& s : spans) s = {(begin_m + s.begin) / length_m, (begin_m + s.end) / length_m};
  return spans;
}

}  // namespace objects
