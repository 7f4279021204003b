#include "vpe/voxel/volume/brick_plan.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "vpe/voxel/volume/terrain_volume.h"

namespace vpe::voxel {

namespace {

[[noreturn]] void refuse_part(const core::GroundPart& part, const std::string& problem) {
  throw std::invalid_argument("the part of the ground \"" + part.name + "\": " + problem);
}

void check_part(const core::GroundPart& part) {
  const double distance_m = glm::length(part.centre_m);
  if (!(std::isfinite(distance_m) && std::isfinite(part.radius_m) && part.radius_m > 0))
    refuse_part(part, "expected a place and a size");
  if (!(part.voxel_m > 0 && std::isfinite(part.voxel_m))) refuse_part(part, "expected voxels of a size");
  // Then it lies on one face and the two beside it, whose chart goes on over the edge.
  if (!(part.radius_m < 0.25 * distance_m)) refuse_part(part, "it is as wide as the planet");
  if (!part.solids) refuse_part(part, "it has no content");
}

// A rectangle of a face's chart.
struct PlanRect {
  double u0 = std::numeric_limits<double>::infinity();
  double u1 = -std::numeric_limits<double>::infinity();
  double v0 = std::numeric_limits<double>::infinity();
  double v1 = -std::numeric_limits<double>::infinity();

