#include "vpe/voxel/smooth/smooth_ground.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>
#include <utility>

#include "vpe/voxel/smooth/smooth_ray.h"

namespace vpe::voxel {

namespace {

using lod::Edge;

// Bounds of how far slopes at a border may exceed those of the facets beside it: knots of the warp change widths of
// cells, and edges of the cube turn slopes.
constexpr double kOvershoot = 1.0;
constexpr double kOvershootAtCubeEdge = 1.6;
constexpr double kWidest = 1.2;  // a cell, of the nominal one

bool touches_cube_edge(const lod::TileKey& key) {
  const std::int32_t last = (std::int32_t{1} << key.level) - 1;
  return key.i == 0 || key.j == 0 || key.i == last || key.j == last;
}

// Searches the tree for the first hit of one ray.
class RaySearch {
 public:
  RaySearch(const SmoothGround& ground, const SmoothForm& form, const FaceRay& ray)
      : ground_(ground), form_(form), ray_(ray) {}

  double visit(SmoothGround::Index index, RaySegment segment) const {
    constexpr double kNone = std::numeric_limits<double>::infinity();
    const lod::TileInfo& info = ground_.tree()[index];
    const mars::ChartRect rect = lod::chart_rect(info.key);
    if (!cut_to_rect(ray_, rect.u0, rect.u1, rect.v0, rect.v1, segment)) return kNone;
    if (!cut_to_sphere(ground_.radius_m() + ground_.ball(index, form_.exaggeration).highest_m, segment))
      return kNone;
    if (!info.has_children) {
      const auto tile = ground_.tile(index, form_.patch);
      TileMeeting found;
      bool is_near = false;
      PatchCache patches;
      const bool meets = meet_block(*tile, {tile->levels(), 0, 0}, ground_.radius_m(), form_.exaggeration, ray_,
                                    segment, patches, found, is_near);
      return meets ? found.s : kNone;
    }
    const lod::TileTree::Index first = ground_.tree().first_child(index);
    const mars::ChartRect corner = lod::chart_rect(ground_.tree()[first].key);
    // The camera's side of each line comes first.
    const unsigned right = ray_.e.x - corner.u1 * ray_.e.z > 0 ? 1 : 0;
    const unsigned up = ray_.e.y - corner.v1 * ray_.e.z > 0 ? 2 : 0;
    for (const unsigned turn : {0U, 1U, 2U, 3U}) {
      const double hit = visit(first + ((right + up) ^ turn), segment);
      if (hit < kNone) return hit;
    }
    return kNone;
  }

 private:
  bool cut_to_sphere(double radius_m, RaySegment& segment) const {
    const double rest = ray_.ed * ray_.ed - ray_.ee + radius_m * radius_m;
    if (!(rest >= 0)) return false;
    const double half = std::sqrt(rest);
    segment.s0 = std::max(segment.s0, -ray_.ed - half);
    segment.s1 = std::min(segment.s1, -ray_.ed + half);
    return segment.s0 <= segment.s1;
  }