  void add(const PlanRect& other) {
    u0 = std::min(u0, other.u0);
    u1 = std::max(u1, other.u1);
    v0 = std::min(v0, other.v0);
    v1 = std::max(v1, other.v1);
  }
};

// Returns the least and the greatest s for which the plane x = s z touches a cone about the unit vector (x, ., z), the sine of whose
// half angle is given.
std::pair<double, double> tangents(double x, double z, double sine) {
  const double root = sine * std::sqrt(std::max(0.0, x * x + z * z - sine * sine));
  const double divisor = z * z - sine * sine;
  return {(x * z - root) / divisor, (x * z + root) / divisor};
}

// Returns the rectangle of the directions of a ball; nullopt where it is not all in front of the face.
std::optional<PlanRect> rect_of(const core::GroundPart& part, mars::Face face) {
  const mars::FaceAxes& axes = mars::face_axes(face);
  const double distance_m = glm::length(part.centre_m);
  const glm::dvec3 d = part.centre_m / distance_m;
  const glm::dvec3 at{glm::dot(d, axes.right), glm::dot(d, axes.up), glm::dot(d, axes.out)};
  const double sine = part.radius_m / distance_m;
  if (at.z < sine + 0.1) return std::nullopt;
  const auto [u0, u1] = tangents(at.x, at.z, sine);
  const auto [v0, v1] = tangents(at.y, at.z, sine);
  return PlanRect{u0, u1, v0, v1};
}

// Parts that share a brick.
struct Cluster {
  mars::Face face = mars::Face::kPlusX;
  std::vector<std::size_t> parts;
};

HeightGridFrame frame_of(std::span<const core::GroundPart> parts, const Cluster& cluster,
                         double planet_radius_m) {
  PlanRect rect;
  double voxel_m = std::numeric_limits<double>::infinity();
  for (const std::size_t n : cluster.parts) {
    const std::optional<PlanRect> own = rect_of(parts[n], cluster.face);
    if (!own) refuse_part(parts[n], "it is too far from others that it touches");
    rect.add(*own);
    voxel_m = std::min(voxel_m, parts[n].voxel_m);
  }
  const double u = 0.5 * (rect.u0 + rect.u1);
  const double v = 0.5 * (rect.v0 + rect.v1);
  const double cell = voxel_m / planet_radius_m * std::pow(1 + u * u + v * v, 0.75);
  const double cells = std::max(rect.u1 - rect.u0, rect.v1 - rect.v0) / cell + 2 * kBrickMargin;
  if (!(cells < kMostVolumeSide - 1)) {
    std::string names;
    for (const std::size_t n : cluster.parts) names += (names.empty() ? "\"" : ", \"") + parts[n].name + "\"";
    throw std::runtime_error("the parts of the ground " + names + " need a brick of " +
                             std::to_string(std::llround(std::min(cells, 1e15))) +
                             " voxels along a side, and at most " + std::to_string(kMostVolumeSide - 1) +
                             " can be drawn; give them a larger voxel_m, or move them apart");
  }
  HeightGridFrame frame;
  frame.intervals = static_cast<int>(std::ceil(cells));
  frame.du = cell;
  frame.dv = cell;
  frame.u0 = u - 0.5 * frame.intervals * cell;
  frame.v0 = v - 0.5 * frame.intervals * cell;
  return frame;
}

// Returns true if a part's directions may lie in a frame with its margin.
bool reaches(const core::GroundPart& part, mars::Face face, const HeightGridFrame& frame) {
  const std::optional<PlanRect> rect = rect_of(part, face);
  return rect && rect->u0 < frame.u0 + frame.intervals * frame.du && rect->u1 > frame.u0 &&
         rect->v0 < frame.v0 + frame.intervals * frame.dv && rect->v1 > frame.v0;
}

// Returns true if the frames of two bricks may overlap. The corners of one are looked at in the chart of the other, where its sides
// stay straight.
bool overlap(const BrickPlan& a, const BrickPlan& b) {
  const mars::FaceAxes& axes = mars::face_axes(a.face);
  PlanRect rect;
  for (const int corner : {0, 1, 2, 3}) {
    const double u = b.frame.u0 + ((corner & 1) != 0 ? b.frame.intervals * b.frame.du : 0);
    const double v = b.frame.v0 + ((corner & 2) != 0 ? b.frame.intervals * b.frame.dv : 0);
    const glm::dvec3 d = mars::cube_point(b.face, u, v);
    if (!(glm::dot(d, axes.out) > 0)) return false;  // frames are far smaller than a face
    const mars::ChartPoint at = mars::chart_on(a.face, d);
    rect.add({at.u, at.u, at.v, at.v});
  }
  return rect.u0 < a.frame.u0 + a.frame.intervals * a.frame.du && rect.u1 > a.frame.u0 &&
         rect.v0 < a.frame.v0 + a.frame.intervals * a.frame.dv && rect.v1 > a.frame.v0;
}

}  // namespace

std::vector<BrickPlan> plan_bricks(std::span<const core::GroundPart> parts, double planet_radius_m) {
  if (parts.size() > kMostGroundParts)
    throw std::invalid_argument("the ground has " + std::to_string(parts.size()) + " parts, and at most " +
                                std::to_string(kMostGroundParts) + " can be drawn");
  std::vector<BrickPlan> plans;
  for (std::size_t n = 0; n < parts.size(); ++n) {
    check_part(parts[n]);
    Cluster cluster{mars::chart_point(parts[n].centre_m).face, {n}};
    BrickPlan plan{cluster.face, frame_of(parts, cluster, planet_radius_m), cluster.parts};
    // Takes in earlier bricks until none overlaps, since each makes it larger.
    for (std::size_t k = 0; k < plans.size();) {
      const BrickPlan& other = plans[k];
      const bool touches = overlap(plan, other) || overlap(other, plan) ||
                           std::ranges::any_of(other.parts, [&](std::size_t part) {
                             return reaches(parts[part], plan.face, plan.frame);
                           });
      if (!touches) {
        ++k;
        continue;
      }
      cluster.face = other.face;
      cluster.parts.insert(cluster.parts.end(), other.parts.begin(), other.parts.end());
      std::ranges::sort(cluster.parts);
      plan = {cluster.face, frame_of(parts, cluster, planet_radius_m), cluster.parts};
      plans.erase(plans.begin() + static_cast<std::ptrdiff_t>(k));
      k = 0;
    }
    plans.push_back(std::move(plan));
  }
  std::ranges::sort(plans, {}, [](const BrickPlan& plan) { return plan.parts.front(); });
  return plans;
}

void cut_out_of(std::vector<core::SolidSpan>& solids, std::vector<core::SolidSpan> cut) {
  std::ranges::sort(cut, {}, &core::SolidSpan::low_m);
  std::vector<core::SolidSpan> left;
  for (core::SolidSpan solid : solids) {
    bool is_gone = false;
    for (const core::SolidSpan& hole : cut) {
      if (hole.high_m <= solid.low_m) continue;
      if (hole.low_m >= solid.high_m) break;
      if (hole.low_m > solid.low_m) left.push_back({solid.low_m, hole.low_m});
      if (hole.high_m >= solid.high_m) {
        is_gone = true;
        break;
      }
      solid.low_m = hole.high_m;
    }
    if (!is_gone) left.push_back(solid);
  }
  solids = std::move(left);
}

core::SolidsAt solids_of(std::span<const core::GroundPart> parts, const BrickPlan& plan,
                         std::function<double(const glm::dvec3& up)> ground_m) {
  double size_m = 0;
  for (const std::size_t n : plan.parts) size_m = std::max(size_m, parts[n].radius_m);
  return [parts, own = plan.parts, ground_m = std::move(ground_m), size_m](
             const glm::dvec3& up, std::vector<core::SolidSpan>& solids) {
    std::vector<core::SolidSpan> cut;
    std::vector<core::SolidSpan> added;
    for (const std::size_t n : own) parts[n].solids(up, parts[n].is_cut ? cut : added);
    const double top_m = ground_m(up);
    // The ground goes on below all of it.
    double low_m = top_m;
    for (const core::SolidSpan& span : cut) low_m = std::min(low_m, span.low_m);
    for (const core::SolidSpan& span : added) low_m = std::min(low_m, span.low_m);
    solids.push_back({low_m - size_m, top_m});
    cut_out_of(solids, std::move(cut));
    solids.insert(solids.end(), added.begin(), added.end());
  };
}

}  // namespace vpe::voxel