  const SmoothGround& ground_;
  const SmoothForm& form_;
  const FaceRay& ray_;
};

}  // namespace

SmoothGround::SmoothGround(const paging::Surface& surface, std::size_t budget_bytes)
    : surface_(surface), slots_(new Slot[surface.planet().tree().size()]), cache_(budget_bytes) {}

std::shared_ptr<const SmoothTile> SmoothGround::tile(Index index, core::RayPatch patch) const {
  const lod::TileKey key = tree()[index].key;
  return cache_.get({{key, surface_.planet().version(key)}, patch}, [&] {
    const BorderRule rule(
        tree(), [this](const lod::TileKey& beside) { return surface_.tile(beside); }, patch);
    auto made = std::make_shared<const SmoothTile>(*surface_.tile(key), rule, patch, radius_m());
    const std::size_t bytes = made->bytes();
    return std::pair(std::move(made), bytes);
  });
}

double SmoothGround::deviation_m(const SmoothTile& tile, double exaggeration) const {
  return tile.deviation_m(exaggeration) + tree().edge_shift_m(*tree().find(tile.key()), exaggeration);
}

SmoothGround::Index SmoothGround::finest(const mars::ChartPoint& point) const {
  Index index = static_cast<Index>(point.face);
  while (tree()[index].has_children) {
    const lod::TileKey finer = lod::tile_at(point, tree()[index].key.level + 1);
    index = tree().first_child(index) + static_cast<Index>((finer.i & 1) + 2 * (finer.j & 1));
  }
  return index;
}

double SmoothGround::highest_m(const glm::dvec3& direction, double exaggeration) const {
  return ball(finest(mars::chart_point(direction)), exaggeration).highest_m;
}

SmoothPoint SmoothGround::at(const glm::dvec3& direction, const SmoothForm& form) const {
  const mars::ChartPoint point = mars::chart_point(direction);
  const auto tile = this->tile(finest(point), form.patch);
  const auto cell = [](const std::vector<double>& lines, double x) {
    const auto next = std::upper_bound(lines.begin() + 1, lines.end() - 1, x);
    return static_cast<int>(next - lines.begin()) - 1;
  };
  const int i = cell(tile->u_lines(), point.u);
  const int j = cell(tile->v_lines(), point.v);
  const glm::dvec3 up = glm::normalize(direction);
  const SmoothPatch patch = tile->patch(i, j, form.exaggeration);
  const double height_m = patch_point(*tile, patch, form.exaggeration, radius_m() * up, i, j).height_m;
  const PatchPoint found = patch_point(*tile, patch, form.exaggeration, (radius_m() + height_m) * up, i, j);
  const double length = std::sqrt(1 + point.u * point.u + point.v * point.v);
  const double du =
      tile->u_lines()[static_cast<std::size_t>(i) + 1] - tile->u_lines()[static_cast<std::size_t>(i)];
  return {found.height_m, found.normal, radius_m() * du / length, deviation_m(*tile, form.exaggeration)};
}

double SmoothGround::cast(const glm::dvec3& camera_m, const glm::dvec3& direction, const SmoothForm& form,
                          double begin_m, double end_m) const {
  std::array<int, mars::kFaces> faces{};
  std::iota(faces.begin(), faces.end(), 0);
  // A ray leaves the faces nearer to its camera first: it crosses each plane between two faces once at most.
  const auto towards = [&](int face) {
    return glm::dot(mars::face_axes(static_cast<mars::Face>(face)).out, camera_m);
  };
  std::stable_sort(faces.begin(), faces.end(), [&](int a, int b) { return towards(a) > towards(b); });
  for (const int face : faces) {
    const FaceRay ray(static_cast<mars::Face>(face), camera_m, direction);
    const double hit = RaySearch(*this, form, ray).visit(static_cast<Index>(face), {begin_m, end_m});
    if (hit < std::numeric_limits<double>::infinity()) return hit;
  }
  return std::numeric_limits<double>::infinity();
}

SmoothGround::Bounds SmoothGround::make_bounds(Index index) const {
  const lod::TileInfo& info = tree()[index];
  const lod::TileKey& key = info.key;
  Bounds made;
  const mars::ChartRect rect = lod::chart_rect(key);
  made.rect = rect;
  made.direction = mars::chart_direction(key.face, 0.5 * (rect.u0 + rect.u1), 0.5 * (rect.v0 + rect.v1));
  for (const double u : {rect.u0, rect.u1}) {
    for (const double v : {rect.v0, rect.v1})
      made.chord = std::max(made.chord, glm::length(mars::chart_direction(key.face, u, v) - made.direction));
  }
  // Patches leave the heights of their posts by less than slopes at the posts rise in a cell; those at the border depend on
  // the tiles beside it too.
  double low = info.min_height_m;
  double high = info.max_height_m;
  double steepest = info.steepest_slope;
  const auto add = [&](const lod::TileKey& beside) {
    const lod::TileInfo& other = tree().deepest(beside);
    low = std::min(low, other.min_height_m);
    high = std::max(high, other.max_height_m);
    steepest = std::max(steepest, other.steepest_slope);
  };
  if (key.level > 0) {
    for (const Edge edge : lod::kEdges) {
      const lod::Neighbour beside = lod::neighbour(key, edge);
      add(beside.key);
      for (const Edge next : lod::kEdges)
        if (next != beside.edge) add(lod::neighbour(beside.key, next).key);
    }
  } else {
    for (const lod::TileInfo& root : tree().tiles().first(mars::kFaces)) add(root.key);
  }
  const double share = touches_cube_edge(key) ? kOvershootAtCubeEdge : kOvershoot;
  const double cell_m =
      kWidest * lod::nominal_side_m(key.level, radius_m() + std::max(high, 0.0)) / tree().shape().intervals();
  const double beyond = share * std::min(high - low, 1.5 * steepest * cell_m);
  made.low_m = info.min_height_m - beyond;
  made.high_m = info.max_height_m + beyond;
  return made;
}

SmoothGround::Bounds SmoothGround::bounds(Index index) const {
  Slot& slot = slots_[index];
  if (slot.state.load(std::memory_order_acquire) == 2) return slot.bounds;
  const Bounds made = make_bounds(index);
  int empty = 0;
  if (slot.state.compare_exchange_strong(empty, 1)) {
    slot.bounds = made;
    slot.state.store(2, std::memory_order_release);
  }
  return made;
}

SmoothGround::Ball SmoothGround::ball(Index index, double exaggeration) const {
  const Bounds at = bounds(index);
  const double low = std::max(radius_m() + exaggeration * at.low_m, 0.0);
  const double high = radius_m() + exaggeration * at.high_m;
  const double middle = 0.5 * (low + high);
  // Within a cap of this chord, from the least to the greatest radius.
  return {middle * at.direction, 0.5 * (high - low) + high * at.chord * (1 + 1e-12), exaggeration * at.high_m,
          at.rect};
}

}  // namespace vpe::voxel
